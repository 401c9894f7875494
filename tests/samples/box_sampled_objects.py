"""Objects of boxes as points: a body with doors and drawers in front, without a mesh."""

import numpy as np

from asset_factory.learn.samples.sampled_object import SampledObject, write_sampled


def box_sampled(seed):
    """A box with one to three doors or drawers, as 600 points."""
    rng = np.random.default_rng(seed)
    movers = int(rng.integers(1, 4))
    size = rng.uniform(0.4, 1.0, 3)
    boxes = [(np.zeros(3), size)]
    turns = [False]
    for number in range(movers):
        low = np.array([0.0, -0.05, size[2] * number / movers])
        boxes.append((low, np.array([size[0], 0.0, size[2] * (number + 0.9) / movers])))
        turns.append(bool(rng.random() < 0.5))
    surfaces = (_surface(rng, 600 // len(boxes), low, high) for low, high in boxes)
    points, normals = zip(*surfaces, strict=True)
    ids = np.repeat(np.arange(len(boxes)), 600 // len(boxes))
    turning = np.array(turns)[:, None]
    sliding = ~turning & (np.arange(len(boxes)) > 0)[:, None]
    return SampledObject(
        name=f"box-{seed}",
        points=np.concatenate(points),
        normals=np.concatenate(normals),
        part_ids=ids,
        sharp=rng.random(len(ids)) < 0.5,
        components=ids,
        parents=np.array([-1] + [0] * movers),
        motion=turning[:, 0] + 2 * sliding[:, 0],
        axis=np.where(turning, [0.0, 0.0, -1.0], 0.0),
        origin=np.zeros((len(boxes), 3)),
        turn=np.where(turning, [0.0, 1.6], 0.0),
        endless=np.zeros(len(boxes), dtype=bool),
        slide_direction=np.where(sliding, [0.0, -1.0, 0.0], 0.0),
        slide=np.where(sliding, [0.0, 0.4], 0.0),
    )


def write_boxes(folder, count):
    """A folder of sampled objects in files."""
    folder.mkdir(parents=True, exist_ok=True)
    for sampled in map(box_sampled, range(count)):
        write_sampled(folder / f"{sampled.name}.npz", sampled)
    return folder


def _surface(rng, count, low, high):
    face = rng.integers(0, 6, count)
    at = rng.random((count, 3))
    rows = np.arange(count)
    at[rows, face % 3] = face // 3
    normals = np.zeros((count, 3))
    normals[rows, face % 3] = np.where(face // 3, 1.0, -1.0)
    return low + at * (high - low), normals
