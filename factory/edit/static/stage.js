// The object in three dimensions: as it is stated, or as it was built.
const { Bodies, Grab, Model, Viewer } = window.factoryView;
const TOWARD = { "-y": [0.5, -1, 0.42], y: [-0.5, 1, 0.42], "-x": [-1, -0.5, 0.42], x: [1, 0.5, 0.42] };

/** `hears`: posed(values), chose(joint). */
export class Stage {
  constructor(hears) {
    this.hears = hears;
    this.canvas = document.querySelector("#stage canvas");
    this.note = document.querySelector("#stage-note");
    this.contact = document.querySelector("#contact");
    this.slider = document.querySelector("#open");
    this.slider.addEventListener("input", () => this.openAll(Number(this.slider.value)));
  }

  /** Show a GLB; what was open stays open by as large a share. `told`: of a build. */
  show(buffer, front, told = null) {
    const shares = this.shares();
    const model = new Model(buffer);
    this.told = told;
    this.bodies = told && model.hulls.length ? new Bodies(model, told.ignored) : null;
    if (this.viewer) this.viewer.replace(model);
    else {
      this.viewer = new Viewer(this.canvas, model, TOWARD[front]);
      this.grab = new Grab(this.viewer, {
        moved: (joint, value) => this.pose(new Map([[joint.name, value]])),
        chose: (joint) => this.hears.chose(joint),
      });
      this.viewer.controls.addEventListener("start", () => { this.looked = true; });
    }
    this.model = model;
    // What opens is in sight when it does, unless somebody looks elsewhere.
    if (!this.looked) this.viewer.reset();
    this.viewer.shown.hulls = false;
    this.slider.disabled = !model.free.length;
    this.pose(new Map(model.free.map((joint) => [joint.name, joint.at(shares.get(joint.name) ?? this.share)])));
  }

  /** Look at another front. */
  turn(front) {
    this.viewer.front = TOWARD[front];
    this.viewer.frame();
    this.viewer.reset();
  }

  /** Look at all of it again. */
  reset() {
    this.looked = false;
    this.viewer.reset();
  }

  get share() {
    return Number(this.slider.value);
  }

  shares() {
    const free = this.model?.free ?? [];
    return new Map(free.map((joint) => {
      const span = joint.upper - joint.lower;
      return [joint.name, span ? (this.model.values.get(joint.name) - joint.lower) / span : 0];
    }));
  }

  pose(values, place = null) {
    this.model.pose(values);
    this.hears.posed(this.model.values);
    clearTimeout(this.checking);
    const { bodies, told } = this;
    if (!bodies) {
      this.tell([], place);
      return;
    }
    this.checking = setTimeout(() => this.tell(bodies.contacts(this.model.values, told.excess), place), 30);
    this.viewer.draw();
  }

  /** Mark what meets what, and a place. */
  tell(contacts, place) {
    this.viewer.point(contacts, place);
    const deepest = contacts.reduce((most, each) => (each.depth > (most?.depth ?? 0) ? each : most), null);
    this.contact.classList.toggle("bad", Boolean(deepest));
    const names = deepest ? [deepest.one, deepest.other].map((hull) => this.model.names[hull.link]).join(" and ") : "";
    this.contact.textContent = deepest ? `${names}: ${(1000 * deepest.depth).toFixed(1)} mm into each other` : "";
  }

  openAll(share) {
    this.slider.value = share;
    if (this.model) this.pose(this.model.opened(share));
  }

  /** Open or close everything smoothly. */
  glide(goal) {
    const start = this.share;
    const token = {};
    this.running = token;
    if (matchMedia("(prefers-reduced-motion: reduce)").matches) return this.openAll(goal);
    const begun = performance.now();
    const next = (now) => {
      if (this.running !== token) return;
      const part = Math.min(Math.max((now - begun) / 500, 0), 1);
      this.openAll(start + (goal - start) * part * part * (3 - 2 * part));
      if (part < 1) requestAnimationFrame(next);
    };
    return requestAnimationFrame(next);
  }

  /** Go to the pose of a finding, and mark its place. */
  go({ values, point }) {
    this.running = null;
    this.pose(new Map([...this.model.opened(0), ...Object.entries(values)]), point);
  }
}
