// Joint axes with arrows, limits as arcs and rails, and marks that stay in sight.
import {
  CanvasTexture, CatmullRomCurve3, ConeGeometry, CylinderGeometry, Group, Mesh, MeshBasicMaterial,
  Quaternion, Sprite, SpriteMaterial, TubeGeometry, Vector3,
} from "three";

const UP = new Vector3(0, 1, 0);

function through(color, opacity = 1) {
  return new MeshBasicMaterial({ color, opacity, transparent: true, depthTest: false, toneMapped: false });
}

function bar(from, to, radius, material) {
  const along = new Vector3().subVectors(to, from);
  const mesh = new Mesh(new CylinderGeometry(radius, radius, along.length(), 10), material);
  mesh.quaternion.copy(new Quaternion().setFromUnitVectors(UP, along.normalize()));
  mesh.position.addVectors(from, to).multiplyScalar(0.5);
  return mesh;
}

function arrow(tip, toward, size, material) {
  const mesh = new Mesh(new ConeGeometry(size * 0.45, size * 1.3, 14), material);
  mesh.quaternion.copy(new Quaternion().setFromUnitVectors(UP, toward.clone().normalize()));
  mesh.position.copy(tip);
  return mesh;
}

/**
 * The axis of a joint and its range, in the frame of its parent: `center` of what it moves and `half`
 * of its diagonal; `size` is the object's [m].
 */
export function jointOverlay(joint, { center: childCenter, half }, size, colors) {
  const axis = new Group();
  const range = new Group();
  const thin = size * 0.0022;
  const origin = new Vector3().setFromMatrixPosition(joint.origin);
  const along = joint.axis.clone().transformDirection(joint.origin);
  const center = childCenter.clone().applyMatrix4(joint.origin);
  // An axis is drawn beside its part, not where its frame happens to lie.
  const middle = origin.clone().addScaledVector(along, center.clone().sub(origin).dot(along));
  const line = through(colors.accent, 0.9);
  const reach = Math.min(half, size * 0.16) + size * 0.04;
  const start = joint.slides ? center : middle;
  const end = start.clone().addScaledVector(along, reach);
  axis.add(bar(start.clone().addScaledVector(along, -reach), end, thin, line), arrow(end, along, size * 0.018, line));
  const limits = through(colors.limits, 0.9);
  if (joint.slides) {
    const from = center.clone().addScaledVector(along, joint.lower);
    const to = center.clone().addScaledVector(along, joint.upper);
    range.add(bar(from, to, thin * 1.4, limits), arrow(to, along, size * 0.02, limits));
  } else {
    const spoke = center.clone().sub(middle);
    spoke.addScaledVector(along, -spoke.dot(along));
    const arm = spoke.length();
    if (arm < size * 0.02) spoke.set(along.y, along.z, along.x).cross(along);
    spoke.setLength(Math.min(Math.max(arm, half, size * 0.03), size * 0.3));
    const at = (value) => middle.clone().add(spoke.clone().applyAxisAngle(along, value));
    const points = Array.from({ length: 33 }, (_, step) => at(joint.at(step / 32)));
    range.add(new Mesh(new TubeGeometry(new CatmullRomCurve3(points), 48, thin * 1.4, 8), limits));
    range.add(bar(middle, at(joint.lower), thin * 0.8, limits));
    const toward = points[32].clone().sub(points[31]);
    range.add(arrow(points[32], toward, size * 0.02, limits));
  }
  for (const group of [axis, range]) group.traverse((item) => { item.renderOrder = 5; });
  return { axis, range };
}

let ring = null;

/** A ring that has the same size on the screen wherever it is. */
export function mark(point, color) {
  if (!ring) {
    const canvas = document.createElement("canvas");
    canvas.width = canvas.height = 128;
    const pen = canvas.getContext("2d");
    pen.strokeStyle = "#fff";
    pen.fillStyle = "#fff";
    pen.lineWidth = 11;
    pen.beginPath();
    pen.arc(64, 64, 48, 0, 2 * Math.PI);
    pen.stroke();
    pen.beginPath();
    pen.arc(64, 64, 13, 0, 2 * Math.PI);
    pen.fill();
    ring = new CanvasTexture(canvas);
  }
  const sprite = new Sprite(new SpriteMaterial({
    map: ring, color, depthTest: false, sizeAttenuation: false, toneMapped: false,
  }));
  sprite.scale.setScalar(0.045);
  sprite.position.copy(point);
  sprite.renderOrder = 9;
  return sprite;
}
