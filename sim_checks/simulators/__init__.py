"""One physics engine per file, behind one Protocol."""
