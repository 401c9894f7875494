"""MAKES: mesh in, registry entry out. :mod:`asset_factory.factory.build` is the whole pipeline."""
