"""``factory edit``: a page on which a person says what opens, and builds it."""
