/** Numbers of a pose: x, y, z in metres and the quaternion w, i, j, k. */
export const perBody = 7;
const stepsPerMetre = 10_000;
const stepsPerUnit = 8191;
const wholeFrame = 1;
const headBytes = 3;

/** Decodes a stream of frames of poses (tessera/poses.hpp describes them). */
export class PoseFrames {
  /** Whether `steps` is right: not before the first whole frame, nor after a missing frame. */
  known = false;
  private readonly steps: Float64Array;
  private number = -1;

  constructor(readonly bodies: number) {
    this.steps = new Float64Array(bodies * perBody);
  }

  /** Takes the next frame, base64. Returns whether it was one, and has changed something. */
  take(frame: string): boolean {
    const text = atob(frame);
    const bytes = Uint8Array.from(text, (letter) => letter.charCodeAt(0));
    if (bytes.length < headBytes || bytes[0]! > wholeFrame) return (this.known = false);
    const whole = bytes[0] === wholeFrame;
    const number = bytes[1]! | (bytes[2]! << 8);
    // A page that begins in the middle may get frames that it already has.
    if (this.known && number === this.number) return false;
    const follows = number === ((this.number + 1) & 0xffff);
    this.number = number;
    this.known = whole || (this.known && follows);
    if (this.known) this.known = this.apply(bytes, whole);
    return this.known;
  }

  /** A copy of the poses. */
  poses(): Float32Array {
    const poses = new Float32Array(this.steps.length);
    for (let at = 0; at < poses.length; at += 1) poses[at] = this.steps[at]! / (at % perBody < 3 ? stepsPerMetre : stepsPerUnit);
    return poses;
  }

  private apply(bytes: Uint8Array, whole: boolean): boolean {
    let at = headBytes;
    const varint = () => {
      let number = 0;
      for (let factor = 1; at < bytes.length; factor *= 128) {
        const byte = bytes[at++]!;
        number += (byte & 127) * factor;
        if (byte < 128) return number;
      }
      return NaN;
    };
    let listed = 0;
    for (let body = 0; at < bytes.length; body += 1, listed += 1) {
      body += varint();
      const mask = bytes[at++];
      if (!(body < this.bodies) || mask === undefined) return false;
      for (let part = 0; part < perBody; part += 1) {
        const index = body * perBody + part;
        if (whole) this.steps[index] = 0;
        if ((mask & (1 << part)) === 0) continue;
        const zigzag = varint();
        if (!Number.isFinite(zigzag)) return false;
        this.steps[index]! += zigzag % 2 === 0 ? zigzag / 2 : -(zigzag + 1) / 2;
      }
    }
    return !whole || listed === this.bodies;
  }
}
