"""Training of the detector that reads all sides of an object."""
