"""Pictures of scenes, by ray casting on the processor: no GPU, no display, the same bytes again."""
