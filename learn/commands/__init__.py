"""The commands that teach: ``factory train`` and ``factory evaluate``."""
