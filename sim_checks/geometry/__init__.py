"""What the judge measures with: hulls, poses, and how deep bodies get into one another along a path."""
