"""Everything that makes weights and measures them; the maker imports nothing of it."""
