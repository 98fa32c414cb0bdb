// Loaded with the first world only: three.js is larger than the rest of the page.
import {
  AmbientLight,
  Box3,
  Color,
  DirectionalLight,
  Group,
  InstancedMesh,
  Material,
  Matrix4,
  Mesh,
  MeshLambertMaterial,
  type MeshStandardMaterial,
  type Object3D,
  PerspectiveCamera,
  Raycaster,
  Scene,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import type { Poses } from "../live/world";
import { perBody } from "../model/pose_frames";

/** From so many equal parts on, they are drawn together. */
const together = 20;

/** A mesh that belongs to a body, drawn together with others. */
interface Instance {
  mesh: InstancedMesh;
  index: number;
  /** Its place in the body. */
  local: Matrix4;
}

/** Whether WebGL runs on the processor, where every pixel counts. Throws if there is none. */
function isSoftware(): boolean {
  const context = document.createElement("canvas").getContext("webgl2");
  if (!context) throw new Error("This browser has no WebGL.");
  const told = context.getExtension("WEBGL_debug_renderer_info");
  const name = String(context.getParameter(told ? told.UNMASKED_RENDERER_WEBGL : context.RENDERER));
  context.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}

/** A world in three dimensions on a canvas. It is drawn only when something has changed. */
export class World3d {
  /** The body that the view moves with. */
  private followed = -1;
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(45, 1, 0.01, 500);
  private readonly controls: OrbitControls;
  private readonly bodies: Group[] = [];
  private readonly instances: Instance[][] = [];
  private root: Object3D = new Group();
  private poses: Poses | null = null;
  /** Per body; made with the first ghosts. */
  private ghosts: Object3D[] = [];
  private ghostPoses: Poses | null = null;
  private changed = true;
  private frame = 0;
  private size = "";
  private pressed = new Vector2();

  /**
   * poses: what is to be shown now. picked: a body was clicked. background: a colour of CSS.
   * Throws if there is no WebGL.
   */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly given: {
      poses: () => Poses | null;
      /** The same bodies in the run beside; null: there is none in this world. */
      ghosts: () => Poses | null;
      background: () => string;
      picked: (body: number) => void;
      lost: () => void;
    },
  ) {
    this.renderer = new WebGLRenderer({ canvas, antialias: !isSoftware() });
    this.camera.up.set(0, 1, 0);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.maxPolarAngle = 0.55 * Math.PI;
    this.controls.addEventListener("change", this.touch);
    const sun = new DirectionalLight(0xffffff, 2);
    sun.position.set(1, 3, 2);
    this.scene.add(new AmbientLight(0xffffff, 1.4), sun);
    canvas.addEventListener("pointerdown", this.press);
    canvas.addEventListener("click", this.click);
    canvas.addEventListener("webglcontextlost", this.given.lost);
  }

  async load(glb: ArrayBuffer, bodies: number): Promise<void> {
    const { scene } = await new GLTFLoader().parseAsync(glb, "");
    this.scene.add(scene);
    this.root = scene.children[0]!;
    for (let body = 0; body < bodies; body += 1) {
      this.bodies.push(new Group());
      this.instances.push([]);
    }
    scene.traverse((node) => {
      const body: unknown = node.userData.body;
      if (typeof body === "number" && body < bodies) this.bodies[body] = node as Group;
    });
    scene.updateMatrixWorld(true);
    lookPlain(scene);
    // Before equal parts leave their bodies to be drawn together.
    this.ghosts = this.bodies.map((group) => ghostOf(group));
    this.drawTogether();
    this.lookAtAll();
    this.tick();
  }

  close(): void {
    cancelAnimationFrame(this.frame);
    this.canvas.removeEventListener("pointerdown", this.press);
    this.canvas.removeEventListener("click", this.click);
    this.canvas.removeEventListener("webglcontextlost", this.given.lost);
    this.controls.dispose();
    this.scene.traverse((node) => {
      if (!(node instanceof Mesh)) return;
      node.geometry.dispose();
      const material = node.material as MeshLambertMaterial;
      material.map?.dispose();
      material.dispose();
    });
    this.renderer.dispose();
  }

  /** Moves with a body; -1: with none. */
  follow(body: number): void {
    this.followed = body;
    const group = this.bodies[body];
    if (group) this.turnTo(group.getWorldPosition(new Vector3()));
  }

  touch = (): void => {
    this.changed = true;
  };

  private tick = (): void => {
    this.frame = requestAnimationFrame(this.tick);
    const poses = this.given.poses();
    if (poses && poses !== this.poses) this.move(poses);
    this.haunt(this.given.ghosts());
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const background = this.given.background();
    const size = [width, height, devicePixelRatio, background].join();
    if (size !== this.size && width > 0 && height > 0) {
      this.size = size;
      this.renderer.setPixelRatio(devicePixelRatio);
      this.renderer.setSize(width, height, false);
      this.camera.aspect = width / height;
      this.camera.updateProjectionMatrix();
      this.scene.background = new Color(background);
      this.changed = true;
    }
    if (!this.changed) return;
    this.changed = false;
    this.renderer.render(this.scene, this.camera);
    this.canvas.dataset.drawn = String(Number(this.canvas.dataset.drawn ?? 0) + 1);
  };

  private move(poses: Poses): void {
    const { poses: before } = this;
    this.poses = poses;
    const old = this.bodies[this.followed]?.getWorldPosition(new Vector3());
    this.bodies.forEach((group, body) => {
      const at = body * perBody;
      let same = before !== null;
      for (let part = at; same && part < at + perBody; part += 1) same = before![part] === poses[part];
      if (same) return;
      place(group, poses, body);
      for (const { mesh, index, local } of this.instances[body]!) {
        mesh.setMatrixAt(index, scratch.multiplyMatrices(group.matrix, local));
        mesh.instanceMatrix.needsUpdate = true;
      }
    });
    this.changed = true;
    if (!old) return;
    const now = this.bodies[this.followed]!.getWorldPosition(new Vector3());
    this.camera.position.add(now).sub(old);
    this.controls.target.add(now).sub(old);
    this.controls.update();
  }

  private haunt(poses: Poses | null): void {
    if (poses === this.ghostPoses) return;
    this.ghostPoses = poses;
    this.changed = true;
    this.ghosts.forEach((ghost, body) => {
      if (poses) place(ghost, poses, body);
      if (poses) this.root.add(ghost);
      else ghost.removeFromParent();
    });
  }

  /** Parts of bodies with the same triangles and the same look become one thing to draw. */
  private drawTogether(): void {
    const equal = new Map<string, { mesh: Mesh; body: number }[]>();
    this.bodies.forEach((group, body) =>
      group.traverse((node) => {
        if (!(node instanceof Mesh)) return;
        node.userData.body = body;
        const key = `${node.geometry.uuid} ${(node.material as Material).uuid}`;
        equal.set(key, [...(equal.get(key) ?? []), { mesh: node, body }]);
      }),
    );
    for (const parts of equal.values()) {
      if (parts.length < together) continue;
      const { geometry, material } = parts[0]!.mesh;
      const mesh = new InstancedMesh(geometry, material, parts.length);
      mesh.frustumCulled = false;
      mesh.userData.bodies = parts.map(({ body }) => body);
      parts.forEach(({ mesh: part, body }, index) => {
        const local = new Matrix4().copy(this.bodies[body]!.matrixWorld).invert().multiply(part.matrixWorld);
        this.instances[body]!.push({ mesh, index, local });
        mesh.setMatrixAt(index, scratch.multiplyMatrices(this.bodies[body]!.matrix, local));
        part.removeFromParent();
      });
      this.root.add(mesh);
    }
  }

  /** Bodies and floor picture, but not the endless plane below them. */
  private lookAtAll(): void {
    const poses = this.given.poses();
    if (poses) this.move(poses);
    this.scene.updateMatrixWorld(true);
    const box = new Box3();
    for (const group of this.bodies) box.expandByPoint(group.getWorldPosition(new Vector3()));
    this.root.traverse((node) => {
      if (!(node instanceof Mesh) || node instanceof InstancedMesh) return;
      const own = new Box3().setFromObject(node);
      const isPlane = own.max.y - own.min.y < 1e-3;
      if (!isPlane || node.userData.floor) box.union(own);
    });
    const centre = box.getCenter(new Vector3());
    const radius = Math.max(0.25, box.getSize(new Vector3()).length() / 2);
    const far = 1.45 * radius;
    this.camera.near = radius / 100;
    this.camera.far = Math.max(100, 40 * radius);
    this.camera.position.set(centre.x - 0.25 * far, centre.y + 0.85 * far, centre.z + 0.85 * far);
    this.camera.updateProjectionMatrix();
    this.turnTo(centre);
  }

  private turnTo(target: Vector3): void {
    this.controls.target.copy(target);
    this.controls.update();
    this.changed = true;
  }

  private press = (event: PointerEvent): void => {
    this.pressed.set(event.clientX, event.clientY);
  };

  private click = (event: MouseEvent): void => {
    const isDrag = this.pressed.distanceTo(new Vector2(event.clientX, event.clientY)) > 4;
    if (isDrag) return;
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const at = new Vector2(((event.clientX - left) / width) * 2 - 1, 1 - ((event.clientY - top) / height) * 2);
    const ray = new Raycaster();
    ray.setFromCamera(at, this.camera);
    this.scene.traverse((node) => node instanceof InstancedMesh && node.computeBoundingSphere());
    const hit = ray.intersectObject(this.scene)[0];
    if (!hit) return;
    const several = hit.object.userData.bodies as number[] | undefined;
    const body = several ? several[hit.instanceId ?? 0] : (hit.object.userData.body as number | undefined);
    if (body !== undefined) this.given.picked(body);
  };

  /** Where a body is on the screen, for tests and labels; null: behind the view. */
  onScreen(body: number): { x: number; y: number } | null {
    const group = this.bodies[body];
    if (!group) return null;
    this.scene.updateMatrixWorld(true);
    const at = group.getWorldPosition(new Vector3()).project(this.camera);
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    return at.z > 1 ? null : { x: left + ((at.x + 1) / 2) * width, y: top + ((1 - at.y) / 2) * height };
  }
}

const scratch = new Matrix4();

function place(node: Object3D, poses: Poses, body: number): void {
  const [x, y, z, w, i, j, k] = poses.subarray(body * perBody) as unknown as [
    number,
    number,
    number,
    number,
    number,
    number,
    number,
  ];
  node.position.set(x, y, z);
  node.quaternion.set(i, j, k, w).normalize();
  node.updateMatrix();
}

const ghostly = new MeshLambertMaterial({ color: 0x3b82c4, transparent: true, opacity: 0.35, depthWrite: false });

/** A copy that can be seen through, and not be clicked. */
function ghostOf(group: Object3D): Object3D {
  const ghost = group.clone(true);
  ghost.traverse((node) => {
    if (!(node instanceof Mesh)) return;
    node.material = ghostly;
    node.raycast = () => undefined;
  });
  return ghost;
}

/** Simple light, which a processor can compute; a picture on the floor is drawn above the floor. */
function lookPlain(scene: Object3D): void {
  const known = new Map<Material, MeshLambertMaterial>();
  scene.traverse((node) => {
    if (!(node instanceof Mesh)) return;
    const own = node.material as MeshStandardMaterial;
    let plain = known.get(own);
    if (!plain) {
      const { color, map, transparent, opacity, emissive } = own;
      plain = new MeshLambertMaterial({ color, map, transparent, opacity, emissive });
      if (node.userData.floor) Object.assign(plain, { polygonOffset: true, polygonOffsetFactor: -4, polygonOffsetUnits: -4 });
      known.set(own, plain);
    }
    node.material = plain;
  });
}
