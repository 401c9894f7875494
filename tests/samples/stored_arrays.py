"""Reading stored arrays without leaving their file open."""

import numpy as np

#: What the released network calls the fields of a prediction.
OUTPUTS = {
    "mask_logits": "point_mask_logits",
    "hierarchy_logits": "part_adjacency_logits",
    "motion_logits": "part_motion_logits",
    "revolute_direction": "revolute_dir_raw",
    "revolute_range": "revolute_range",
    "prismatic_direction": "prismatic_dir_raw",
    "prismatic_range": "prismatic_range",
}


def arrays(path):
    with np.load(path, allow_pickle=False) as held:
        return {name: held[name] for name in held.files}
