"""The permanent list: assets that passed, inputs rejected and why.

A registry is a folder::

    assets/<id>/             a bundle that passed, with its report.json
    rejected/<id>/           the report of one that did not
    notes/<id>.json          later notes on one
    registry.db              one row per input that has been validated
    .staging/                half-made things; never read, removed when done

The folders are the truth, the database a table of contents that ``factory registry rebuild`` makes
anew. Publishing
is one rename from the staging folder, then one row: a reader sees a whole asset or none.
"""

from .entry import Entry, Split, split_of
from .registry import Registry

__all__ = ["Entry", "Registry", "Split", "split_of"]
