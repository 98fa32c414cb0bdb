import {
  BufferAttribute,
  BufferGeometry,
  DynamicDrawUsage,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  Quaternion,
  Vector3,
} from "three";
import type { Object3D } from "three";
import type { Rays } from "../../model/net/views";

const one = new Vector3(1, 1, 1);
/** Numbers of all scans together: two points of three numbers each. */
const mostRays = 20_000;

/** The rays of all scans, in one draw call. */
export class Rays3d {
  readonly lines: LineSegments;
  private readonly points = new BufferAttribute(new Float32Array(6 * mostRays), 3).setUsage(DynamicDrawUsage);

  constructor() {
    const geometry = new BufferGeometry().setAttribute("position", this.points);
    this.lines = new LineSegments(geometry, new LineBasicMaterial({ color: 0xe08a1e, transparent: true, opacity: 0.55 }));
    this.lines.frustumCulled = false;
    this.lines.raycast = () => undefined;
  }

  /** bodies: their places in the world. */
  show(scans: readonly Rays[], bodies: readonly Object3D[]): void {
    const place = new Matrix4();
    const point = new Vector3();
    let at = 0;
    for (const { body, position, quaternion, angles, ranges } of scans) {
      const [w, i, j, k] = quaternion as [number, number, number, number];
      place.compose(new Vector3(...(position as [number, number, number])), new Quaternion(i, j, k, w), one);
      if (body >= 0) place.premultiply(bodies[body]!.matrix);
      for (let ray = 0; ray < ranges.length && at + 2 <= 2 * mostRays; ray += 1) {
        if (!Number.isFinite(ranges[ray])) continue;
        point.set(0, 0, 0).applyMatrix4(place);
        this.points.setXYZ(at, point.x, point.y, point.z);
        point.set(ranges[ray]! * Math.cos(angles[ray]!), ranges[ray]! * Math.sin(angles[ray]!), 0).applyMatrix4(place);
        this.points.setXYZ(at + 1, point.x, point.y, point.z);
        at += 2;
      }
    }
    this.lines.geometry.setDrawRange(0, at);
    this.points.needsUpdate = true;
  }
}
