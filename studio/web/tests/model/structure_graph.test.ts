import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import { intersects, type Box, type Point } from "../../model/net/geometry";
import { readStructure, type Structure } from "../../model/structure/structure";
import { agentOf, bundlesOf, connected, crosses } from "../../model/structure/bundles";
import { drawStructure as draw, type StructureDrawing } from "../../model/structure/structure_graph";
import { estimated } from "../../model/structure/text_size";
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

const drawStructure = (structure: Structure) => draw(structure, elk, estimated);

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
  const lines = [
    ...drawing.wires.map(({ points, channel }) => ({ points, of: `channel ${channel}` })),
    ...drawing.bundles.map(({ points, path }) => ({ points, of: path })),
  ];
  for (const { points, of } of lines)
    for (const piece of pieces(points))
      for (const [path, box] of inner) expect(intersects(piece, shrunk(box)), `${of} through ${path}`).toBe(false);
  const all = connected(structure);
  expect(drawing.bundles.map(({ path }) => path)).toEqual(bundlesOf(all).map(({ path }) => path));
  expect([...drawing.labels.keys()].sort()).toEqual(
    all
      .filter((one) => !crosses(one))
      .map(({ index }) => index)
      .sort(),
  );
  const labels = [
    ...[...drawing.labels].map(([index, box]) => [`channel ${index}`, box] as const),
    ...drawing.bundles.map(({ path, label }) => [path, label] as const),
  ];
  pairs(labels, ([a, box], [b, other]) => expect(intersects(box, other), `labels ${a} ${b}`).toBe(false));
  for (const [index, label] of labels)
    for (const [path, box] of inner) expect(intersects(label, box), `label ${index} on ${path}`).toBe(false);
  for (const channel of all) {
    // Its wires and its bundle touch each other from its output to its input.
    const wires = drawing.wires.filter((one) => one.channel === channel.index);
    const bundle = drawing.bundles.find(({ channels }) => channels.includes(channel.index));
    const ends = [...wires, ...(bundle ? [bundle] : [])].flatMap(({ points }) => [points[0]!, points.at(-1)!]);
    const loose = ends.filter(({ x, y }) => ends.filter((p) => Math.hypot(p.x - x, p.y - y) < 3).length < 2);
    expect(loose.length, `loose ends of channel ${channel.index}`).toBe(2);
    expect(wires.filter(({ ends: tip }) => tip).length).toBe(1);
    if (bundle) expect([agentOf(channel.from), agentOf(channel.to)].sort()).toEqual(bundle.agents);
  }
}

describe("drawStructure", () => {
  for (const [name, text] of Object.entries({ orchard, one, fleet, ring: ring(6), "ring of three": ring(3), row: ring(14) }))
    it(`leads no line through a box, and no label over anything: ${name}`, async () => {
      const structure = readStructure(text);
      judge(structure, await drawStructure(structure));
    });
  it("sets the members of a ring beside their neighbours", async () => {
    const { boxes } = await drawStructure(readStructure(ring(6)));
    const corner = (at: number) => {
      const { x, y } = boxes.get(`member_${at % 6}`)!;
      return { x, y };
    };
    // Agents of a row may be moved a little, so that no two lines meet.
    const ranks = (values: number[]) =>
      values.sort((a, b) => a - b).filter((one, at, all) => at === 0 || one - all[at - 1]! > 40);
    const rank = (all: number[], value: number) => all.filter((one) => one <= value + 1).length;
    const columns = ranks(Array.from({ length: 6 }, (_, at) => corner(at).x));
    const rows = ranks(Array.from({ length: 6 }, (_, at) => corner(at).y));
    for (let at = 0; at < 6; at += 1) {
      const [a, b] = [corner(at), corner(at + 1)];
      const across = Math.abs(rank(columns, a.x) - rank(columns, b.x));
      const down = Math.abs(rank(rows, a.y) - rank(rows, b.y));
      expect(across + down).toBe(1);
    }
  });
  it("draws an empty system", async () => {
    expect((await drawStructure(readStructure(""))).boxes.size).toBe(0);
  });
});
