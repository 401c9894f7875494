"""MAKES: mesh in, registry entry out. The pipeline is one screen of :mod:`asset_factory.factory.build`."""
