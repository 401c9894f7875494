"""The construction kit: shapes, parts and joints, and what several kinds of object have in common."""
