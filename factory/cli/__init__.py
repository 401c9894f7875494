"""The commands of ``factory``: one file each, with its flags, its help and what it does."""


def main() -> None:
    """Run the command line and leave with its exit code."""
    # Children import the script that calls this, and ask for no command: that would cost each of
    # them most of a second.
    from . import commands

    commands.main()
