"""What the articulator of one-piece meshes learned: from pictures of generated objects' sides."""
