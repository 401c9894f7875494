// A part is taken hold of with the mouse and pulled along its joint.
import { Raycaster, Vector2, Vector3 } from "three";

/**
 * Tells `moved(joint, value)` while a moving part is dragged, `chose(joint)` when it is taken, and
 * `over(joint)` when the mouse comes over another one; null: over none.
 */
export class Grab {
  constructor(viewer, { moved, chose, over }) {
    this.viewer = viewer;
    const { canvas } = viewer;
    let held = null;
    // Before the camera's own controls hear of it.
    canvas.addEventListener("pointerdown", (event) => {
      held = event.button ? null : this.hit(event);
      if (!held) return;
      viewer.controls.enabled = false;
      canvas.setPointerCapture(event.pointerId);
      held.value = viewer.model.values.get(held.joint.name) ?? 0;
      chose?.(held.joint);
    }, true);
    canvas.addEventListener("pointermove", (event) => {
      if (!held) {
        if (event.buttons) return;
        const joint = this.hit(event)?.joint ?? null;
        canvas.style.cursor = joint ? "grab" : "";
        if (joint !== this.under) over?.(joint);
        this.under = joint;
        return;
      }
      canvas.style.cursor = "grabbing";
      held.value = this.pulled(held, event);
      moved(held.joint, held.value);
    });
    canvas.addEventListener("pointerleave", () => {
      if (held) return;
      this.under = null;
      over?.(null);
    });
    for (const end of ["pointerup", "pointercancel"]) {
      canvas.addEventListener(end, () => {
        held = null;
        viewer.controls.enabled = true;
      });
    }
  }

  /** The free joint of the part under the mouse, and the point on it in the part's own frame. */
  hit(event) {
    const { canvas, camera, model } = this.viewer;
    const box = canvas.getBoundingClientRect();
    const x = ((event.clientX - box.left) / box.width) * 2 - 1;
    const y = 1 - ((event.clientY - box.top) / box.height) * 2;
    const ray = new Raycaster();
    ray.setFromCamera(new Vector2(x, y), camera);
    const [first] = ray.intersectObjects(model.visuals.filter((mesh) => mesh.visible), false);
    if (!first) return null;
    let link = first.object.userData.link;
    let joint = model.joints.find((each) => each.child === link);
    while (joint && !model.free.includes(joint)) {
      link = joint.parent;
      joint = model.joints.find((each) => each.child === link);
    }
    if (!joint) return null;
    const point = model.links[joint.child].worldToLocal(first.point.clone());
    return { joint, point };
  }

  /** The value at which the point that is held is nearest to the mouse, by its way on the screen. */
  pulled({ joint, point, value }, event) {
    const { canvas, camera, model } = this.viewer;
    const box = canvas.getBoundingClientRect();
    const seen = (at) => {
      const matrix = model.matrices(new Map([...model.values, [joint.name, at]]))[joint.child];
      const on = new Vector3().copy(point).applyMatrix4(matrix).project(camera);
      return new Vector2(((on.x + 1) / 2) * box.width, ((1 - on.y) / 2) * box.height);
    };
    const step = (joint.upper - joint.lower) / 200 || 1e-3;
    const way = seen(value + step).sub(seen(value));
    const toward = new Vector2(event.movementX, event.movementY);
    const length = Math.max(way.lengthSq(), 0.02);
    const next = value + (step * toward.dot(way)) / length;
    return Math.min(Math.max(next, joint.lower), joint.upper);
  }
}
