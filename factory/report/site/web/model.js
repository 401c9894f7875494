// The GLB of a page: bytes to links with meshes, and joints that pose them.
import {
  BufferAttribute, BufferGeometry, Color, DoubleSide, Group, Matrix4, Mesh, MeshStandardMaterial,
  SRGBColorSpace, Texture, Vector3,
} from "three";

const ARRAYS = { 5126: Float32Array, 5125: Uint32Array, 5123: Uint16Array };
const WIDTHS = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4 };

/** The bytes of gzip, written as base64. */
export async function unpacked(text) {
  const packed = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}

/** An articulated object: `links` to be posed, `visuals` and `hulls` on them. */
export class Model {
  constructor(buffer) {
    this.buffer = buffer;
    const view = new DataView(buffer);
    const length = view.getUint32(12, true);
    this.document = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 20, length)));
    this.start = 20 + length + 8;
    const { extras } = this.document;
    this.names = extras.links;
    this.joints = extras.joints.map((told) => new Joint(told));
    this.byName = new Map(this.joints.map((joint) => [joint.name, joint]));
    this.movable = this.joints.filter((joint) => joint.kind !== "fixed");
    this.free = this.movable.filter((joint) => !joint.leader);
    this.root = new Group();
    this.links = this.names.map(() => {
      const link = new Group();
      link.matrixAutoUpdate = false;
      this.root.add(link);
      return link;
    });
    this.materials = (this.document.materials ?? []).map((told) => this.material(told));
    this.visuals = this.meshes(0);
    this.hulls = this.meshes(1);
    this.replaced = this.document.scenes.length > 2 ? this.meshes(2) : [];
    this.values = new Map();
    this.pose(this.opened(0));
  }

  meshes(scene) {
    const { scenes, nodes, meshes } = this.document;
    const first = scenes[scene].nodes[0] + 1;
    const found = [];
    this.links.forEach((link, number) => {
      const { mesh } = nodes[first + number];
      for (const primitive of mesh === undefined ? [] : meshes[mesh].primitives) {
        const made = new Mesh(this.geometry(primitive), this.materials[primitive.material]);
        made.userData.link = number;
        link.add(made);
        found.push(made);
      }
    });
    return found;
  }

  geometry({ attributes, indices }) {
    const geometry = new BufferGeometry();
    geometry.setIndex(this.attribute(indices));
    geometry.setAttribute("position", this.attribute(attributes.POSITION));
    if (attributes.TEXCOORD_0 !== undefined) {
      geometry.setAttribute("uv", this.attribute(attributes.TEXCOORD_0));
    }
    if (attributes.NORMAL !== undefined) {
      geometry.setAttribute("normal", this.attribute(attributes.NORMAL));
      return geometry;
    }
    const flat = geometry.toNonIndexed();
    flat.computeVertexNormals();
    flat.userData.corners = geometry.getAttribute("position").array;
    return flat;
  }

  attribute(index) {
    const { accessors, bufferViews } = this.document;
    const { bufferView, componentType, count, type } = accessors[index];
    const width = WIDTHS[type];
    const offset = this.start + bufferViews[bufferView].byteOffset;
    return new BufferAttribute(new ARRAYS[componentType](this.buffer, offset, count * width), width);
  }

  material({ pbrMetallicRoughness: look }) {
    const [red, green, blue, alpha] = look.baseColorFactor;
    const material = new MeshStandardMaterial({
      color: new Color(red, green, blue), roughness: 0.85, metalness: 0, side: DoubleSide,
    });
    if (alpha < 0.999) Object.assign(material, { transparent: true, opacity: Math.max(alpha, 0.15) });
    if (look.baseColorTexture) material.map = this.texture(look.baseColorTexture.index);
    return material;
  }

  texture(index) {
    const { textures, images, bufferViews } = this.document;
    const { bufferView, mimeType } = images[textures[index].source];
    const { byteOffset, byteLength } = bufferViews[bufferView];
    const bytes = this.buffer.slice(this.start + byteOffset, this.start + byteOffset + byteLength);
    const texture = new Texture();
    texture.colorSpace = SRGBColorSpace;
    texture.flipY = false;
    const image = new Image();
    image.onload = () => {
      URL.revokeObjectURL(image.src);
      texture.image = image;
      texture.needsUpdate = true;
      this.changed?.();
    };
    image.src = URL.createObjectURL(new Blob([bytes], { type: mimeType }));
    return texture;
  }

  /** Values of all free joints at a share of their ranges. */
  opened(share) {
    return new Map(this.free.map((joint) => [joint.name, joint.at(share)]));
  }

  value(joint, values, depth = 0) {
    if (values.has(joint.name)) return values.get(joint.name);
    const leader = depth < 99 && this.byName.get(joint.leader);
    return leader ? joint.multiplier * this.value(leader, values, depth + 1) + joint.offset : 0;
  }

  /** Matrices of all links in the root's frame. */
  matrices(values) {
    const found = this.links.map(() => new Matrix4());
    for (const joint of this.joints) {
      found[joint.child]
        .copy(found[joint.parent]).multiply(joint.origin).multiply(joint.motion(this.value(joint, values)));
    }
    return found;
  }

  pose(values) {
    this.values = new Map([...this.values, ...values]);
    this.matrices(this.values).forEach((matrix, number) => {
      this.links[number].matrix.copy(matrix);
      this.links[number].matrixWorldNeedsUpdate = true;
    });
  }

  /** Indices of the links that move with a joint. */
  below(joint) {
    const found = new Set([joint.child]);
    for (const other of this.joints) if (found.has(other.parent)) found.add(other.child);
    return found;
  }

  /** For each link the first one of those that it is fixed to. */
  get parts() {
    const found = this.names.map((_, number) => number);
    for (const joint of this.joints) {
      if (joint.kind === "fixed") found[joint.child] = found[joint.parent];
    }
    return found;
  }
}

class Joint {
  constructor(told) {
    Object.assign(this, { leader: "", multiplier: 1, offset: 0 }, told);
    this.origin = new Matrix4().set(...told.origin.flat());
    this.axis = new Vector3(...told.axis);
    this.slides = told.kind === "prismatic";
  }

  at(share) {
    return this.lower + share * (this.upper - this.lower);
  }

  motion(value) {
    if (this.kind === "fixed") return new Matrix4();
    return this.slides
      ? new Matrix4().makeTranslation(this.axis.clone().multiplyScalar(value))
      : new Matrix4().makeRotationAxis(this.axis, value);
  }

  get endless() {
    return this.kind === "continuous";
  }

  /** The limits as people read them. */
  get ends() {
    return this.endless ? ["turns without end", ""] : [this.told(this.lower), this.told(this.upper)];
  }

  /** What somebody typed, in degrees or millimetres, as a value; NaN for what is no number. */
  read(text) {
    const value = Number.parseFloat(text) * (this.slides ? 1e-3 : Math.PI / 180);
    return this.endless ? value : Math.min(Math.max(value, this.lower), this.upper);
  }

  /** A value as people read it. */
  told(value) {
    return this.slides ? `${(1000 * value).toFixed(0)} mm` : `${((180 / Math.PI) * value).toFixed(0)}°`;
  }
}
