"""What tells how a part moves: samples of parts whose motions are known."""
