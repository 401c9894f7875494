// How far apart two convex point sets are: the algorithm of Gilbert, Johnson and Keerthi.
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const mix = (points, weights) =>
  [0, 1, 2].map((axis) => points.reduce((sum, point, at) => sum + weights[at] * point[axis], 0));

/** Of points in a flat array, the farthest along a direction. */
function farthest(points, x, y, z) {
  let best = 0;
  let most = -Infinity;
  for (let at = 0; at < points.length; at += 3) {
    const along = points[at] * x + points[at + 1] * y + points[at + 2] * z;
    if (along > most) {
      most = along;
      best = at;
    }
  }
  return best;
}

/** Distance of two hulls given by flat arrays of corners; 0 where they overlap. */
export function distance(first, second) {
  let toward = [first[0] - second[0], first[1] - second[1], first[2] - second[2]];
  let simplex = [];
  let squared = Infinity;
  for (let round = 0; round < 40; round += 1) {
    const a = farthest(first, -toward[0], -toward[1], -toward[2]);
    const b = farthest(second, ...toward);
    const corner = [first[a] - second[b], first[a + 1] - second[b + 1], first[a + 2] - second[b + 2]];
    // No corner lies nearer to the origin in this direction: the last answer is the best.
    if (simplex.length && squared - dot(toward, corner) <= 1e-10 * squared + 1e-16) break;
    if (simplex.some((known) => known.every((value, axis) => value === corner[axis]))) break;
    const found = nearest([...simplex, corner]);
    if (!found) return 0;
    const now = dot(found.point, found.point);
    if (now >= squared) break;
    ({ point: toward, simplex } = found);
    squared = now;
    if (squared < 1e-16) return 0;
  }
  return Math.sqrt(squared);
}

/** The point of a simplex nearest to the origin, and the corners it needs; null if inside. */
function nearest(points) {
  if (points.length === 1) return { point: points[0], simplex: points };
  if (points.length === 2) return onSegment(...points);
  if (points.length === 3) return onTriangle(...points);
  const [a, b, c, d] = points;
  let best = null;
  let inside = true;
  for (const [p, q, r, other] of [[a, b, c, d], [a, b, d, c], [a, c, d, b], [b, c, d, a]]) {
    const normal = cross(sub(q, p), sub(r, p));
    const here = -dot(normal, p);
    const there = dot(normal, sub(other, p));
    if (here * there > 0 && Math.abs(there) > 1e-18) continue;
    inside = false;
    const found = onTriangle(p, q, r);
    if (!best || dot(found.point, found.point) < dot(best.point, best.point)) best = found;
  }
  return inside ? null : best;
}

function onSegment(a, b) {
  const along = sub(b, a);
  const length = dot(along, along);
  const share = length > 0 ? -dot(a, along) / length : 0;
  if (share <= 0) return { point: a, simplex: [a] };
  if (share >= 1) return { point: b, simplex: [b] };
  return { point: mix([a, b], [1 - share, share]), simplex: [a, b] };
}

function onTriangle(a, b, c) {
  const normal = cross(sub(b, a), sub(c, a));
  const area = dot(normal, normal);
  if (area > 1e-30) {
    const weights = [
      dot(cross(sub(c, b), sub([0, 0, 0], b)), normal) / area,
      dot(cross(sub(a, c), sub([0, 0, 0], c)), normal) / area,
    ];
    weights.push(1 - weights[0] - weights[1]);
    if (weights.every((weight) => weight >= 0)) {
      return { point: mix([a, b, c], weights), simplex: [a, b, c] };
    }
  }
  return [onSegment(a, b), onSegment(b, c), onSegment(c, a)]
    .reduce((best, found) => (dot(found.point, found.point) < dot(best.point, best.point) ? found : best));
}
