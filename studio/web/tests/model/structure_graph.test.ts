import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import { intersects, type Box, type Point } from "../../model/net/geometry";
import { readStructure, type Structure } from "../../model/structure/structure";
import { connected, drawStructure, type StructureDrawing } from "../../model/structure/structure_graph";
import { chipLines } from "../../model/structure/structure_layout";
import { elk } from "./line_follower";

const orchard = readFileSync(new URL("../e2e/projects/orchard/spec.yaml", import.meta.url), "utf8");
const agent = (name: string) =>
  `  ${name}: { control: { inputs: { i: bool }, outputs: { o: bool }, behaviours: { run: {} } } }\n`;
const ring = (count: number) => {
  const names = Array.from({ length: count }, (_, at) => `member_${at}`);
  const channel = (name: string, at: number) => `  - ${name}.control.o -> ${names[(at + 1) % count]!}.control.i\n`;
  return `agents:\n${names.map(agent).join("")}channels:\n${names.map(channel).join("")}`;
};
const one =
  "agents:\n  a:\n    control: { inputs: { i: bool, j: bool }, outputs: { o: bool }, behaviours: { run: {} } }\n    receptors:\n      r: { real: { x: bool }, outputs: { o: bool }, behaviours: { w: {} } }\n      s: { outputs: { o: bool }, behaviours: { w: {} } }\n    effectors: { e: { inputs: { m: bool }, outputs: { back: bool }, real: { y: bool }, behaviours: { d: {} } } }\nchannels:\n  - a.r.o -> a.control.i\n  - a.control.o -> a.e.m\n  - { from: a.e.back, to: a.control.j, receive: blocking, timeout: 200 ms }\n";
const fleet =
  'agents:\n  robot: { control: { inputs: { i: bool }, outputs: { o: bool }, behaviours: { run: {} } }, count: 50, ring: true }\nchannels:\n  - "robot[i].control.o -> robot[i+1].control.i"\n';

/** The box of a piece of a line, without parts that only touch a rim. */
const pieces = (points: readonly Point[]): Box[] =>
  points.slice(1).map((to, at) => {
    const from = points[at]!;
    const [x, y] = [Math.min(from.x, to.x), Math.min(from.y, to.y)];
    return { x, y, width: Math.abs(from.x - to.x), height: Math.abs(from.y - to.y) };
  });
const shrunk = ({ x, y, width, height }: Box): Box => ({ x: x + 1, y: y + 1, width: width - 2, height: height - 2 });

function pairs<T>(all: readonly T[], judge: (one: T, other: T) => void): void {
  all.forEach((first, at) => all.slice(at + 1).forEach((other) => judge(first, other)));
}

function judge(structure: Structure, drawing: StructureDrawing): void {
  const agents = new Set(structure.agents.map(({ name }) => name));
  const named = [...drawing.boxes];
  const inner = named.filter(([path]) => !agents.has(path));
  pairs(inner, ([first, box], [second, other]) => expect(intersects(box, other), `${first} ${second}`).toBe(false));
  pairs(
    named.filter(([path]) => agents.has(path)),
    ([first, box], [second, other]) => expect(intersects(box, other), `${first} ${second}`).toBe(false),
  );
  for (const { points, channels } of drawing.wires)
    for (const piece of pieces(points))
      for (const [path, box] of inner)
        expect(intersects(piece, shrunk(box)), `channel ${channels.join()} through ${path}`).toBe(false);
  const labels = [...drawing.labels];
  expect(labels.length).toBe(connected(structure).length);
  pairs(labels, ([a, box], [b, other]) => expect(intersects(box, other), `labels ${a} ${b}`).toBe(false));
  for (const [index, label] of labels)
    for (const [path, box] of inner) expect(intersects(label, box), `label ${index} on ${path}`).toBe(false);
  for (const { index } of connected(structure)) {
    // Its wires touch each other from its output to its input.
    const wires = drawing.wires.filter(({ channels }) => channels.includes(index));
    const ends = wires.flatMap(({ points }) => [points[0]!, points.at(-1)!]);
    const loose = ends.filter(({ x, y }) => ends.filter((p) => Math.hypot(p.x - x, p.y - y) < 3).length < 2);
    expect(loose.length, `loose ends of channel ${index}`).toBe(2);
    expect(wires.filter(({ ends: tip }) => tip).length).toBe(1);
  }
}

describe("drawStructure", () => {
  for (const [name, text] of Object.entries({ orchard, one, fleet, ring: ring(6), "ring of three": ring(3), row: ring(14) }))
    it(`leads no line through a box, and no label over anything: ${name}`, async () => {
      const structure = readStructure(text);
      judge(structure, await drawStructure(structure, elk));
    });
  it("sets the members of a ring beside their neighbours", async () => {
    const { boxes } = await drawStructure(readStructure(ring(6)), elk);
    const corner = (at: number) => {
      const { x, y } = boxes.get(`member_${at % 6}`)!;
      return { x, y };
    };
    const columns = [...new Set(Array.from({ length: 6 }, (_, at) => Math.round(corner(at).x)))].sort((a, b) => a - b);
    const rows = [...new Set(Array.from({ length: 6 }, (_, at) => Math.round(corner(at).y)))].sort((a, b) => a - b);
    for (let at = 0; at < 6; at += 1) {
      const [a, b] = [corner(at), corner(at + 1)];
      const across = Math.abs(columns.indexOf(Math.round(a.x)) - columns.indexOf(Math.round(b.x)));
      const down = Math.abs(rows.indexOf(Math.round(a.y)) - rows.indexOf(Math.round(b.y)));
      expect(across + down).toBe(1);
    }
  });
  it("draws an empty system", async () => {
    expect((await drawStructure(readStructure(""), elk)).boxes.size).toBe(0);
  });
});

it("makes room for many behaviours", () => {
  const control = (behaviours: string) =>
    readStructure(`agents:\n  a: { control: { behaviours: { ${behaviours} } } }\n`).agents[0]!.subsystems[0]!;
  expect(chipLines(control("one: {}"))).toBe(1);
  expect(chipLines(control("a_rather_long_name: {}, another_long_name: {}, one: {}"))).toBeGreaterThan(1);
});
