"""The report of a registry: a static site, a grid and a page per asset, without any network."""
