"""The metrics of the published model: as its paper words them, and as its released code computes them."""
