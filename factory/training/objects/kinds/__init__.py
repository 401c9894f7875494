"""Descriptions of the kinds of object, a file for each group; the catalog lists them."""
