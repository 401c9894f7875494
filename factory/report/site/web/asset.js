// One asset's page: sliders, switches, the plot, and findings that jump to where they are.
import { Box3, Vector3 } from "three";
import { takeDrops } from "./drop.js";
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

/** So many joints are shown without a filter. */
const MANY = 12;

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
    this.scale();
    const { start } = told;
    const posed = this.fromAddress();
    if (posed.size) this.set(posed);
    else if (start) this.show(start);
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
      const pose = (value) => this.set(new Map([[joint.name, value]]));
      const output = make("input", { class: "value", id: `value-${number}`, "aria-label": `${joint.name}, value`, autocomplete: "off" });
      slider.addEventListener("input", () => pose(Number(slider.value)));
      output.addEventListener("change", () => {
        const value = joint.read(output.value);
        pose(Number.isFinite(value) ? value : this.model.values.get(joint.name));
      });
      const below = this.model.below(joint);
      const others = this.model.names.map((_, link) => link).filter((link) => !below.has(link));
      const [from, to] = joint.ends.map((end) => make("span", {}, end));
      const tools = make("span", { class: "tools" },
        this.tool("Play", joint.name, () => this.play(joint)),
        this.tool("Hide", joint.name, (button) => this.hide(button, below)),
        this.tool("Alone", joint.name, (button) => this.hide(button, others)));
      const row = make("li", {}, make("label", { for: slider.id }, joint.name), output, slider,
        make("span", { class: "ends" }, from, tools, to));
      for (const event of ["pointerenter", "focusin"]) row.addEventListener(event, () => { this.viewer.chosen = joint; });
      for (const event of ["pointerleave", "focusout"]) row.addEventListener(event, () => { this.viewer.chosen = null; });
      list.append(row);
      this.sliders.set(joint.name, { slider, output, joint, row });
    }
    const filter = find("#joint-filter");
    filter.hidden = this.sliders.size <= MANY;
    filter.addEventListener("input", () => {
      const wanted = filter.value.trim().toLowerCase();
      for (const { row, joint } of this.sliders.values()) row.hidden = !joint.name.toLowerCase().includes(wanted);
    });
    const over = (joint) => {
      this.viewer.chosen = joint;
      for (const { row, joint: own } of this.sliders.values()) {
        row.classList.toggle("over", own === joint);
        if (own === joint) row.scrollIntoView({ block: "nearest" });
      }
    };
    new Grab(this.viewer, {
      over,
      chose: (joint) => { this.stop(); over(joint); },
      moved: (joint, value) => this.set(new Map([[joint.name, value]])),
    });
  }

  tool(label, name, action) {
    const button = make("button", { type: "button", "aria-label": `${label} ${name}`, "aria-pressed": "false" }, label);
    button.addEventListener("click", () => action(button));
    return button;
  }

  /** Hide links while a button is pressed; one button at a time. */
  hide(button, links) {
    const pressed = button.getAttribute("aria-pressed") === "false";
    for (const other of document.querySelectorAll("#joints button")) other.setAttribute("aria-pressed", "false");
    button.setAttribute("aria-pressed", String(pressed));
    this.viewer.hidden = new Set(pressed ? links : []);
    this.viewer.apply();
  }

  buttons() {
    const on = (selector, action) => find(selector)?.addEventListener("click", action);
    on("#open", () => this.glide(1));
    on("#close", () => this.glide(0));
    on("#play", () => this.play());
    on("#view", () => this.viewer.reset());
    on("#person", () => {
      const shown = !this.viewer.shown.person;
      this.viewer.shown.person = shown;
      find("#person").setAttribute("aria-pressed", String(shown));
      this.viewer.apply();
      this.viewer.reset();
    });
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
      output.value = joint.told(value);
      slider.setAttribute("aria-valuetext", joint.told(value));
      this.follow?.get(name)?.(value);
    }
    this.viewer.draw();
    if (this.checking) return;
    this.checking = true;
    requestAnimationFrame(() => {
      this.checking = false;
      if (!this.running) this.toAddress();
      const contacts = this.bodies.contacts(this.model.values, this.told.excess);
      this.viewer.point(contacts, this.place);
      this.tell(contacts);
    });
  }

  tell(contacts) {
    const deepest = contacts.reduce((most, contact) => (contact.depth > (most?.depth ?? 0) ? contact : most), null);
    const { rest } = this.bodies;
    const note = find("#contact");
    note.classList.toggle("bad", Boolean(deepest));
    const nameOf = (link) => this.model.names[link];
    const depth = (metres) => `${(1000 * metres).toFixed(1)} mm`;
    if (!this.model.hulls.length) note.textContent = "No collision geometry in this file";
    else if (deepest) {
      const names = [deepest.one, deepest.other].map((hull) => nameOf(hull.link)).join(" and ");
      note.textContent = `${names}: ${depth(deepest.depth)} into each other`;
    } else {
      const [links, most] = [...rest].reduce((a, b) => (b[1] > a[1] ? b : a), ["", 0]);
      note.textContent = most > this.told.excess
        ? `${links.split(",").map(nameOf).join(" and ")} overlap by ${depth(most)} when closed; no further contact in this pose`
        : "No contact in this pose";
    }
  }

  /** Values of joints that the address names after its #. */
  fromAddress() {
    const told = [...new URLSearchParams(location.hash.slice(1))].map(([name, text]) => [name, Number(text)]);
    return new Map(told.filter(([name, value]) => this.sliders.has(name) && Number.isFinite(value)));
  }

  /** Put the pose into the address, so that it can be handed on; of what is closed, nothing. */
  toAddress() {
    const open = [...this.sliders.values()].map(({ joint }) => [joint, this.model.values.get(joint.name)])
      .filter(([joint, value]) => Math.abs(value - joint.lower) > 1e-6)
      .map(([joint, value]) => [joint.name, value.toFixed(4)]);
    const hash = new URLSearchParams(open).toString();
    if (hash !== location.hash.slice(1)) history.replaceState(null, "", hash ? `#${hash}` : location.pathname + location.search);
  }

  /** Draw a bar of a round length, as long as things at the middle of the object are. */
  scale() {
    const { viewer } = this;
    const bar = find("#scale");
    viewer.drawn = () => {
      const { camera, controls, canvas } = viewer;
      const tall = 2 * camera.position.distanceTo(controls.target) * Math.tan((camera.fov * Math.PI) / 360);
      const rough = (110 / canvas.clientHeight) * tall;
      const power = 10 ** Math.floor(Math.log10(rough));
      const length = [5, 2, 1].find((factor) => factor * power <= rough) * power;
      bar.style.width = `${(length / tall) * canvas.clientHeight}px`;
      bar.textContent = length < 0.01 ? `${+(1000 * length).toPrecision(1)} mm` : length < 1 ? `${+(100 * length).toPrecision(1)} cm` : `${length} m`;
    };
    const box = new Box3().setFromPoints(viewer.closed);
    const size = box.isEmpty() ? [] : box.getSize(new Vector3()).toArray();
    const told = find("#size");
    if (told) told.textContent = size.length ? `${size.map((side) => +side.toPrecision(2)).join(" x ")} m` : "";
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

  /** Open and close one joint, or all of them, until it is stopped. */
  play(joint = null) {
    if (this.running) return this.stop();
    if (!joint) find("#play").setAttribute("aria-pressed", "true");
    this.run(4000, (part) => {
      const eased = 0.5 - 0.5 * Math.cos(2 * Math.PI * part);
      this.set(joint ? new Map([[joint.name, joint.at(eased)]]) : this.model.opened(eased));
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
      else if (event.key === "m") find("#person").click();
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
if (document.body.classList.contains("live")) takeDrops(find("#drop"));
if (find("#told") && window.factoryModel) start();
else if (!document.body.classList.contains("edit-page")) document.body.classList.add("still");
