"""Input file -> Intake: a mesh in metres, z up, what was assumed of it, what came with it; or a reason why not."""
