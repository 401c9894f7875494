"""Native code in killable child processes: the one thing that checks and factory share."""
