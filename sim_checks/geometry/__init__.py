"""What the judge measures with: hulls, poses, and swept penetration depth along a path."""
