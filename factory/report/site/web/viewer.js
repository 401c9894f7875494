// The stage: light, ground, camera, and what is shown of the model.
import {
  Box3, Color, DirectionalLight, EdgesGeometry, Group, HemisphereLight,
  LineBasicMaterial, LineSegments, Mesh, MeshStandardMaterial, NoToneMapping,
  PCFShadowMap, PerspectiveCamera, PlaneGeometry, Scene, ShadowMaterial, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { jointOverlay, mark } from "./overlays.js";
import { TALL, person } from "./person.js";

function cornersOf({ min, max }) {
  return [0, 1, 2, 3, 4, 5, 6, 7].map((corner) => (
    new Vector3(...[0, 1, 2].map((axis) => ((corner >> axis) & 1 ? max : min).getComponent(axis)))));
}

/** Shows a model on a canvas. `shown` says what: visuals, hulls, axes, limits, contacts, replaced. */
export class Viewer {
  constructor(canvas, model, front) {
    this.canvas = canvas;
    this.model = model;
    this.shown = { visuals: true, hulls: false, axes: false, limits: false, contacts: true, replaced: false, person: false };
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.renderer.toneMapping = NoToneMapping;
    this.scene = new Scene();
    this.scene.add(model.root);
    this.camera = new PerspectiveCamera(26, 1, 0.01, 100);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.addEventListener("change", () => this.draw());
    this.overlays = { axes: [], limits: [] };
    this.hidden = new Set();
    this.lights = new Map();
    this.marks = new Group();
    this.scene.add(this.marks);
    this.person = person();
    this.scene.add(this.person);
    this.front = front;
    this.frame();
    this.light();
    this.prepare();
    this.frame();
    this.reset();
    this.apply();
    // The wheel scrolls the page, until somebody means the model.
    this.controls.enableZoom = false;
    canvas.addEventListener("pointerdown", () => canvas.focus({ preventScroll: true }));
    canvas.addEventListener("focus", () => { this.controls.enableZoom = true; });
    canvas.addEventListener("blur", () => { this.controls.enableZoom = false; });
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    model.changed = () => this.draw();
    const dark = matchMedia("(prefers-color-scheme: dark)");
    dark.addEventListener("change", () => this.draw());
  }

  /** Show another model in place of this one, from where the camera is. */
  replace(model) {
    this.scene.remove(this.model.root);
    this.model.root.traverse((item) => {
      item.geometry?.dispose();
      for (const material of [item.material ?? []].flat()) {
        material.map?.dispose();
        material.dispose();
      }
    });
    this.marks.clear();
    this.only = null;
    this.hidden.clear();
    this.lights.clear();
    this.overlays = { axes: [], limits: [] };
    this.model = model;
    this.scene.add(model.root);
    this.frame();
    this.prepare();
    this.frame();
    this.apply();
    model.changed = () => this.draw();
  }

  /** Look at the object from its front, closed and open in sight. */
  frame() {
    const { front, model } = this;
    const box = new Box3();
    this.corners = [];
    for (const share of [1, 0.5, 0]) {
      this.closed = [];
      model.pose(model.opened(share));
      model.root.updateMatrixWorld(true);
      for (const mesh of model.visuals.length ? model.visuals : model.hulls) {
        mesh.geometry.computeBoundingBox();
        this.closed.push(...cornersOf(mesh.geometry.boundingBox).map((corner) => corner.applyMatrix4(mesh.matrixWorld)));
      }
      this.corners.push(...this.closed);
    }
    box.setFromPoints(this.corners);
    this.ground = box.isEmpty() ? 0 : box.min.z;
    this.size = Math.max(box.isEmpty() ? 1 : box.getSize(new Vector3()).length(), 1e-3);
    const center = box.isEmpty() ? new Vector3() : box.getCenter(new Vector3());
    this.home = { center, toward: new Vector3(...front).normalize() };
    // Axes and limits are in the picture, too.
    for (const { group } of [...this.overlays.axes, ...this.overlays.limits]) {
      this.corners.push(...cornersOf(new Box3().setFromObject(group)));
    }
    // A person stands beside the object, on its ground.
    const aside = new Vector3(0, 0, 1).cross(this.home.toward).normalize();
    const reach = Math.max(0, ...this.corners.map((corner) => corner.clone().sub(center).dot(aside)));
    this.person.position.copy(center).addScaledVector(aside, reach + 0.4).setZ(this.ground);
    this.camera.near = this.size / 100;
    this.camera.far = this.size * 20 + 10 * TALL;
  }

  /** The nearest place that has the closed object in the middle and all corners in the picture. */
  reset() {
    const { center, toward } = this.home;
    const right = new Vector3(0, 0, 1).cross(toward).normalize();
    const axes = [right, toward.clone().cross(right)];
    const tall = Math.tan((this.camera.fov * Math.PI) / 360) * 0.9;
    const halves = [tall * this.camera.aspect, tall];
    const target = center.clone();
    const beside = [[0.3, 0], [0.3, TALL]].map(([out, up]) => (
      this.person.position.clone().addScaledVector(right, out).add(new Vector3(0, 0, up))));
    const framed = this.shown.person ? [...this.corners, ...beside] : this.corners;
    const middle = this.shown.person ? framed : this.closed;
    let reach = 0;
    for (let round = 0; round < 6; round += 1) {
      const seen = (corner, axis) => {
        const from = corner.clone().sub(target);
        return { aside: from.dot(axis), near: from.dot(toward) };
      };
      reach = this.size * 0.2;
      axes.forEach((axis, number) => {
        for (const corner of framed) {
          const { aside, near } = seen(corner, axis);
          reach = Math.max(reach, Math.abs(aside) / halves[number] + near);
        }
      });
      for (const axis of axes) {
        const ratios = middle.map((corner) => {
          const { aside, near } = seen(corner, axis);
          return aside / (reach - near);
        });
        if (ratios.length) target.addScaledVector(axis, (reach * (Math.max(...ratios) + Math.min(...ratios))) / 2);
      }
    }
    this.controls.target.copy(target);
    this.camera.position.copy(target).addScaledVector(toward, reach);
    this.controls.update();
    this.draw();
  }

  light() {
    const key = new DirectionalLight(0xffffff, 1.9);
    const { center, toward } = this.home;
    const side = new Vector3(0, 0, 1).cross(toward).normalize();
    key.position.copy(center).addScaledVector(toward, this.size).addScaledVector(side, -this.size * 0.7)
      .add(new Vector3(0, 0, this.size * 1.1));
    key.target.position.copy(center);
    key.castShadow = true;
    key.shadow.mapSize.set(2048, 2048);
    key.shadow.bias = -0.0004;
    key.shadow.normalBias = this.size * 0.002;
    key.shadow.radius = 4;
    const { camera } = key.shadow;
    [camera.left, camera.right, camera.top, camera.bottom] = [-1, 1, 1, -1].map((x) => x * this.size * 0.75);
    [camera.near, camera.far] = [this.size * 0.2, this.size * 4];
    const floor = new Mesh(new PlaneGeometry(this.size * 8, this.size * 8), new ShadowMaterial({ opacity: 0.16 }));
    floor.position.z = this.ground - this.size * 0.0005;
    floor.receiveShadow = true;
    const sky = new HemisphereLight(0xffffff, 0xb9b4ac, 1.55);
    sky.position.set(0, 0, 1);
    this.scene.add(key, key.target, sky, floor);
  }

  prepare() {
    const { model } = this;
    for (const mesh of model.visuals) {
      mesh.castShadow = true;
      mesh.receiveShadow = true;
      // Hulls have faces in nearly the same planes: they win by some millimetres, everywhere alike.
      Object.assign(mesh.material, { polygonOffset: true, polygonOffsetFactor: 4, polygonOffsetUnits: 96 });
    }
    model.hulls.forEach((mesh, number) => {
      const color = new Color().setHSL((number * 0.618034) % 1, 0.42, 0.66);
      mesh.material = new MeshStandardMaterial({ color, roughness: 0.9 });
      mesh.userData.color = color;
      const edges = new LineBasicMaterial({ color: 0x16181c, transparent: true, opacity: 0.4 });
      mesh.add(new LineSegments(new EdgesGeometry(mesh.geometry, 12), edges));
    });
    for (const mesh of model.replaced) {
      mesh.material = new MeshStandardMaterial({
        color: 0xd9822b, roughness: 0.9, transparent: true, opacity: 0.45, depthWrite: false,
      });
      mesh.renderOrder = 3;
      const edges = new LineBasicMaterial({ color: 0x8a4a0f, transparent: true, opacity: 0.7 });
      mesh.add(new LineSegments(new EdgesGeometry(mesh.geometry, 12), edges));
    }
    for (const joint of model.movable) {
      const box = new Box3();
      for (const mesh of [...model.visuals, ...model.hulls]) {
        if (mesh.userData.link === joint.child) {
          mesh.geometry.computeBoundingBox();
          box.union(mesh.geometry.boundingBox);
        }
      }
      const center = box.isEmpty() ? new Vector3() : box.getCenter(new Vector3());
      const half = box.isEmpty() ? 0 : box.getSize(new Vector3()).length() / 2;
      const { axis, range } = jointOverlay(joint, { center, half }, this.size, { accent: 0x2f6fde, limits: 0xd9822b });
      model.links[joint.parent].add(axis, range);
      this.overlays.axes.push({ joint, group: axis });
      this.overlays.limits.push({ joint, group: range });
    }
  }

  /** A material as it looks on the part that is pointed at. */
  lighter(material) {
    if (!this.lights.has(material)) {
      const lit = material.clone();
      lit.emissive = new Color(0x2f6fde);
      lit.emissiveIntensity = 0.28;
      this.lights.set(material, lit);
    }
    return this.lights.get(material);
  }

  /** The joint whose axis and limits are shown, whatever else is; null: none. */
  set chosen(joint) {
    this.only = joint;
    this.apply();
  }

  apply() {
    const { shown } = this;
    const lit = this.only ? this.model.below(this.only) : new Set();
    for (const mesh of this.model.visuals) {
      mesh.visible = shown.visuals && !this.hidden.has(mesh.userData.link);
      mesh.userData.plain ??= mesh.material;
      mesh.material = lit.has(mesh.userData.link) ? this.lighter(mesh.userData.plain) : mesh.userData.plain;
    }
    for (const mesh of this.model.replaced) mesh.visible = shown.replaced;
    for (const mesh of this.model.hulls) {
      const met = shown.contacts && mesh.userData.met;
      mesh.visible = (shown.hulls || met) && !this.hidden.has(mesh.userData.link);
      mesh.material.color.copy(met ? new Color(0xe0352b) : mesh.userData.color);
      const glass = shown.visuals;
      mesh.material.transparent = glass;
      mesh.material.opacity = glass ? (met ? 0.6 : 0.5) : 1;
      mesh.material.depthWrite = !glass;
      mesh.material.depthTest = !(met && glass);
      mesh.renderOrder = glass ? 2 : 0;
      mesh.castShadow = shown.hulls && !shown.visuals;
      mesh.material.needsUpdate = true;
    }
    for (const name of ["axes", "limits"]) {
      for (const { joint, group } of this.overlays[name]) {
        group.visible = this.only ? this.only === joint : shown[name];
      }
    }
    this.marks.visible = shown.contacts;
    this.person.visible = shown.person;
    this.draw();
  }

  /** Mark hulls that meet, and a place that a finding names. */
  point(contacts, place) {
    for (const mesh of this.model.hulls) mesh.userData.met = false;
    this.marks.clear();
    for (const { one, other, point } of contacts) {
      one.mesh.userData.met = true;
      other.mesh.userData.met = true;
      if (this.marks.children.length < 12) this.marks.add(mark(point, 0xe0352b));
    }
    if (place) this.marks.add(mark(new Vector3(...place), 0xe0352b));
    this.apply();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (!width || !height) return;
    const first = !this.sized;
    this.sized = true;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (first) this.reset();
    this.draw();
  }

  /** Draw with the next frame, however often it is asked for. */
  draw() {
    if (this.waiting || !this.sized) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      const from = this.camera.position.clone().sub(this.person.position);
      this.person.rotation.z = Math.atan2(from.x, -from.y);
      this.renderer.render(this.scene, this.camera);
      this.drawn?.();
    });
  }
}
