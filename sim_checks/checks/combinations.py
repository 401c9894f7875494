"""Joint combinations worth trying: all open, and a spread that leaves no corner out."""

from collections.abc import Mapping

PRIMES = (2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53)


def combination_values(
    ranges: Mapping[str, tuple[float, float]], count: int
) -> list[dict[str, float]]:
    """Return all joints at upper, then ``count`` points of the Halton sequence over their ranges.

    With fewer than two joints there is nothing to combine.
    """
    if len(ranges) < 2:
        return []
    poses = [{name: upper for name, (_, upper) in ranges.items()}]
    for index in range(1, count + 1):
        pose = {}
        for column, (name, (lower, upper)) in enumerate(ranges.items()):
            prime = PRIMES[column % len(PRIMES)]
            # Joints that share a prime start at different places of its sequence.
            pose[name] = lower + _radical_inverse(index + column // len(PRIMES), prime) * (
                upper - lower
            )
        poses.append(pose)
    return poses


def _radical_inverse(index: int, base: int) -> float:
    """Return the digits of ``index`` mirrored at the point, in [0, 1)."""
    value = 0.0
    scale = 1.0
    while index > 0:
        index, digit = divmod(index, base)
        scale /= base
        value += digit * scale
    return value
