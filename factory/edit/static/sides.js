// The pictures of the sides, and the boxes on them.
import { boxOf, edgeOf, labelOf } from "./statement.js";

export const SIDES = ["front", "left", "right", "back", "top"];
/** Nearer to an edge of the chosen box than this, the edge is moved [pixels]. */
const GRIP = 8;
/** A shorter drag is a click [pixels]. */
const CLICK = 4;

export const colorOf = (index) => `part-${index % 5}`;

function boxElement(tag, part, index, chosen) {
  const box = document.createElement(tag);
  const [left, lower, right, upper] = part.box;
  box.className = `box ${colorOf(index)} hinge-${edgeOf(part) || "none"}${index === chosen ? " chosen" : ""}`;
  Object.assign(box.style, {
    left: `${100 * left}%`, bottom: `${100 * lower}%`,
    width: `${100 * (right - left)}%`, height: `${100 * (upper - lower)}%`,
  });
  return box;
}

const isBox = (part) => (
  Array.isArray(part.box) && part.box.length === 4 && part.box.every((value) => typeof value === "number"));

/** One side large, to draw on. `hears`: choose(index), draw(side, box), move(index, box, gesture). */
export class Sides {
  constructor(statement, hears) {
    this.statement = statement;
    this.hears = hears;
    this.side = "front";
    this.chosen = -1;
    this.pictures = new Map();
    this.board = document.querySelector("#board");
    this.sheet = document.querySelector("#sheet");
    this.boxes = document.querySelector("#boxes");
    this.image = this.sheet.querySelector("img");
    this.thumbs = document.querySelector("#thumbs");
    new ResizeObserver(() => this.fit()).observe(this.board);
    this.sheet.addEventListener("pointerdown", (event) => this.press(event));
    this.sheet.addEventListener("pointermove", (event) => this.hover(event));
  }

  /** Load the pictures as seen by who stands before a front. */
  async load(front) {
    const told = await (await fetch(`sides/${front}`)).json();
    for (const { side, size, frame } of told) this.pictures.set(side, { size, frame, url: `sides/${front}/${side}.png` });
    this.show(this.side);
  }

  show(side) {
    this.side = side;
    const { url } = this.pictures.get(side);
    if (!this.image.src.endsWith(url)) this.image.src = url;
    this.image.alt = `The ${side} of the object`;
    this.fit();
    this.draw();
  }

  /** As large as the board allows, with the boxes' frame where the object is in the picture. */
  fit() {
    const picture = this.pictures.get(this.side);
    if (!picture) return;
    const { size: [columns, rows], frame: [left, lower, right, upper] } = picture;
    const scale = Math.min((this.board.clientWidth - 32) / columns, (this.board.clientHeight - 32) / rows);
    this.sheet.style.width = `${columns * scale}px`;
    this.sheet.style.height = `${rows * scale}px`;
    Object.assign(this.boxes.style, {
      left: `${100 * left}%`, bottom: `${100 * lower}%`,
      width: `${100 * (right - left)}%`, height: `${100 * (upper - lower)}%`,
    });
  }

  draw() {
    const focused = this.boxes.contains(document.activeElement);
    const { parts } = this.statement;
    this.boxes.replaceChildren();
    parts.forEach((part, index) => {
      for (const view of [part, ...(part.also ?? [])]) {
        if (view.side !== this.side || !isBox(view)) continue;
        const box = boxElement("button", { ...part, ...view }, index, this.chosen);
        box.type = "button";
        box.dataset.index = index;
        box.setAttribute("aria-label", `${labelOf(part)} on the ${this.side}`);
        box.setAttribute("aria-pressed", index === this.chosen);
        box.append(Object.assign(document.createElement("span"), { textContent: labelOf(part) }));
        if (view !== part) box.classList.add("also");
        // Only the keyboard clicks without a mouse.
        box.addEventListener("click", (event) => { if (!event.detail) this.hears.choose(index); });
        this.boxes.append(box);
        if (focused && index === this.chosen) box.focus({ preventScroll: true });
      }
    });
    this.drawThumbs();
  }

  drawThumbs() {
    const focused = this.thumbs.contains(document.activeElement);
    this.thumbs.replaceChildren(...SIDES.map((side, number) => {
      const picture = this.pictures.get(side);
      const thumb = document.createElement("button");
      thumb.type = "button";
      thumb.title = `Key ${number + 1}`;
      thumb.setAttribute("aria-pressed", side === this.side);
      thumb.addEventListener("click", () => this.show(side));
      const sheet = Object.assign(document.createElement("span"), { className: "sheet" });
      if (picture) {
        const { size: [columns, rows], frame: [left, lower, right, upper] } = picture;
        const scale = Math.min(64 / columns, 56 / rows);
        Object.assign(sheet.style, { width: `${columns * scale}px`, height: `${rows * scale}px`, backgroundImage: `url(${picture.url})` });
        const frame = document.createElement("span");
        Object.assign(frame.style, {
          left: `${100 * left}%`, bottom: `${100 * lower}%`,
          width: `${100 * (right - left)}%`, height: `${100 * (upper - lower)}%`,
        });
        this.statement.parts.forEach((part, index) => {
          if (part.side === side && isBox(part)) frame.append(boxElement("i", part, index, this.chosen));
        });
        sheet.append(frame);
      }
      thumb.append(sheet, Object.assign(document.createElement("span"), { textContent: side }));
      if (focused && side === this.side) setTimeout(() => thumb.focus());
      return thumb;
    }));
  }

  /** Where the mouse is, in shares of the side. */
  at(event) {
    const { left, bottom, width, height } = this.boxes.getBoundingClientRect();
    return [(event.clientX - left) / width, (bottom - event.clientY) / height];
  }

  /** Which edges of the chosen box the mouse is at: left, lower, right, upper; null: not on it. */
  grip(event) {
    const part = this.statement.parts[this.chosen];
    if (part?.side !== this.side || !isBox(part)) return null;
    const { width, height } = this.boxes.getBoundingClientRect();
    const [x, y] = this.at(event);
    const away = [x - part.box[0], y - part.box[1], part.box[2] - x, part.box[3] - y]
      .map((share, edge) => share * (edge % 2 ? height : width));
    if (Math.min(...away) < -GRIP) return null;
    const near = away.map((pixels) => Math.abs(pixels) <= GRIP);
    // A small box can be moved all the same.
    if (near[0] && near[2]) near[2] = false;
    if (near[1] && near[3]) near[3] = false;
    return near;
  }

  hover(event) {
    if (event.buttons) return;
    const grip = this.grip(event);
    const [left, lower, right, upper] = grip ?? [];
    this.sheet.style.cursor = !grip ? "crosshair"
      : (left && upper) || (right && lower) ? "nwse-resize" : (left && lower) || (right && upper) ? "nesw-resize"
        : left || right ? "ew-resize" : lower || upper ? "ns-resize" : "move";
  }

  press(event) {
    if (event.button) return;
    event.preventDefault();
    const grip = event.shiftKey ? null : this.grip(event);
    const start = this.at(event);
    const from = [event.clientX, event.clientY];
    const under = event.target.closest("[data-index]");
    const index = this.chosen;
    const box = grip && [...this.statement.parts[index].box];
    const gesture = {};
    let drawn = null;
    this.sheet.setPointerCapture(event.pointerId);
    const move = (now) => {
      const far = Math.hypot(now.clientX - from[0], now.clientY - from[1]) >= CLICK;
      if (!far && !drawn) return;
      const [x, y] = this.at(now);
      if (grip) {
        drawn = moved(box, grip, x - start[0], y - start[1]);
        this.hears.move(index, drawn, gesture);
      } else {
        drawn = boxOf([...start, x, y]);
        this.sketch(drawn);
      }
    };
    const end = (now) => {
      this.sheet.removeEventListener("pointermove", move);
      this.sketch(null);
      if (now.type === "pointercancel") return;
      if (!drawn) this.hears.choose(under ? Number(under.dataset.index) : -1);
      else if (!grip) this.hears.draw(this.side, drawn);
    };
    this.sheet.addEventListener("pointermove", move);
    for (const name of ["pointerup", "pointercancel"]) this.sheet.addEventListener(name, end, { once: true });
  }

  /** Show the box that is being drawn. */
  sketch(box) {
    this.sketched?.remove();
    if (!box) return;
    this.sketched = boxElement("i", { box, side: this.side }, this.statement.parts.length, -1);
    this.sketched.classList.add("sketch");
    this.boxes.append(this.sketched);
  }
}

/** A box moved, or with the gripped edges moved, by shares of the side. */
export function moved(box, grip, across, up) {
  if (!grip.some(Boolean)) {
    const right = Math.min(Math.max(across, -box[0]), 1 - box[2]);
    const above = Math.min(Math.max(up, -box[1]), 1 - box[3]);
    return boxOf([box[0] + right, box[1] + above, box[2] + right, box[3] + above]);
  }
  return boxOf(box.map((value, edge) => value + (grip[edge] ? (edge % 2 ? up : across) : 0)));
}
