// The list of parts: what each is, where it is hinged, how far it is open, what is wrong with it.
import { colorOf } from "./sides.js";
import { KEYS, hingesOf, labelOf } from "./statement.js";

export function make(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key === "class") made.className = value;
    else if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
    else if (value !== false) made.setAttribute(key, value);
  }
  made.append(...children);
  return made;
}

/** Which parts a sentence of the reader is about. */
export function placesIn(sentence) {
  return [...sentence.matchAll(/parts\[(\d+)\]/g)].map((found) => Number(found[1]));
}

const whereOf = ({ side, count }) => (side ? `on the ${side}` : count > 1 ? `${count} of them` : "found by Build");

/** `hears`: choose(index), kind(index, kind), hinge(index, hinge), remove(index), open(index, value). */
export class Parts {
  constructor(statement, kinds, hears) {
    this.statement = statement;
    this.kinds = kinds;
    this.hears = hears;
    this.list = document.querySelector("#parts");
    this.sliders = new Map();
  }

  /** Draw the list. `jointOf(index)` is the joint that opens a part, if it is shown. */
  draw(chosen, sentence, jointOf) {
    const focused = this.list.contains(document.activeElement) ? document.activeElement.dataset.focus : null;
    this.sliders.clear();
    const wrong = placesIn(sentence);
    const told = wrong.includes(chosen) ? chosen : wrong.at(-1);
    this.list.replaceChildren(...this.statement.parts.map((part, index) => {
      const row = this.row(part, index, index === chosen);
      const joint = jointOf(index);
      if (joint && index === chosen) row.append(this.slider(index, joint));
      row.classList.toggle("refused", wrong.includes(index));
      if (index === told) row.append(make("p", { class: "wrong" }, sentence));
      return row;
    }));
    if (focused) this.list.querySelector(`[data-focus="${focused}"]`)?.focus({ preventScroll: true });
  }

  row(part, index, chosen) {
    const title = make(
      "button", {
        type: "button", class: "name", "aria-expanded": chosen, "data-focus": `name-${index}`,
        onclick: () => this.hears.choose(index),
      },
      make("span", { class: `swatch ${colorOf(index)}` }), make("b", {}, labelOf(part)),
      make("span", { class: "dim" }, whereOf(part)),
    );
    const remove = make("button", {
      type: "button", class: "remove", "aria-label": `Delete ${labelOf(part)}`, title: "Key Delete",
      "data-focus": `remove-${index}`, onclick: () => this.hears.remove(index),
    }, "×");
    const row = make("li", { class: chosen ? "chosen" : "" }, title, remove);
    if (chosen) row.append(this.kind(part, index), ...this.hinge(part, index));
    return row;
  }

  kind(part, index) {
    const pick = (kind) => make("button", {
      type: "button", "aria-pressed": kind === part.kind, title: KEYS[kind] ? `Key ${KEYS[kind]}` : false,
      "data-focus": `kind-${index}-${kind}`, onclick: () => this.hears.kind(index, kind),
    }, ...withKey(kind, KEYS[kind]));
    return make("div", { class: "picks", role: "group", "aria-label": "Kind" }, ...this.kinds.map(pick));
  }

  hinge(part, index) {
    const hinges = hingesOf(part);
    if (!hinges.length) return [];
    const pick = (hinge, label) => make("button", {
      type: "button", "aria-pressed": hinge === (part.hinge ?? ""), title: "Key g",
      "data-focus": `hinge-${index}-${hinge}`, onclick: () => this.hears.hinge(index, hinge),
    }, label);
    return [make(
      "div", { class: "picks hinges", role: "group", "aria-label": "Hinge" },
      make("span", { class: "dim" }, "Hinge"), pick("", "any"), ...hinges.map((hinge) => pick(hinge, hinge)),
    )];
  }

  slider(index, joint) {
    const slider = make("input", {
      type: "range", min: joint.lower, max: joint.upper, step: (joint.upper - joint.lower) / 500 || 1,
      "aria-label": `How far ${joint.name} is open`, "data-focus": `slider-${index}`,
      oninput: () => this.hears.open(index, Number(slider.value)),
    });
    const output = make("output");
    this.sliders.set(joint.name, { slider, output, joint });
    return make("label", { class: "opening" }, slider, output);
  }

  /** Let the sliders follow the model. */
  follow(values) {
    for (const [name, { slider, output, joint }] of this.sliders) {
      const value = values.get(name) ?? 0;
      slider.value = value;
      output.textContent = joint.told(value);
    }
  }
}

/** A word with its key underlined. */
function withKey(word, key) {
  const at = key ? word.indexOf(key) : -1;
  return at < 0 ? [word] : [word.slice(0, at), make("u", {}, key), word.slice(at + 1)];
}
