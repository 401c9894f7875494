// Build, and what came of it.
import { make } from "./parts.js";

const POLL_MS = 300;

/** `hears`: built(told, model) when there is a verdict, go(place), sentence(text). */
export class Verdict {
  constructor(hears) {
    this.hears = hears;
    this.box = document.querySelector("#verdict");
    this.button = document.querySelector("#build");
  }

  get running() {
    return Boolean(this.token);
  }

  async begin(text) {
    const token = {};
    const answer = await fetch("build", { method: "POST", body: text });
    if (!answer.ok) return this.hears.sentence((await answer.json()).sentence);
    this.token = token;
    this.button.textContent = "Stop";
    const begun = performance.now();
    while (this.token === token) {
      const told = await (await fetch("verdict")).json();
      if (this.token !== token) return null;
      if (told.state !== "running") return this.end(told);
      const seconds = ((performance.now() - begun) / 1000).toFixed(0);
      this.show(make("p", { class: "facts" }, make("b", {}, "Building"), make("span", {}, `${seconds} s`)));
      await new Promise((resolve) => { setTimeout(resolve, POLL_MS); });
    }
    return null;
  }

  stop() {
    return fetch("stop", { method: "POST" });
  }

  async end(told) {
    this.token = null;
    this.button.textContent = "Build";
    if (told.state !== "done") {
      this.show(make("p", { class: "verdict rejected" }, "Nothing was built"), make("p", {}, told.sentence));
      return;
    }
    const parts = [
      make("p", { class: `verdict ${told.status}` }, make("span", { class: `dot ${told.status}` }), told.passed ? "Registered" : told.status),
      make("p", { class: "dim" }, make("code", {}, told.id), ` ${told.about}`),
    ];
    if (told.message) parts.push(make("p", {}, make("code", {}, told.reason), ` ${told.message}`));
    const [errors, warnings] = [true, false].map((error) => told.groups.filter((group) => group.error === error));
    parts.push(...errors.slice(0, 8).map((group) => this.group(group, told)));
    if (warnings.length) {
      const title = `${warnings.length} warning${warnings.length === 1 ? "" : "s"}`;
      parts.push(make("details", {}, make("summary", {}, title), ...warnings.map((group) => this.group(group, told))));
    }
    if (told.repairs.length) {
      const list = make("ul", {}, ...told.repairs.map((each) => make("li", {}, each)));
      parts.push(make("details", {}, make("summary", {}, `${told.repairs.length} repair${told.repairs.length === 1 ? "" : "s"}`), list));
    }
    this.show(...parts);
    const model = await fetch("built.glb");
    this.hears.built(told, model.ok ? await model.arrayBuffer() : null);
  }

  group({ code, error, meaning, findings }, told) {
    const lines = findings.slice(0, 3).map(([message, place]) => {
      const where = told.shown.places?.[place];
      const show = where ? [make("button", { type: "button", onclick: () => this.hears.go(where) }, "Show")] : [];
      return make("p", { class: "finding" }, ...show, message);
    });
    // The first reason is said above already.
    const rest = code === told.reason ? lines.slice(findings[0][1] >= 0 ? 0 : 1) : lines;
    if (!rest.length) return "";
    return make("div", { class: error ? "found error" : "found" }, make("code", {}, code), make("p", { class: "dim" }, meaning), ...rest);
  }

  show(...parts) {
    this.box.hidden = false;
    this.box.replaceChildren(...parts);
  }
}
