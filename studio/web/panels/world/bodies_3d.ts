import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DynamicDrawUsage,
  InstancedMesh,
  type Material,
  Matrix4,
  Mesh,
  MeshLambertMaterial,
  type Object3D,
} from "three";
import { mergeGeometries } from "three/examples/jsm/utils/BufferGeometryUtils.js";

/** The drawing of one body: an instance of a mesh. */
interface Instance {
  mesh: InstancedMesh;
  index: number;
  /** Its place in the body. */
  local: Matrix4;
}

/** A mesh and its place in its parent. */
interface Part {
  geometry: BufferGeometry;
  material: MeshLambertMaterial;
  local: Matrix4;
}

/** Parts of one colour each are drawn as one mesh, with the colour at the vertices. */
const painted = new MeshLambertMaterial({ vertexColors: true });

/**
 * The meshes of all bodies: equal ones are drawn together, so fifty robots of one model take as many draw calls
 * as one robot.
 */
export class Bodies3d {
  readonly meshes: InstancedMesh[] = [];
  private readonly instances: Instance[][];

  private constructor(bodies: number) {
    this.instances = Array.from({ length: bodies }, () => []);
  }

  /** Takes the meshes out of the groups; their matrices of the world are right. */
  static of(groups: readonly Object3D[]): Bodies3d {
    const all = new Bodies3d(groups.length);
    const equal = new Map<string, { part: Part; bodies: number[] }>();
    const known = new Map<string, BufferGeometry>();
    groups.forEach((group, body) => {
      for (const part of merged(partsOf(group), known)) {
        const key = [part.geometry.uuid, part.material.uuid, keyOf(part.local)].join();
        const same = equal.get(key) ?? { part, bodies: [] };
        same.bodies.push(body);
        equal.set(key, same);
      }
      group.clear();
    });
    for (const { part, bodies } of equal.values()) all.add(part, bodies);
    groups.forEach((group, body) => all.place(body, group.matrix));
    return all;
  }

  /** The same bodies, transparent and not clickable. */
  ghosts(material: Material): Bodies3d {
    const copy = new Bodies3d(this.instances.length);
    const ghostOf = new Map<InstancedMesh, InstancedMesh>();
    for (const mesh of this.meshes) {
      const ghost = instanced(mesh.geometry, material, mesh.count);
      ghost.raycast = () => undefined;
      ghostOf.set(mesh, ghost);
      copy.meshes.push(ghost);
    }
    this.instances.forEach((parts, body) => {
      for (const part of parts) copy.instances[body]!.push({ ...part, mesh: ghostOf.get(part.mesh)! });
    });
    return copy;
  }

  /** Moves a body to its place in the world. */
  place(body: number, matrix: Matrix4): void {
    for (const { mesh, index, local } of this.instances[body]!) {
      mesh.setMatrixAt(index, scratch.multiplyMatrices(matrix, local));
      mesh.instanceMatrix.needsUpdate = true;
    }
  }

  private add({ geometry, material, local }: Part, bodies: number[]): void {
    const mesh = instanced(geometry, material, bodies.length);
    mesh.userData.bodies = bodies;
    this.meshes.push(mesh);
    bodies.forEach((body, index) => this.instances[body]!.push({ mesh, index, local }));
  }
}

/** Merges still objects into as few meshes as there are looks. Takes the meshes out of their groups. */
export function still(root: Object3D): Mesh[] {
  const parts = partsOf(root);
  return merged(parts, new Map()).map(({ geometry, material, local }) => {
    const mesh = new Mesh(geometry, material);
    mesh.matrixAutoUpdate = false;
    mesh.matrix.copy(local);
    return mesh;
  });
}

const scratch = new Matrix4();

function instanced(geometry: BufferGeometry, material: Material, count: number): InstancedMesh {
  const mesh = new InstancedMesh(geometry, material, count);
  mesh.instanceMatrix.setUsage(DynamicDrawUsage);
  mesh.frustumCulled = false;
  mesh.matrixAutoUpdate = false;
  return mesh;
}

function partsOf(group: Object3D): Part[] {
  const inverse = group.matrixWorld.clone().invert();
  const parts: Part[] = [];
  const meshes: Mesh[] = [];
  group.traverse((node) => node instanceof Mesh && !(node instanceof InstancedMesh) && meshes.push(node));
  for (const mesh of meshes) {
    const local = inverse.clone().multiply(mesh.matrixWorld);
    parts.push({ geometry: mesh.geometry, material: mesh.material as MeshLambertMaterial, local });
    mesh.removeFromParent();
  }
  return parts;
}

const isOneColour = ({ map, transparent, emissive, polygonOffset }: MeshLambertMaterial) =>
  !map && !transparent && !polygonOffset && emissive.getHex() === 0;

/** The parts with one colour each become one part, which is the same for equal lists of parts. */
function merged(parts: readonly Part[], known: Map<string, BufferGeometry>): Part[] {
  const plain = parts.filter(({ material }) => isOneColour(material));
  const others = parts.filter(({ material }) => !isOneColour(material));
  if (plain.length === 0) return others;
  const key = plain.map(({ geometry, material, local }) => [geometry.uuid, material.color.getHex(), keyOf(local)].join()).join();
  let geometry = known.get(key);
  if (!geometry) known.set(key, (geometry = mergeGeometries(plain.map(colouredOf))));
  return [{ geometry, material: painted, local: new Matrix4() }, ...others];
}

/** Rounds to a millionth of a metre: equal robots differ in the last bits. */
const keyOf = (matrix: Matrix4) => matrix.elements.map((one) => Math.round(one * 1e6)).join();

/** A copy in the place of the part, with its colour at each vertex. */
function colouredOf({ geometry, material, local }: Part): BufferGeometry {
  const copy = new BufferGeometry();
  const corners = geometry.getAttribute("position");
  copy.setAttribute("position", floats(corners as BufferAttribute));
  if (geometry.hasAttribute("normal")) copy.setAttribute("normal", floats(geometry.getAttribute("normal") as BufferAttribute));
  const index = geometry.index ? Array.from(geometry.index.array) : Array.from({ length: corners.count }, (_, at) => at);
  // A mirrored part has its front and back exchanged.
  if (local.determinant() < 0)
    for (let at = 0; at < index.length; at += 3) [index[at + 1], index[at + 2]] = [index[at + 2]!, index[at + 1]!];
  copy.setIndex(index);
  if (!copy.hasAttribute("normal")) copy.computeVertexNormals();
  const { r, g, b } = new Color().copy(material.color);
  const colours = new Float32Array(3 * corners.count);
  for (let at = 0; at < colours.length; at += 3) colours.set([r, g, b], at);
  copy.setAttribute("color", new BufferAttribute(colours, 3));
  return copy.applyMatrix4(local);
}

function floats(attribute: BufferAttribute): BufferAttribute {
  const numbers = new Float32Array(3 * attribute.count);
  for (let at = 0; at < attribute.count; at += 1)
    numbers.set([attribute.getX(at), attribute.getY(at), attribute.getZ(at)], 3 * at);
  return new BufferAttribute(numbers, 3);
}
