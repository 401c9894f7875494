"""What is seen of a mesh: one view of one side, and every place where its rays cross the mesh."""
