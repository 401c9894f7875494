"""Descriptions of the kinds of object, a file for each group; the catalog finds them.

A kind is a function of its name that adds to an empty :class:`~..kit.assembly.Assembly` ``a``:
``a.draw(...)`` and the like draw its proportions, ``a.body(look, ...)`` begins the body with
forms, ``a.hinge``, ``a.slider`` and ``a.spin`` add moving parts; cases with fronts come whole
from :func:`~..kit.casework.furniture`. Z is up, the front looks towards -Y, lengths are in metres,
and positive joint values open. Every public function is in the catalog, and so is whatever a file
has in ``PLANNED``, by name.
"""
