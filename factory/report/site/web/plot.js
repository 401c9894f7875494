// Clearance over joint position, drawn as SVG.
import { WIDEST } from "./hulls.js";

const NAMESPACE = "http://www.w3.org/2000/svg";
const WIDTH = 440;
const HEIGHT = 180;
const LEFT = 46;
const RIGHT = 12;
const TOP = 22;
const BOTTOM = 30;

function draw(name, attributes, text) {
  const made = document.createElementNS(NAMESPACE, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text !== undefined) made.textContent = text;
  return made;
}

/** Steps of 1, 2 or 5 so that about five lie in a range. */
function ticks(low, high) {
  const rough = (high - low) / 5;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].find((factor) => factor * power >= rough) * power;
  const found = [];
  for (let at = Math.ceil(low / step) * step; at <= high + 1e-9; at += step) found.push(at);
  return found;
}

/**
 * The plot of one joint.
 * @param joint of the model.
 * @param curves pairs of links with gaps [m] at equal steps; at most five are drawn.
 * @param marks what the validator measured: { at, mm, told }.
 * @param jump called with a value of the joint when somebody clicks there.
 */
export function sweepPlot(joint, curves, marks, jump, nameOf) {
  const shown = curves.slice(0, 5);
  const lowest = Math.min(-1, ...shown.map(({ gaps }) => 1000 * Math.min(...gaps)), ...marks.map(({ mm }) => mm));
  const highest = Math.min(1000 * WIDEST, Math.max(10, ...shown.map(({ gaps }) => 1000 * Math.min(...gaps) * 2.5 + 8)));
  const low = lowest - 0.06 * (highest - lowest);
  const x = (value) => LEFT + ((value - joint.lower) / (joint.upper - joint.lower || 1)) * (WIDTH - LEFT - RIGHT);
  const y = (mm) => TOP + ((highest - Math.min(mm, highest)) / (highest - low)) * (HEIGHT - TOP - BOTTOM);
  const svg = draw("svg", {
    viewBox: `0 0 ${WIDTH} ${HEIGHT}`, class: "plot", role: "img",
    "aria-label": `Clearance in millimetres along ${joint.name}`,
  });
  const touching = { x: LEFT, y: y(0), width: WIDTH - LEFT - RIGHT, height: y(low) - y(0), class: "touching" };
  svg.append(draw("rect", touching));
  for (const tick of ticks(low, highest)) {
    svg.append(draw("line", { x1: LEFT, x2: WIDTH - RIGHT, y1: y(tick), y2: y(tick), class: tick === 0 ? "zero" : "rule" }));
    svg.append(draw("text", { x: LEFT - 6, y: y(tick) + 4, "text-anchor": "end" }, `${Math.round(tick * 10) / 10}`));
  }
  svg.append(draw("text", { x: LEFT, y: 11 }, "mm free"));
  for (const share of [0, 0.25, 0.5, 0.75, 1]) {
    const anchor = share === 0 ? "start" : share === 1 ? "end" : "middle";
    svg.append(draw("text", { x: x(joint.at(share)), y: HEIGHT - 8, "text-anchor": anchor }, joint.told(joint.at(share))));
  }
  shown.forEach(({ gaps, links }, number) => {
    const points = gaps.map((gap, step) => `${x(joint.at(step / (gaps.length - 1))).toFixed(1)},${y(1000 * gap).toFixed(1)}`);
    const line = draw("polyline", { points: points.join(" "), class: `curve c${number}` });
    line.append(draw("title", {}, links.map(nameOf).join(" and ")));
    svg.append(line);
  });
  for (const { at, mm, told } of marks) {
    const dot = draw("circle", { cx: x(at), cy: y(mm), r: 4, class: mm < 0 ? "mark bad" : "mark" });
    dot.append(draw("title", {}, told));
    svg.append(dot);
  }
  const now = draw("line", { x1: 0, x2: 0, y1: TOP, y2: HEIGHT - BOTTOM, class: "now" });
  svg.append(now);
  svg.addEventListener("click", (event) => {
    const box = svg.getBoundingClientRect();
    const share = (((event.clientX - box.left) / box.width) * WIDTH - LEFT) / (WIDTH - LEFT - RIGHT);
    jump(joint.at(Math.min(1, Math.max(0, share))));
  });
  const follow = (value) => {
    now.setAttribute("x1", x(value));
    now.setAttribute("x2", x(value));
  };
  return { svg, shown, follow };
}
