import { describe, expect, test } from "vitest";
import { RecordedArrays } from "../../live/arrays";
import { anglesOf, numbersOf, pixelsOf } from "../../model/net/views";
import { fromAbove, Paths, robotsOf } from "../../model/run/robots";

const base64 = (numbers: ArrayBufferView) =>
  Buffer.from(numbers.buffer, numbers.byteOffset, numbers.byteLength).toString("base64");

describe("what devices of a world gave", () => {
  test("is read by the type of its buffer, and refused if it has another size", () => {
    expect([...numbersOf("float64[2]", new Uint8Array(new Float64Array([1.5, -2]).buffer))!]).toEqual([1.5, -2]);
    expect([...numbersOf("uint16[2]", Uint8Array.of(1, 0, 0, 1))!]).toEqual([1, 256]);
    expect(numbersOf("float32[2]", new Uint8Array(4))).toBeNull();
    expect(numbersOf("Reading", new Uint8Array(4))).toBeNull();
  });

  test("of a scan has both ends, and in a full circle no ray twice", () => {
    const view = { path: "a", type: "", kind: "scan" as const };
    expect([...anglesOf({ ...view, from: -1, to: 1 }, 3)]).toEqual([-1, 0, 1]);
    expect(anglesOf(view, 4)[3]).toBeCloseTo(Math.PI / 2);
  });

  test("is a picture: near is bright, nothing is black, and another size is none", () => {
    const view = { path: "a", type: "", kind: "depth" as const, width: 3, height: 1 };
    const pixels = pixelsOf(view, Float32Array.of(1, 2, 50))!;
    expect([pixels[0], pixels[4], pixels[8]]).toEqual([255, 55, 0]);
    expect(pixelsOf(view, Float32Array.of(1, 2))).toBeNull();
    const colours = pixelsOf({ ...view, kind: "camera", width: 1 }, Float32Array.of(9, 8, 7))!;
    expect([...colours]).toEqual([9, 8, 7, 255]);
  });

  test("of a recording is loaded part by part, and holds until the next one", async () => {
    const asked: number[] = [];
    const source = (from: number) => {
      asked.push(from);
      const rows: [number, Record<string, string | null>][] = [
        [from, { a: base64(Uint8Array.of(1)), b: null }],
        [from + 1e9, { a: base64(Uint8Array.of(2)) }],
      ];
      return Promise.resolve({ arrays: rows, until: from + 4e9 });
    };
    const arrays = new RecordedArrays(source);
    expect(arrays.at("a", 5e9)).toBeUndefined();
    await new Promise((done) => setTimeout(done));
    expect([...arrays.at("a", 5.5e9)!]).toEqual([1]);
    expect(arrays.at("a", 5.5e9)).toBe(arrays.at("a", 5.6e9));
    expect([...arrays.at("a", 6e9)!]).toEqual([2]);
    expect(arrays.at("b", 8e9)).toBeNull();
    arrays.at("a", 1e9);
    expect(asked).toEqual([5e9, 1e9]);
  });
});

describe("robots from above", () => {
  const bodies: [string, string][] = [
    ["box[0]/box", ""],
    ["robot[0]/base", "robot[0]"],
    ["robot[0]/wheel", "robot[0]"],
    ["upper", "arm"],
    ["lower", "arm"],
  ];
  test("are what was placed, or what belongs to one agent; things come last", () => {
    expect(robotsOf(bodies).map(({ name, body }) => [name, body])).toEqual([
      ["robot[0]", 1],
      ["arm", 3],
      ["box[0]", 0],
    ]);
  });

  test("have paths in the order of time, in whatever order they are seen", () => {
    const paths = new Paths(bodies);
    const poses = (x: number) => Float32Array.from({ length: 7 * bodies.length }, (_, at) => (at % 7 === 0 ? x : 0));
    for (const time of [2e9, 3e9, 1e9, 1.01e9]) paths.take(time, poses(time / 1e9));
    expect(paths.times).toEqual([1e9, 2e9, 3e9]);
    expect(paths.points.map((point) => point[0])).toEqual([1, 2, 3]);
    expect(fromAbove(Float32Array.of(1, 2, 3, Math.SQRT1_2, 0, 0, Math.SQRT1_2), 0).heading).toBeCloseTo(Math.PI / 2);
  });
});
