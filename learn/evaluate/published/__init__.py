"""The published model's metrics: as its paper words them, and as its released code has them."""
