"""What the checks measure with: hulls, poses, and swept penetration depth along a path."""
