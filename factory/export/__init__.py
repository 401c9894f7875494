"""Asset -> Bundle: a folder that simulators can open."""
