// One asset's page: sliders, switches, the plot, and findings that jump to where they are.
import { Bodies } from "./hulls.js";
import { Grab } from "./grab.js";
import { Model, unpacked } from "./model.js";
import { sweepPlot } from "./plot.js";
import { Viewer } from "./viewer.js";

const find = (selector) => document.querySelector(selector);
const SWITCHES = [
  ["visuals", "Surface", "v"], ["hulls", "Hulls", "h"], ["axes", "Axes", "a"], ["limits", "Limits", "l"],
  ["contacts", "Contacts", "x"], ["replaced", "Before repairs", "b"],
];

function make(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key === "class") made.className = value;
    else if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
    else made.setAttribute(key, value);
  }
  made.append(...children);
  return made;
}

class Page {
  constructor(model, told) {
    this.model = model;
    this.told = told;
    this.viewer = new Viewer(find("#stage canvas"), model, told.view);
    this.bodies = new Bodies(model, told.ignored);
    this.sliders = new Map();
    this.place = null;
    this.switches();
    this.joints();
    this.buttons();
    this.findings();
    this.keys();
    const start = told.start;
    if (start) this.show(start);
    else this.set(model.opened(0));
    document.body.classList.add("ready");
    if (model.hulls.length && model.free.length) this.plots();
    // For tests, and for people with a console.
    window.factory = { model, viewer: this.viewer, bodies: this.bodies, page: this };
  }

  switches() {
    for (const [name, label, key] of SWITCHES) {
      if (["hulls", "replaced"].includes(name) && !this.model[name].length) continue;
      const box = make("input", { type: "checkbox", id: `show-${name}` });
      box.checked = this.viewer.shown[name];
      box.addEventListener("change", () => {
        this.viewer.shown[name] = box.checked;
        this.viewer.apply();
      });
      find("#switches").append(make("label", { title: `Key ${key}` }, box, make("span", {}, label)));
    }
  }

  joints() {
    const list = find("#joints");
    for (const joint of this.model.free) {
      const number = this.sliders.size;
      const slider = make("input", {
        type: "range", min: joint.lower, max: joint.upper, id: `joint-${number}`,
        step: (joint.upper - joint.lower) / 1000 || 1,
      });
      const output = make("output", { for: slider.id });
      slider.addEventListener("input", () => this.set(new Map([[joint.name, Number(slider.value)]])));
      const row = make("li", {}, make("label", { for: slider.id }, joint.name), output, slider,
        make("span", { class: "ends" }, make("span", {}, joint.told(joint.lower)), make("span", {}, joint.told(joint.upper))));
      for (const event of ["pointerenter", "focusin"]) row.addEventListener(event, () => { this.viewer.chosen = joint; });
      for (const event of ["pointerleave", "focusout"]) row.addEventListener(event, () => { this.viewer.chosen = null; });
      list.append(row);
      this.sliders.set(joint.name, { slider, output, joint });
    }
  }

  buttons() {
    const on = (selector, action) => find(selector)?.addEventListener("click", action);
    on("#open", () => this.glide(1));
    on("#close", () => this.glide(0));
    on("#play", () => this.play());
    on("#view", () => this.viewer.reset());
    on("#save", () => {
      const url = URL.createObjectURL(new Blob([this.model.buffer], { type: "model/gltf-binary" }));
      const link = make("a", { href: url, download: `${this.told.name}.glb` });
      link.click();
      setTimeout(() => URL.revokeObjectURL(url), 1000);
    });
  }

  /** Pose the model, with the sliders and the plots following. */
  set(values, place = null) {
    this.model.pose(values);
    this.place = place;
    for (const [name, { slider, output, joint }] of this.sliders) {
      const value = this.model.values.get(name);
      slider.value = value;
      output.textContent = joint.told(value);
      slider.setAttribute("aria-valuetext", joint.told(value));
      this.follow?.get(name)?.(value);
    }
    this.viewer.draw();
    if (this.checking) return;
    this.checking = true;
    requestAnimationFrame(() => {
      this.checking = false;
      const contacts = this.bodies.contacts(this.model.values, this.told.excess);
      this.viewer.point(contacts, this.place);
      this.tell(contacts);
    });
  }

  tell(contacts) {
    const deepest = contacts.reduce((most, contact) => (contact.depth > (most?.depth ?? 0) ? contact : most), null);
    const note = find("#contact");
    note.classList.toggle("bad", Boolean(deepest));
    const names = deepest ? [deepest.one, deepest.other].map((hull) => this.model.names[hull.link]).join(" and ") : "";
    note.textContent = deepest
      ? `${names}: ${(1000 * deepest.depth).toFixed(1)} mm into each other`
      : this.model.hulls.length ? "No contact in this pose" : "";
  }

  /** Go to a pose, and mark a place in it. */
  show({ values, point }) {
    const wanted = this.model.opened(0);
    for (const [name, value] of Object.entries(values)) wanted.set(name, value);
    this.stop();
    this.set(wanted, point);
  }

  glide(share) {
    this.stop();
    const goal = this.model.opened(share);
    if (matchMedia("(prefers-reduced-motion: reduce)").matches) return this.set(goal);
    const start = new Map(this.model.values);
    this.run(600, (part) => {
      const eased = part * part * (3 - 2 * part);
      this.set(new Map([...goal].map(([name, to]) => [name, start.get(name) + eased * (to - start.get(name))])));
      return part < 1;
    });
  }

  play() {
    if (this.running) return this.stop();
    find("#play").setAttribute("aria-pressed", "true");
    this.run(4000, (part) => {
      const eased = 0.5 - 0.5 * Math.cos(2 * Math.PI * part);
      this.set(this.model.opened(eased));
      return true;
    });
  }

  run(length, step) {
    const token = {};
    this.running = token;
    const begun = performance.now();
    const next = (now) => {
      if (this.running !== token) return;
      const part = Math.max(0, now - begun) / length;
      if (step(Math.min(part, length > 1000 ? part % 1 : 1))) requestAnimationFrame(next);
      else this.running = null;
    };
    requestAnimationFrame(next);
  }

  stop() {
    this.running = null;
    find("#play")?.setAttribute("aria-pressed", "false");
  }

  findings() {
    for (const button of document.querySelectorAll("button[data-place]")) {
      button.hidden = false;
      button.addEventListener("click", () => {
        this.show(this.told.places[Number(button.dataset.place)]);
        find("#stage").scrollIntoView({ block: "nearest", behavior: "smooth" });
      });
    }
  }

  keys() {
    document.addEventListener("keydown", (event) => {
      if (event.target.closest("input[type=search], select, textarea") || event.ctrlKey || event.metaKey || event.altKey) return;
      const [name] = SWITCHES.find(([, , key]) => key === event.key) ?? [];
      if (name) find(`#show-${name}`)?.click();
      else if (event.key === "o") this.glide(1);
      else if (event.key === "c") this.glide(0);
      else if (event.key === "p") this.play();
      else if (event.key === "r") this.viewer.reset();
    });
  }

  /** One plot per joint, measured one after another so that the page stays awake. */
  plots() {
    find("#sweeps").hidden = false;
    this.follow = new Map();
    const waiting = [...this.model.free];
    const next = () => {
      const joint = waiting.shift();
      if (!joint) return;
      const told = this.told.sweeps[joint.name] ?? { marks: [], open: {} };
      const others = new Map([...this.model.opened(0), ...Object.entries(told.open)]);
      const curves = this.bodies.sweep(joint, others);
      const jump = (value) => this.set(new Map([...others, [joint.name, value]]));
      const nameOf = (link) => this.model.names[link];
      const { svg, shown, follow } = sweepPlot(joint, curves, told.marks, jump, nameOf);
      const key = make("ul", { class: "key" }, ...shown.map(({ links }, number) => (
        make("li", { class: `c${number}` }, links.map(nameOf).join(" – ")))));
      const note = shown.length || told.marks.length ? key : make("p", { class: "dim" }, "Nothing comes within 50 mm.");
      const also = Object.keys(told.open);
      const title = make("h3", {}, joint.name, ...(also.length ? [make("small", {}, ` with ${also.join(", ")} open`)] : []));
      find("#plots").append(make("figure", {}, title, ...(shown.length || told.marks.length ? [svg] : []), note));
      follow(this.model.values.get(joint.name));
      this.follow.set(joint.name, follow);
      setTimeout(next, 0);
    };
    setTimeout(next, 50);
  }
}

async function start() {
  const told = JSON.parse(find("#told").textContent);
  try {
    const model = new Model(await unpacked(window.factoryModel));
    new Page(model, told);
  } catch (error) {
    // Without WebGL the pictures are there.
    document.body.classList.add("still");
    find("#stage-note").textContent = "This browser cannot show the model (no WebGL). The pictures show it.";
    console.warn(error);
  }
}

// For pages that show models of their own.
window.factoryView = { Bodies, Grab, Model, Viewer };
if (find("#told") && window.factoryModel) start();
else if (!document.body.classList.contains("edit-page")) document.body.classList.add("still");
