import type { WorldView } from "../protocol";

type View = Pick<WorldView, "kind" | "from" | "to" | "width" | "height">;

/** The present state of a scan: rays on a body. */
export interface Rays {
  /** Index of the body; -1: it does not move. */
  body: number;
  position: readonly number[];
  /** w, x, y, z */
  quaternion: readonly number[];
  angles: Float32Array;
  ranges: Float32Array;
}

const readers = {
  uint8: [1, (data: DataView, at: number) => data.getUint8(at)],
  uint16: [2, (data: DataView, at: number) => data.getUint16(at, true)],
  float32: [4, (data: DataView, at: number) => data.getFloat32(at, true)],
  float64: [8, (data: DataView, at: number) => data.getFloat64(at, true)],
} as const;

/** The numbers of a buffer of the type "float64[32]"; null: the bytes do not have that type. */
export function numbersOf(type: string, bytes: Uint8Array): Float32Array | null {
  const [, element, length] = /^(\w+)\[(\d+)\]$/.exec(type) ?? [];
  const reader = readers[element as keyof typeof readers];
  if (!reader || bytes.length !== reader[0] * Number(length)) return null;
  const data = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
  return Float32Array.from({ length: Number(length) }, (_, at) => reader[1](data, at * reader[0]));
}

/** The angles that the device uses: both ends included; a full circle has no two rays in one direction. */
export function anglesOf({ from = -Math.PI, to = Math.PI }: View, rays: number): Float32Array {
  if (rays === 1) return Float32Array.of((from + to) / 2);
  const isCircle = Math.abs(Math.abs(to - from) - 2 * Math.PI) < 1e-6;
  const step = (to - from) / (isCircle ? rays : rays - 1);
  return Float32Array.from({ length: rays }, (_, at) => from + at * step);
}

/** Red, green, blue, opacity of each pixel; null: the numbers are not such a picture. */
export function pixelsOf(view: View, numbers: Float32Array): Uint8ClampedArray<ArrayBuffer> | null {
  const { kind, width = 0, height = 0 } = view;
  const pixels = width * height;
  if (pixels === 0 || numbers.length !== (kind === "camera" ? 3 : 1) * pixels) return null;
  const picture = new Uint8ClampedArray(4 * pixels).fill(255);
  const colour = kind === "camera" ? (at: number) => numbers.subarray(3 * at, 3 * at + 3) : kind === "depth" ? greyOf(numbers) : (at: number) => labelColour(numbers[at]!); // prettier-ignore
  for (let at = 0; at < pixels; at += 1) picture.set(colour(at), 4 * at);
  return picture;
}

/** Near points are bright. Pixels without an object have by far the largest distance. */
function greyOf(depths: Float32Array): (at: number) => number[] {
  let near = Infinity;
  let end = 0;
  for (const depth of depths) [near, end] = [Math.min(near, depth), Math.max(end, depth)];
  let far = near;
  for (const depth of depths) if (depth < 0.99 * end) far = Math.max(far, depth);
  return (at) => {
    const grey = depths[at]! > far ? 0 : 255 - (200 * (depths[at]! - near)) / Math.max(1e-9, far - near);
    return [grey, grey, grey];
  };
}

/** 0 is the world itself, or no object. */
function labelColour(label: number): number[] {
  if (label === 0) return [24, 28, 32];
  const hue = (label * 137.5) % 360;
  const part = (offset: number) => {
    const turn = (offset + hue / 30) % 12;
    return 255 * (0.55 - 0.4 * Math.max(-1, Math.min(turn - 3, 9 - turn, 1)));
  };
  return [part(0), part(8), part(4)];
}
