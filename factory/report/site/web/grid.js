// The grid of assets: only what is in sight is in the page, however many there are.
const find = (selector) => document.querySelector(selector);
const MARGIN = 600;
const FILTERS = ["status", "reason", "category", "joint", "repair", "license"];
const ORDERS = {
  name: (a, b) => a.name.localeCompare(b.name, "en", { numeric: true }) || a.id.localeCompare(b.id),
  verdict: (a, b) => b.status.localeCompare(a.status) || a.reason.localeCompare(b.reason),
  joints: (a, b) => b.joints - a.joints,
  hulls: (a, b) => b.hulls - a.hulls,
  clearance: (a, b) => (a.clearance ?? Infinity) - (b.clearance ?? Infinity),
};

function make(name, className, text) {
  const made = document.createElement(name);
  if (className) made.className = className;
  if (text !== undefined) made.textContent = text;
  return made;
}

/** Columns of values, as the page holds them, to one object per asset. */
function assetsOf({ fields, rows }) {
  return rows.map((row) => {
    const asset = Object.fromEntries(fields.map((name, number) => [name, row[number]]));
    asset.text = [asset.id, asset.name, asset.category, asset.reason, asset.message, ...asset.tags].join(" ").toLowerCase();
    return asset;
  });
}

/** The values of an asset that a filter looks at. */
function valuesOf(asset, filter) {
  if (filter === "joint") return asset.kinds;
  if (filter === "repair") return asset.repairs;
  return asset[filter] ? [asset[filter]] : [];
}

class Grid {
  constructor(assets) {
    this.assets = assets;
    this.box = find("#grid");
    this.cards = new Map();
    this.names = new Map();
    for (const { name } of assets) this.names.set(name, (this.names.get(name) ?? 0) + 1);
    this.state = new URLSearchParams(location.hash.slice(1));
    for (const name of FILTERS) this.options(name);
    this.controls();
    addEventListener("scroll", () => this.draw(), { passive: true });
    new ResizeObserver(() => this.layout()).observe(this.box);
    addEventListener("hashchange", () => {
      const now = new URLSearchParams(location.hash.slice(1));
      if (now.toString() === this.state.toString()) return;
      this.state = now;
      this.restore();
      this.filter();
    });
    this.restore();
    this.filter();
    document.body.classList.add("ready");
    window.factory = { grid: this };
  }

  options(name) {
    const select = find(`#by-${name}`);
    if (!select) return;
    const counts = new Map();
    for (const asset of this.assets) {
      for (const value of valuesOf(asset, name)) counts.set(value, (counts.get(value) ?? 0) + 1);
    }
    select.parentElement.hidden = counts.size === 0;
    for (const [value, count] of [...counts].sort((a, b) => b[1] - a[1] || (a[0] < b[0] ? -1 : 1))) {
      const option = make("option", "", `${value} (${count.toLocaleString("en")})`);
      option.value = value;
      select.append(option);
    }
  }

  controls() {
    const changed = (key, value) => {
      if (value) this.state.set(key, value);
      else this.state.delete(key);
      history.replaceState(null, "", `#${this.state}`);
      this.restore();
      this.filter();
    };
    let waiting;
    find("#search").addEventListener("input", ({ target }) => {
      clearTimeout(waiting);
      waiting = setTimeout(() => changed("q", target.value.trim()), 80);
    });
    for (const name of FILTERS) {
      find(`#by-${name}`)?.addEventListener("change", ({ target }) => changed(name, target.value));
    }
    for (const button of document.querySelectorAll("[data-status]")) {
      button.addEventListener("click", () => {
        const { status } = button.dataset;
        changed("status", this.state.get("status") === status ? "" : status);
      });
    }
    find("#order").addEventListener("change", ({ target }) => changed("order", target.value));
    find("#clear").addEventListener("click", () => {
      this.state = new URLSearchParams();
      history.replaceState(null, "", location.pathname + location.search);
      this.restore();
      this.filter();
    });
    document.addEventListener("keydown", (event) => this.key(event));
  }

  restore() {
    const search = find("#search");
    if (document.activeElement !== search) search.value = this.state.get("q") ?? "";
    for (const name of FILTERS) {
      const select = find(`#by-${name}`);
      if (select) select.value = this.state.get(name) ?? "";
    }
    for (const button of document.querySelectorAll("[data-status]")) {
      button.setAttribute("aria-pressed", String(this.state.get("status") === button.dataset.status));
    }
    find("#order").value = this.state.get("order") ?? "name";
    find("#clear").hidden = this.state.size === 0;
  }

  filter() {
    const words = (this.state.get("q") ?? "").toLowerCase().split(/\s+/).filter(Boolean);
    const wanted = FILTERS.map((name) => [name, this.state.get(name)]).filter(([, value]) => value);
    this.shown = this.assets.filter((asset) => words.every((word) => asset.text.includes(word))
      && wanted.every(([name, value]) => valuesOf(asset, name).includes(value)));
    this.shown.sort(ORDERS[this.state.get("order")] ?? ORDERS.name);
    const all = this.assets.length.toLocaleString("en");
    find("#count").textContent = this.shown.length === this.assets.length
      ? `${all} shown` : `${this.shown.length.toLocaleString("en")} of ${all} shown`;
    find("#none").hidden = this.shown.length > 0;
    for (const card of this.cards.values()) card.remove();
    this.cards.clear();
    this.layout();
  }

  layout() {
    const style = getComputedStyle(this.box);
    const gap = parseFloat(style.getPropertyValue("--gap"));
    const least = parseFloat(style.getPropertyValue("--card"));
    const width = this.box.clientWidth;
    this.columns = Math.max(1, Math.floor((width + gap) / (least + gap)));
    this.width = (width - gap * (this.columns - 1)) / this.columns;
    this.height = this.width * 0.75 + parseFloat(style.getPropertyValue("--caption"));
    this.gap = gap;
    const rows = Math.ceil(this.shown.length / this.columns);
    this.box.style.height = `${Math.max(0, rows * (this.height + gap) - gap)}px`;
    for (const [number, card] of this.cards) this.put(card, number);
    this.draw();
  }

  put(card, number) {
    const column = number % this.columns;
    const row = Math.floor(number / this.columns);
    card.style.width = `${this.width}px`;
    card.style.height = `${this.height}px`;
    card.style.transform = `translate(${column * (this.width + this.gap)}px, ${row * (this.height + this.gap)}px)`;
  }

  draw() {
    const top = -this.box.getBoundingClientRect().top;
    const pitch = this.height + this.gap;
    const first = Math.max(0, Math.floor((top - MARGIN) / pitch)) * this.columns;
    const last = Math.min(this.shown.length, Math.ceil((top + innerHeight + MARGIN) / pitch) * this.columns);
    for (const [number, card] of this.cards) {
      if ((number < first || number >= last) && !card.contains(document.activeElement)) {
        card.remove();
        this.cards.delete(number);
      }
    }
    for (let number = first; number < last; number += 1) {
      if (this.cards.has(number)) continue;
      const card = this.card(this.shown[number], number);
      this.cards.set(number, card);
      this.put(card, number);
      const after = [...this.cards.keys()].filter((other) => other > number).sort((a, b) => a - b)[0];
      this.box.insertBefore(card, after === undefined ? null : this.cards.get(after));
    }
  }

  card(asset, number) {
    const card = make("li", `card ${asset.status}`);
    card.setAttribute("aria-setsize", this.shown.length);
    card.setAttribute("aria-posinset", number + 1);
    const link = make("a");
    link.href = `a/${encodeURIComponent(asset.id)}/index.html`;
    const picture = make("div", "picture");
    if (asset.picture) {
      const image = make("img");
      const folder = `a/${encodeURIComponent(asset.id)}`;
      const still = `${folder}/${asset.picture}.webp`;
      image.src = still;
      image.alt = "";
      image.width = 256;
      image.height = 192;
      image.decoding = "async";
      picture.append(image);
      if (asset.moves && !matchMedia("(prefers-reduced-motion: reduce)").matches) {
        const play = () => { image.src = `${folder}/moving.webp`; };
        const rest = () => { image.src = still; };
        link.addEventListener("pointerenter", play);
        link.addEventListener("pointerleave", rest);
        link.addEventListener("focus", play);
        link.addEventListener("blur", rest);
      }
    } else picture.append(make("span", "nothing", "no model"));
    const name = make("strong", "", this.names.get(asset.name) > 1 ? asset.id : asset.name);
    const told = make("span", "told", asset.reason || asset.about);
    const verdict = make("span", "dot");
    const said = make("span", "hidden", `${asset.status}: `);
    link.append(picture, verdict, said, name, told);
    link.title = asset.message || asset.id;
    card.append(link);
    return card;
  }

  key(event) {
    const typing = event.target.closest("input, select, textarea");
    if (event.key === "/" && !typing) {
      event.preventDefault();
      find("#search").focus();
      return;
    }
    if (event.key === "Escape" && typing) return typing.blur();
    const steps = { ArrowRight: 1, ArrowLeft: -1, ArrowDown: this.columns, ArrowUp: -this.columns };
    const step = steps[event.key];
    if (!step || typing) return;
    const now = [...this.cards].find(([, card]) => card.contains(document.activeElement))?.[0];
    const next = now === undefined ? 0 : now + step;
    if (next < 0 || next >= this.shown.length) return;
    event.preventDefault();
    if (!this.cards.has(next)) scrollBy(0, Math.sign(step) * (this.height + this.gap));
    this.draw();
    this.cards.get(next)?.querySelector("a").focus();
  }
}

if (window.factoryAssets) new Grid(assetsOf(window.factoryAssets));
