// The hulls as bodies that meet: contacts of a pose, and clearance along a joint.
import { Vector3 } from "three";
import { distance } from "./gjk.js";

/** Wider gaps are not drawn [m]. */
export const WIDEST = 0.05;
const STEPS = 48;

/** One hull, placed in the root's frame. */
class Hull {
  constructor(mesh) {
    const { geometry } = mesh;
    this.mesh = mesh;
    this.link = mesh.userData.link;
    this.local = geometry.userData.corners;
    this.normals = directions(geometry.getAttribute("normal").array);
    this.points = new Float64Array(this.local.length);
    this.axes = new Float64Array(this.normals.length);
    this.low = new Float64Array(3);
    this.high = new Float64Array(3);
  }

  place({ elements: e }) {
    this.low.fill(Infinity);
    this.high.fill(-Infinity);
    for (let at = 0; at < this.local.length; at += 3) {
      const [x, y, z] = [this.local[at], this.local[at + 1], this.local[at + 2]];
      for (let axis = 0; axis < 3; axis += 1) {
        const value = e[axis] * x + e[axis + 4] * y + e[axis + 8] * z + e[axis + 12];
        this.points[at + axis] = value;
        if (value < this.low[axis]) this.low[axis] = value;
        if (value > this.high[axis]) this.high[axis] = value;
      }
    }
    for (let at = 0; at < this.normals.length; at += 3) {
      const [x, y, z] = [this.normals[at], this.normals[at + 1], this.normals[at + 2]];
      for (let axis = 0; axis < 3; axis += 1) {
        this.axes[at + axis] = e[axis] * x + e[axis + 4] * y + e[axis + 8] * z;
      }
    }
  }

  /** How far the boxes of two hulls are apart at least. */
  apart(other) {
    let squared = 0;
    for (let axis = 0; axis < 3; axis += 1) {
      const gap = Math.max(this.low[axis] - other.high[axis], other.low[axis] - this.high[axis], 0);
      squared += gap * gap;
    }
    return Math.sqrt(squared);
  }

  /** A gap, or a negative depth: the shortest way out across a face of either. */
  gap(other) {
    const gap = distance(this.points, other.points);
    return gap > 0 ? gap : -Math.min(wayOut(this, other), wayOut(other, this));
  }

  /** The middle of what the boxes of two hulls share. */
  meeting(other) {
    const middle = [0, 1, 2].map((axis) => (
      Math.max(this.low[axis], other.low[axis]) + Math.min(this.high[axis], other.high[axis])) / 2);
    return new Vector3(...middle);
  }
}

function directions(normals) {
  const found = new Map();
  for (let at = 0; at < normals.length; at += 9) {
    const normal = [normals[at], normals[at + 1], normals[at + 2]];
    // A sliver has none.
    if (Math.hypot(...normal) > 0.5) found.set(normal.map((value) => value.toFixed(3)).join(), normal);
  }
  return new Float64Array([...found.values()].flat());
}

function wayOut(one, other) {
  let shortest = Infinity;
  for (let at = 0; at < one.axes.length; at += 3) {
    const [x, y, z] = [one.axes[at], one.axes[at + 1], one.axes[at + 2]];
    let outer = -Infinity;
    let inner = Infinity;
    for (let p = 0; p < one.points.length; p += 3) {
      outer = Math.max(outer, one.points[p] * x + one.points[p + 1] * y + one.points[p + 2] * z);
    }
    for (let p = 0; p < other.points.length; p += 3) {
      inner = Math.min(inner, other.points[p] * x + other.points[p + 1] * y + other.points[p + 2] * z);
    }
    shortest = Math.min(shortest, outer - inner);
  }
  return Math.max(shortest, 0);
}

/** All hulls of a model; `ignored` are pairs of link names that may overlap. */
export class Bodies {
  constructor(model, ignored) {
    this.model = model;
    this.hulls = model.hulls.map((mesh) => new Hull(mesh));
    const parts = model.parts;
    const free = new Set(ignored.map((pair) => [...pair].sort().join("\n")));
    this.judged = (a, b) => parts[a.link] !== parts[b.link]
      && !free.has([model.names[a.link], model.names[b.link]].sort().join("\n"));
    this.key = (a, b) => [a.link, b.link].sort((x, y) => x - y).join();
    this.rest = new Map();
    for (const { key, depth } of this.overlaps(model.opened(0))) {
      this.rest.set(key, Math.max(depth, this.rest.get(key) ?? 0));
    }
  }

  place(values) {
    const matrices = this.model.matrices(values);
    for (const hull of this.hulls) hull.place(matrices[hull.link]);
  }

  overlaps(values) {
    this.place(values);
    const found = [];
    this.hulls.forEach((one, number) => {
      for (const other of this.hulls.slice(number + 1)) {
        if (one.link === other.link || !this.judged(one, other) || one.apart(other) > 0) continue;
        const depth = -one.gap(other);
        if (depth > 0) found.push({ one, other, depth, key: this.key(one, other) });
      }
    });
    return found;
  }

  /** Hulls that lie deeper in each other than with everything closed, by more than `excess` [m]. */
  contacts(values, excess) {
    return this.overlaps(values)
      .filter(({ key, depth }) => depth > (this.rest.get(key) ?? 0) + excess)
      .map(({ one, other, depth }) => ({ one, other, depth, point: one.meeting(other) }));
  }

  /** Clearance along a joint by pair of links: gaps [m], negative for depths, at equal steps. */
  sweep(joint, others) {
    const moving = this.model.below(joint);
    const riders = this.hulls.filter((hull) => moving.has(hull.link));
    const standing = this.hulls.filter((hull) => !moving.has(hull.link));
    const found = new Map();
    for (let step = 0; step <= STEPS; step += 1) {
      this.place(new Map([...others, [joint.name, joint.at(step / STEPS)]]));
      for (const one of riders) {
        for (const other of standing) {
          if (!this.judged(one, other)) continue;
          const key = this.key(one, other);
          const curve = found.get(key);
          const widest = Math.min(WIDEST, curve?.gaps[step] ?? WIDEST);
          if (one.apart(other) >= widest) continue;
          const gap = one.gap(other);
          if (gap >= widest) continue;
          if (curve) curve.gaps[step] = gap;
          else {
            const gaps = new Array(STEPS + 1).fill(WIDEST);
            gaps[step] = gap;
            found.set(key, { links: [one.link, other.link], gaps });
          }
        }
      }
    }
    return [...found.values()].sort((a, b) => Math.min(...a.gaps) - Math.min(...b.gaps));
  }
}
