"""Input file -> Intake: a mesh [m], z up, with its assumptions and extras; or a rejection."""
