// Loaded with the first world only: three.js is larger than the rest of the page.
import {
  AmbientLight,
  Box3,
  Color,
  DirectionalLight,
  Group,
  InstancedMesh,
  LineSegments,
  Material,
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
import type { Poses } from "../../live/world";
import { perBody } from "../../model/run/pose_frames";
import { Bodies3d, still } from "./bodies_3d";
import type { Rays } from "../../model/net/views";
import { Pace } from "../run/pace";
import { Rays3d } from "./rays_3d";
import { Sharpness } from "./sharpness";

/** Whether WebGL runs on the processor, which makes every pixel expensive. Throws if there is none. */
function isSoftware(): boolean {
  const context = document.createElement("canvas").getContext("webgl2");
  if (!context) throw new Error("This browser has no WebGL.");
  const told = context.getExtension("WEBGL_debug_renderer_info");
  const name = String(context.getParameter(told ? told.UNMASKED_RENDERER_WEBGL : context.RENDERER));
  context.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}

/** A world in three dimensions on a canvas. It is drawn only after a change. */
export class World3d {
  /** The body that the view moves with. */
  private followed = -1;
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(45, 1, 0.01, 500);
  private readonly controls: OrbitControls;
  private readonly isSoftware = isSoftware();
  private readonly pace = new Pace();
  private readonly sharpness = new Sharpness();
  /** The part of the pixels that the picture shown has. */
  private scale = 1;
  /** Their poses; the drawn objects are in `drawn`. */
  private bodies: Object3D[] = [];
  private drawn: Bodies3d | null = null;
  private root: Object3D = new Group();
  private poses: Poses | null = null;
  /** The poses in which the bodies are drawn. */
  private shown: Poses | null = null;
  /** Made with the first ghosts. */
  private ghosts: Bodies3d | null = null;
  private ghostPoses: Poses | null = null;
  private readonly rays = new Rays3d();
  private scans: readonly Rays[] = [];
  private changed = true;
  private frame = 0;
  private waiting: ReturnType<typeof setTimeout> | undefined;
  private size = "";
  private pressed = new Vector2();

  /**
   * poses: the poses to show now. picked: a body was clicked. background: a colour of CSS. Throws if there is
   * no WebGL.
   */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly given: {
      poses: () => Poses | null;
      /** The same bodies in the run beside; null: there is none in this world. */
      ghosts: () => Poses | null;
      /** Scans that are drawn as rays. */
      scans: () => readonly Rays[];
      background: () => string;
      picked: (body: number) => void;
      lost: () => void;
    },
  ) {
    this.renderer = new WebGLRenderer({ canvas, antialias: !this.isSoftware });
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
    this.bodies = Array.from({ length: bodies }, () => new Group());
    scene.traverse((node) => {
      const body: unknown = node.userData.body;
      if (typeof body === "number" && body < bodies) this.bodies[body] = node;
    });
    scene.updateMatrixWorld(true);
    lookPlain(scene);
    this.lookAtAll();
    // Still objects come last: by then the bodies are no longer among them.
    this.drawn = Bodies3d.of(this.bodies);
    const fixed = still(this.root);
    this.root.clear();
    this.root.add(...this.bodies, ...this.drawn.meshes, ...fixed, this.rays.lines);
    this.root.updateMatrixWorld(true);
    this.tick();
  }

  close(): void {
    cancelAnimationFrame(this.frame);
    clearTimeout(this.waiting);
    this.canvas.removeEventListener("pointerdown", this.press);
    this.canvas.removeEventListener("click", this.click);
    this.canvas.removeEventListener("webglcontextlost", this.given.lost);
    this.controls.dispose();
    this.scene.traverse((node) => {
      if (!(node instanceof Mesh || node instanceof LineSegments)) return;
      node.geometry.dispose();
      const material = node.material as MeshLambertMaterial;
      material.map?.dispose();
      material.dispose();
    });
    this.renderer.dispose();
  }

  /** Looks from where another view does. */
  lookAs(other: World3d): void {
    this.camera.position.copy(other.camera.position);
    this.turnTo(other.controls.target.clone());
  }

  /** The world in other poses, as the address of a JPEG picture of the size of the canvas. */
  picture(poses: Poses): string {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    this.poses = poses;
    this.resize(1);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.scene.background = new Color(this.given.background());
    this.show();
    this.renderer.render(this.scene, this.camera);
    return this.canvas.toDataURL("image/jpeg", 0.78);
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
    if (poses && poses !== this.poses) {
      this.poses = poses;
      this.changed = true;
    }
    const scans = this.given.scans();
    if (scans !== this.scans) {
      this.scans = scans;
      this.changed = true;
    }
    this.haunt(this.given.ghosts());
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const background = this.given.background();
    const size = [width, height, devicePixelRatio, background].join();
    if (size !== this.size && width > 0 && height > 0) {
      this.size = size;
      this.scale = 0;
      this.sharpness.fit(width * height);
      this.camera.aspect = width / height;
      this.camera.updateProjectionMatrix();
      this.scene.background = new Color(background);
      this.changed = true;
    }
    const now = performance.now();
    if (width === 0 || height === 0 || !this.pace.isDue(now)) return;
    if (this.changed || this.sharpness.isBlurred(now, this.scale)) this.draw(now);
  };

  private draw(now: number): void {
    this.resize(this.isSoftware ? this.sharpness.scale(now) : 1);
    if (this.changed) this.sharpness.moved(now);
    this.changed = false;
    this.pace.begin(now);
    this.show();
    this.rays.show(this.scans, this.bodies);
    this.renderer.render(this.scene, this.camera);
    this.canvas.dataset.drawn = String(Number(this.canvas.dataset.drawn ?? 0) + 1);
    this.pace.ordered(performance.now());
    this.waitUntilDrawn();
  }

  /** Sets the part of the canvas's pixels that is drawn; the picture is stretched to the canvas. */
  private resize(scale: number): void {
    if (scale === this.scale) return;
    this.scale = scale;
    this.renderer.setPixelRatio(this.isSoftware ? scale : devicePixelRatio);
    this.renderer.setSize(this.canvas.clientWidth, this.canvas.clientHeight, false);
  }

  /** `render` only queues the work of another process. */
  private waitUntilDrawn(): void {
    const gl = this.renderer.getContext() as WebGL2RenderingContext;
    const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    const look = () => {
      if (fence && !gl.isContextLost() && gl.getSyncParameter(fence, gl.SYNC_STATUS) !== gl.SIGNALED) {
        this.waiting = setTimeout(look, 1);
        return;
      }
      gl.deleteSync(fence);
      this.pace.drawn(performance.now());
      this.sharpness.drawn(this.scale, this.pace);
    };
    this.waiting = setTimeout(look);
  }

  /** Moves all bodies to their poses, and the view with the one that it follows. */
  private show(): void {
    const { poses, shown } = this;
    if (!poses || poses === shown) return;
    this.shown = poses;
    const old = this.bodies[this.followed]?.getWorldPosition(new Vector3());
    this.bodies.forEach((group, body) => {
      const at = body * perBody;
      let same = shown !== null;
      for (let part = at; same && part < at + perBody; part += 1) same = shown![part] === poses[part];
      if (same) return;
      put(group, poses, body);
      this.drawn?.place(body, group.matrix);
    });
    if (!old) return;
    const now = this.bodies[this.followed]!.getWorldPosition(new Vector3());
    this.camera.position.add(now).sub(old);
    this.controls.target.add(now).sub(old);
    this.controls.update();
    // Objects that have turned with the body are drawn now, not once more.
    this.changed = false;
  }

  private haunt(poses: Poses | null): void {
    if (poses === this.ghostPoses) return;
    this.ghostPoses = poses;
    this.changed = true;
    if (!poses) {
      this.ghosts?.meshes.forEach((mesh) => mesh.removeFromParent());
      return;
    }
    this.ghosts ??= this.drawn!.ghosts(ghostly);
    for (let body = 0; body < this.bodies.length; body += 1) {
      put(scratch, poses, body);
      this.ghosts.place(body, scratch.matrix);
    }
    if (!this.ghosts.meshes[0]?.parent && this.ghosts.meshes.length > 0) this.root.add(...this.ghosts.meshes);
  }

  /** Bodies and floor picture, but not the endless plane below them. */
  private lookAtAll(): void {
    this.poses = this.given.poses();
    this.show();
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
    const body = several?.[hit.instanceId ?? 0];
    if (body !== undefined) this.given.picked(body);
  };

  /** The position of a body on the screen, for tests and labels; null: behind the view. */
  onScreen(body: number): { x: number; y: number } | null {
    const group = this.bodies[body];
    if (!group) return null;
    this.scene.updateMatrixWorld(true);
    const at = group.getWorldPosition(new Vector3()).project(this.camera);
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    return at.z > 1 ? null : { x: left + ((at.x + 1) / 2) * width, y: top + ((1 - at.y) / 2) * height };
  }
}

const scratch = new Group();

function put(node: Object3D, poses: Poses, body: number): void {
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
