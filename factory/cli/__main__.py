"""``python -m asset_factory.factory.cli``: the same as ``factory``."""

from .commands import main

main()
