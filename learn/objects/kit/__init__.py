"""The construction kit: shapes, parts, joints, and what several kinds of object share."""
