"""What each task says, and what all of them share."""
