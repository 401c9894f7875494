"""What is shown of an object: coloured surfaces and hulls on links, joints between them."""
