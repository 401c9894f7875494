"""The detector: one network that reads all sides of an object and says what opens there."""
