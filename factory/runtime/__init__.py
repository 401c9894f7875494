"""What every stage runs on: the cache, keys, whole-file writes, clocks. It knows no mesh."""
