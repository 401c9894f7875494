"""Bundle -> Verdict, and Verdict -> what to try next."""
