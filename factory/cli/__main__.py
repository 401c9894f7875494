"""``python -m asset_factory.factory.cli``: the same as ``factory``."""

from .main import main

main()
