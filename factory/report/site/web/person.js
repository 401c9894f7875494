// A person's outline, to see how large an object is.
import { DoubleSide, Mesh, MeshBasicMaterial, Path, Shape, ShapeGeometry } from "three";

/** How tall [m]. */
export const TALL = 1.75;
/** The right half from the neck down the arm, up to the armpit, and down the leg [m]: aside, up. */
const HALF = [
  [0.05, 1.505], [0.06, 1.46], [0.17, 1.43], [0.215, 1.38], [0.24, 1.2], [0.265, 1.0], [0.28, 0.8],
  [0.255, 0.74], [0.235, 0.8], [0.215, 1.0], [0.18, 1.22], [0.15, 1.1], [0.175, 0.9], [0.165, 0.5],
  [0.13, 0.08], [0.16, 0.02], [0.15, 0], [0.05, 0], [0.05, 0.08], [0.04, 0.45], [0.015, 0.82],
];

/** A flat figure that stands on z = 0 at the origin and looks along -y. */
export function person() {
  const points = [...HALF, ...HALF.map(([aside, up]) => [-aside, up]).reverse()];
  const body = new Shape();
  points.forEach(([aside, up], number) => (number ? body.lineTo(aside, up) : body.moveTo(aside, up)));
  const head = new Shape().setFromPoints(new Path().absellipse(0, TALL - 0.125, 0.095, 0.125, 0, 2 * Math.PI).getPoints(40));
  const geometry = new ShapeGeometry([body, head]).rotateX(Math.PI / 2);
  return new Mesh(geometry, new MeshBasicMaterial({
    color: 0x8b929c, transparent: true, opacity: 0.55, side: DoubleSide, toneMapped: false,
  }));
}
