// The page: what is stated, drawn on the sides and opened in three dimensions.
import { Parts, make, placesIn } from "./parts.js";
import { SIDES, Sides, moved } from "./sides.js";
import { Stage } from "./stage.js";
import { KEYS, Statement, hingesOf, labelOf } from "./statement.js";
import { Verdict } from "./verdict.js";

const find = (selector) => document.querySelector(selector);
/** How far an arrow key moves a box or an edge, in shares of the side. */
const STEP = 0.005;
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

class Page {
  constructor(state, model) {
    this.state = state;
    this.plain = model;
    this.chosen = -1;
    this.sentence = state.sentence;
    this.kind = "door";
    const { stated, found } = state;
    this.statement = new Statement(structuredClone(stated ?? (found.parts ? found : { parts: [] })), () => this.change());
    this.sides = new Sides(this.statement, {
      choose: (index) => this.choose(index),
      draw: (side, box) => this.add({ kind: this.kind, side, box }),
      move: (index, box, gesture) => this.statement.set(index, { box }, gesture),
    });
    this.parts = new Parts(this.statement, state.kinds, {
      choose: (index) => this.choose(index === this.chosen ? -1 : index),
      kind: (index, kind) => this.setKind(index, kind),
      hinge: (index, hinge) => this.statement.set(index, { hinge: hinge || undefined }),
      remove: (index) => this.remove(index),
      open: (index, value) => this.stage.pose(new Map([[this.jointOf(index).name, value]])),
    });
    this.stage = new Stage({
      posed: (values) => this.parts.follow(values),
      chose: (joint) => this.choose(this.indexOf(joint)),
    });
    this.verdict = new Verdict({
      built: (told, built) => this.built(told, built),
      go: (place) => {
        this.shows("built");
        this.stage.go(place);
      },
      sentence: (text) => this.say(text),
    });
    this.saved = stated ? this.statement.text : "";
    this.text = find("#text");
    this.controls();
    this.keys();
  }

  async start() {
    const { state } = this;
    find("#facts").replaceChildren(
      make("span", {}, `Saved as ${state.sidecar} beside it`), make("span", {}, `registered in ${state.output}`),
    );
    this.turned = this.front;
    await this.sides.load(this.front);
    this.stage.show(this.plain, this.front);
    this.shown = "stated";
    this.refresh();
    // What cannot be read is there to be put right.
    if (state.text && !state.stated) {
      this.text.value = state.text;
      find("#as-text").open = true;
    }
    document.body.classList.add("ready");
    performance.mark("ready");
    if (this.statement.parts.length) this.preview();
    else if (!state.text) this.guess();
    window.factory = { page: this };
  }

  get front() {
    const { front } = this.statement.values;
    return this.state.fronts.includes(front) ? front : "-y";
  }

  /** What is stated has changed. */
  change() {
    this.chosen = Math.min(this.chosen, this.statement.parts.length - 1);
    this.sentence = "";
    this.shows("stated");
    if (this.turned !== this.front) {
      this.turned = this.front;
      this.sides.load(this.front);
      this.stage.turn(this.front);
    }
    this.refresh();
    this.preview();
  }

  refresh() {
    const { statement, sides } = this;
    sides.chosen = this.chosen;
    sides.draw();
    this.parts.draw(this.chosen, this.sentence, (index) => this.jointOf(index));
    if (this.stage.model) this.parts.follow(this.stage.model.values);
    if (document.activeElement !== this.text) this.text.value = statement.text;
    find("#undo").disabled = !statement.past.length;
    find("#redo").disabled = !statement.future.length;
    find("#save").disabled = statement.text === this.saved;
    find("#build").disabled = !this.verdict.running && !statement.parts.length && statement.values.opens !== false;
    const elsewhere = this.sentence && !placesIn(this.sentence).some((index) => index < statement.parts.length);
    const hint = statement.parts.length || this.guessing ? "" : "Draw a box on a picture around each part that opens.";
    find("#said").className = elsewhere ? "wrong" : "dim";
    find("#said").textContent = elsewhere ? this.sentence : this.guessing ? "Looking for what opens…" : hint;
  }

  say(sentence) {
    this.sentence = sentence;
    this.refresh();
  }

  choose(index) {
    this.chosen = index;
    const part = this.statement.parts[index];
    if (part?.side && part.side !== this.sides.side && this.sides.pictures.has(part.side)) this.sides.show(part.side);
    this.refresh();
    this.highlight();
  }

  highlight() {
    if (this.stage.viewer) this.stage.viewer.chosen = this.jointOf(this.chosen) ?? null;
  }

  add(part) {
    this.chosen = this.statement.parts.length;
    this.statement.add(part);
  }

  remove(index) {
    if (!this.statement.parts[index]) return;
    this.chosen = -1;
    this.statement.remove(index);
  }

  setKind(index, kind) {
    this.kind = kind;
    if (this.statement.parts[index]) this.statement.set(index, { kind });
  }

  nextHinge(step) {
    const part = this.statement.parts[this.chosen];
    const hinges = part ? ["", ...hingesOf(part)] : [];
    if (hinges.length < 2) return;
    const next = hinges[(hinges.indexOf(part.hinge ?? "") + step + hinges.length) % hinges.length];
    this.statement.set(this.chosen, { hinge: next || undefined });
  }

  nameOf(index) {
    return this.statement.parts[index]?.name || `stated.${index}`;
  }

  jointOf(index) {
    const { model } = this.stage;
    if (!model || index < 0) return undefined;
    return model.free.find((joint) => model.names[joint.child] === this.nameOf(index));
  }

  indexOf(joint) {
    const name = this.stage.model.names[joint.child];
    return this.statement.parts.findIndex((_, index) => this.nameOf(index) === name);
  }

  /** Ask for the parts opened; while one answer is awaited, only the last state is asked next. */
  async preview() {
    this.asked = true;
    if (this.previewing) return;
    this.previewing = true;
    while (this.asked) {
      this.asked = false;
      const boxed = this.statement.parts.some((part) => part.box);
      const text = this.statement.text;
      this.stage.note.textContent = boxed ? "Looking…" : "";
      const answer = boxed || !this.statement.parts.length ? await fetch("preview", { method: "POST", body: text }) : null;
      if (text !== this.statement.text || !answer) continue;
      if (answer.ok) {
        this.stated = await answer.arrayBuffer();
        this.sentence = "";
        if (this.shown === "stated") this.stage.show(this.stated, this.front);
      } else this.sentence = (await answer.json()).sentence;
    }
    this.previewing = false;
    this.stage.note.textContent = "";
    this.refresh();
    this.highlight();
  }

  /** Ask what the factory sees; what somebody has drawn meanwhile stays. */
  async guess() {
    this.guessing = true;
    this.refresh();
    const answer = await fetch("guess", { method: "POST", body: "" });
    const found = answer.ok ? await answer.json() : {};
    this.guessing = false;
    if (found.parts && !this.statement.past.length) {
      this.statement.values = found;
      this.change();
    } else this.refresh();
  }

  async save() {
    const { text } = this.statement;
    const answer = await fetch("save", { method: "POST", body: text });
    if (answer.ok) this.saved = text;
    this.say(answer.ok ? "" : (await answer.json()).sentence);
  }

  async build() {
    if (this.verdict.running) return this.verdict.stop();
    this.saved = this.statement.text;
    this.building = this.saved;
    this.refresh();
    return this.verdict.begin(this.saved);
  }

  built(told, model) {
    this.product = model && { model, told: told.shown };
    find("#shows").hidden = !model;
    if (this.statement.text !== this.building) return;
    if (!told.passed && placesIn(told.message).length) this.say(told.message);
    if (!model) return;
    this.shows("built");
    if (told.shown.start) this.stage.go(told.shown.start);
    else this.stage.glide(1);
  }

  /** Show the object as stated or as built. */
  shows(which) {
    if (which === this.shown || (which === "built" && !this.product)) return;
    this.shown = which;
    for (const button of document.querySelectorAll("[data-shows]")) button.setAttribute("aria-pressed", button.dataset.shows === which);
    if (which === "built") this.stage.show(this.product.model, this.front, this.product.told);
    else this.stage.show(this.stated ?? this.plain, this.front);
    this.refresh();
    this.highlight();
  }

  controls() {
    const on = (selector, act) => find(selector).addEventListener("click", act);
    on("#undo", () => this.statement.undo());
    on("#redo", () => this.statement.redo());
    on("#save", () => this.save());
    on("#build", () => this.build());
    on("#add", () => this.addHere());
    on("#view", () => this.stage.reset());
    for (const button of document.querySelectorAll("[data-shows]")) button.addEventListener("click", () => this.shows(button.dataset.shows));
    this.text.addEventListener("input", () => this.read());
    this.text.addEventListener("blur", () => this.refresh());
  }

  addHere() {
    this.add({ kind: this.kind, side: this.sides.side, box: [0.3, 0.3, 0.7, 0.7] });
    find("#boxes .chosen")?.focus({ preventScroll: true });
  }

  /** Take what was typed, if it is JSON. */
  read() {
    let values;
    try {
      values = JSON.parse(this.text.value);
      if (values === null || typeof values !== "object" || Array.isArray(values)) throw new SyntaxError("want an object");
    } catch (error) {
      this.say(`is not JSON: ${error.message}`);
      return;
    }
    this.statement.change(() => { this.statement.values = values; }, this.text);
  }

  keys() {
    document.addEventListener("keydown", (event) => {
      const { key, target } = event;
      const control = event.ctrlKey || event.metaKey;
      const typing = target.closest("textarea");
      if (control && key === "Enter") this.build();
      else if (control && key.toLowerCase() === "s") this.save();
      else if (typing || event.altKey) return;
      else if (control && key.toLowerCase() === "z") this.statement[event.shiftKey ? "redo" : "undo"]();
      else if (control && key.toLowerCase() === "y") this.statement.redo();
      else if (control || !this.press(key, event.shiftKey, target)) return;
      event.preventDefault();
    });
  }

  /** Do what a key says; tells whether it says anything. */
  press(key, shift, target) {
    const part = this.statement.parts[this.chosen];
    if (ARROWS[key]) {
      // A slider and the camera have arrows of their own.
      if (!part?.box || target.closest("input, canvas")) return false;
      const [across, up] = ARROWS[key].map((sign) => sign * STEP);
      const grip = shift ? [false, false, true, true] : [false, false, false, false];
      this.statement.set(this.chosen, { box: moved(part.box, grip, across, up) }, `arrows ${this.chosen}`);
      return true;
    }
    const small = key.toLowerCase();
    const kind = this.state.kinds.find((each) => KEYS[each] === small);
    const acts = {
      n: () => this.addHere(),
      g: () => this.nextHinge(shift ? -1 : 1),
      u: () => this.statement.undo(),
      y: () => this.statement.redo(),
      o: () => this.stage.glide(this.stage.share > 0.5 ? 0 : 1),
      v: () => this.stage.reset(),
      delete: () => this.remove(this.chosen),
      backspace: () => this.remove(this.chosen),
      escape: () => this.choose(-1),
      "[": () => this.step(-1),
      "]": () => this.step(1),
    };
    if (acts[small]) acts[small]();
    else if (kind) this.setKind(this.chosen, kind);
    else if (SIDES[Number(key) - 1]) this.sides.show(SIDES[Number(key) - 1]);
    else return false;
    return true;
  }

  step(by) {
    const count = this.statement.parts.length;
    if (count) this.choose((Math.max(this.chosen, by < 0 ? 0 : -1) + by + count) % count);
  }
}

async function start() {
  const [state, model] = await Promise.all([fetch("state"), fetch("model.glb")]);
  const page = new Page(await state.json(), await model.arrayBuffer());
  await page.start();
}

start();
