"""Questions to somebody who sees: a sheet of pictures, an instruction, and an answer's form."""
