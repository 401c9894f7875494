"""The renderer: views of a mesh's sides, and every place where their rays cross the mesh."""
