"""Native code in killable child processes: the one thing that the judge and the factory share."""
