"""A recipe for a network that learns nothing much in seconds."""

TEXT = """
batch = 6
recipe = "tiny"
terms = "for tests"

[network]
hidden = 16
blocks = 2
heads = 2
mlp_ratio = 2
max_parts = 6
features = "components"
dropout = {dropout}
quiet_start = true

[draw]
points = 32

[loss]
dice = 0.5
auxiliary = 0.4
root_first = true
sign_free = true
unseen_parts = false

[schedule]
steps = {steps}
rate = 3e-3
warm_up = 3

[validation]
objects = 4
points = 64

[run]
workers = 0
threads = 1
device = "cpu"
log_every = 4
checkpoint_every = 3
validate_every = 5

[[data]]
kind = "sampled"
path = "{data}"

[[held_out]]
kind = "sampled"
path = "{data}"
"""


def recipe(data, *, steps=12, dropout=0.1):
    """The TOML, with sampled objects from a folder."""
    return TEXT.format(data=data, steps=steps, dropout=dropout)
