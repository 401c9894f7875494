"""Training samples: surfaces with their parts and joints, drawn from objects and datasets."""
