// What is stated: the sidecar's own data, with undo.

/** Keys of kinds. */
export const KEYS = {
  door: "d", drawer: "w", flap: "f", lid: "l", knob: "k", button: "b", lever: "e", wheel: "h",
  screen: "s", rack: "r", cap: "c", turntable: "t", seat: "a", sail: "i",
};
const EDGES = ["left", "right", "top", "bottom"];
const AROUND = ["front", "back", "left", "right"];
const HINGES = { door: EDGES, flap: EDGES, lever: EDGES, lid: AROUND, seat: AROUND };

/** Where a part may be hinged. */
export function hingesOf(part) {
  const hinges = HINGES[part.kind] ?? [];
  return part.side === "top" && hinges.length ? AROUND : hinges;
}

/** The edge of its box at which a hinge is drawn; none for one that the side does not show. */
export function edgeOf({ side, hinge }) {
  if (side === "top") return { back: "top", front: "bottom" }[hinge] ?? hinge;
  return { front: "", back: "" }[hinge] ?? hinge;
}

export const labelOf = (part) => part.name || part.kind;

const rounded = (value) => Math.round(1000 * Math.min(Math.max(value, 0), 1)) / 1000;

/** The nearest box that can be: edges in order, within the picture. */
export function boxOf([left, lower, right, upper]) {
  const sorted = (one, other) => [rounded(Math.min(one, other)), rounded(Math.max(one, other))];
  const [x0, x1] = sorted(left, right);
  const [y0, y1] = sorted(lower, upper);
  return [Math.min(x0, 0.99), Math.min(y0, 0.99), Math.max(x1, x0 + 0.01), Math.max(y1, y0 + 0.01)].map(rounded);
}

export class Statement {
  constructor(values, changed) {
    this.values = values;
    this.changed = changed;
    this.past = [];
    this.future = [];
    this.saved = null;
  }

  get parts() {
    const { parts } = this.values;
    return Array.isArray(parts) ? parts.filter((part) => part && typeof part === "object") : [];
  }

  get text() {
    const lines = JSON.stringify(this.values, null, 2);
    // Boxes and ranges on a line each.
    return `${lines.replace(/\[[\s\d.,-]+\]/g, (row) => row.replace(/\s+/g, " ").replace(/\[ | \]/g, (end) => end.trim()))}\n`;
  }

  /** Change the data; changes of one gesture, which share a key, are undone together. */
  change(act, gesture = null) {
    const before = structuredClone(this.values);
    act(this.values);
    if (JSON.stringify(before) === JSON.stringify(this.values)) return;
    if (!gesture || gesture !== this.gesture) this.past.push(before);
    this.gesture = gesture;
    this.future = [];
    this.changed();
  }

  set(index, fields, gesture = null) {
    this.change(() => {
      const part = this.parts[index];
      for (const [name, value] of Object.entries(fields)) {
        if (value === undefined) delete part[name];
        else part[name] = value;
      }
      if (part.hinge && !hingesOf(part).includes(part.hinge)) delete part.hinge;
    }, gesture);
  }

  add(part) {
    this.change((values) => {
      delete values.opens;
      values.parts = [...this.parts, part];
    });
    return this.parts.length - 1;
  }

  remove(index) {
    this.change((values) => {
      const { name } = this.parts[index];
      values.parts = this.parts.filter((_, place) => place !== index);
      for (const part of values.parts) if (name && part.parent === name) delete part.parent;
    });
  }

  undo() {
    this.step(this.past, this.future);
  }

  redo() {
    this.step(this.future, this.past);
  }

  step(from, to) {
    if (!from.length) return;
    to.push(this.values);
    this.values = from.pop();
    this.gesture = null;
    this.changed();
  }
}
