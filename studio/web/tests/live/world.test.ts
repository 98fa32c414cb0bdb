import { describe, expect, test } from "vitest";
import type { RecordedPoses } from "../../model/protocol";
import { LiveWorld, RecordedWorld } from "../../live/world";
import { PoseFrames } from "../../model/run/pose_frames";

const base64 = (hex: string) => Buffer.from(hex, "hex").toString("base64");
/** tests/runtime/poses_test.cpp has the same bytes and poses. */
const frames = [
  "010000000fb0ea01bfb802d804fe7f0008fe7f0060e64cb166",
  "0001000001f6010168b2060b12",
  "0002000001f601000280a8d6b907",
].map(base64);

const numbers = (poses: Float32Array | null) => [...(poses ?? [])].map((one) => Number(one.toFixed(3)));

describe("frames of poses", () => {
  test("give the poses that the runtime has recorded", () => {
    const reader = new PoseFrames(3);
    expect(reader.take(frames[0]!)).toBe(true);
    expect(numbers(reader.poses())).toEqual([1.5, -2, 0.03, 1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0.6, -0.8]);
    expect(reader.take(frames[1]!)).toBe(true);
    expect(numbers(reader.poses())).toEqual([1.512, -2, 0.03, 1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0.05, 0, 0.599, -0.799]);
    expect(reader.take(frames[2]!)).toBe(true);
    expect(reader.poses()[8]).toBe(100_000);
  });

  test("are not known before a whole one, nor behind a missing one", () => {
    const late = new PoseFrames(3);
    expect(late.take(frames[1]!)).toBe(false);
    expect(late.known).toBe(false);
    expect(late.take(frames[0]!)).toBe(true);
    expect(late.take(frames[2]!)).toBe(false);
    expect(late.known).toBe(false);
  });

  test("that come twice change nothing, and nonsense is refused", () => {
    const reader = new PoseFrames(3);
    reader.take(frames[0]!);
    expect(reader.take(frames[0]!)).toBe(false);
    expect(reader.known).toBe(true);
    for (const hex of ["", "05", "020000", "010000", "0001000001ff", "00010009010101", "000100000101ffffffffffffffffffff"])
      expect(new PoseFrames(3).take(base64(hex))).toBe(false);
    const fewer = new PoseFrames(2);
    expect(fewer.take(frames[0]!)).toBe(false);
  });
});

const scene = {
  hash: "0123456789abcdef",
  bodies: [
    ["a", "robot"],
    ["b", ""],
    ["c", ""],
  ] as [string, string][],
};

describe("worlds", () => {
  test("of a run show what came last, and another object for other poses", () => {
    const world = new LiveWorld(scene);
    expect(world.at()).toBeNull();
    world.take({ t: 0, frame: frames[0]! });
    const first = world.at();
    expect(world.at()).toBe(first);
    world.take({ t: 40e6, frame: frames[1]! });
    expect(world.at()).not.toBe(first);
  });

  test("of a recording are loaded part by part, ahead of the time that is shown", async () => {
    const asked: [number, number][] = [];
    const source = (from: number, to: number): Promise<RecordedPoses> => {
      asked.push([from, to]);
      return Promise.resolve({ frames: frames.map((frame, at) => [from + at * 40e6, frame]), until: to });
    };
    const world = new RecordedWorld(scene, source);
    const settled = () => new Promise((done) => setTimeout(done));
    expect(world.at(100e9)).toBeNull();
    await settled();
    expect(asked).toEqual([[98e9, 130e9]]);
    expect(numbers(world.at(98e9 + 39e6)).slice(0, 1)).toEqual([1.5]);
    expect(numbers(world.at(98e9 + 40e6)).slice(0, 1)).toEqual([1.512]);
    expect(asked.length).toBe(1);
    world.at(125e9);
    await settled();
    expect(asked[1]![0]).toBe(130e9);
    expect(world.at(131e9)).not.toBeNull();
    expect(world.at(10e9)).toBeNull();
    await settled();
    expect(world.at(10e9)).not.toBeNull();
  });

  test("of a recording that cannot be loaded are asked for once", async () => {
    let asked = 0;
    const world = new RecordedWorld(scene, () => ((asked += 1), Promise.reject(new Error("gone"))));
    for (let at = 0; at < 3; at += 1) {
      expect(world.at(1e9)).toBeNull();
      await new Promise((done) => setTimeout(done));
    }
    expect(asked).toBe(1);
    expect(world.problem).toBe("gone");
  });
});
