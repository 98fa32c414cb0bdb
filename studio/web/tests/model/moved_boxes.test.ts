import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import { intersects, type Box, type Point } from "../../model/net/geometry";
import { both, joined, reversed, withChange } from "../../model/structure/box_changes";
import { positionAfter, withMoved, type Positions } from "../../model/structure/moved_boxes";
import { readStructure } from "../../model/structure/structure";
import { drawStructure, type StructureDrawing } from "../../model/structure/structure_graph";
import { estimated } from "../../model/structure/text_size";
import { wayAround } from "../../model/structure/way_around";
import { History } from "../../model/history";
import { elk } from "./line_follower";

const orchard = readStructure(readFileSync(new URL("../e2e/projects/orchard/spec.yaml", import.meta.url), "utf8"));
const drawing = await drawStructure(orchard, elk, estimated);

const shrunk = ({ x, y, width, height }: Box): Box => ({ x: x + 2, y: y + 2, width: width - 4, height: height - 4 });
const pieces = (points: readonly Point[]): Box[] =>
  points.slice(1).map((to, at) => {
    const from = points[at]!;
    expect(from.x === to.x || from.y === to.y, "pieces are horizontal or vertical").toBe(true);
    const [x, y] = [Math.min(from.x, to.x), Math.min(from.y, to.y)];
    return { x, y, width: Math.abs(from.x - to.x), height: Math.abs(from.y - to.y) };
  });
const isIn = (inner: Box, outer: Box) =>
  inner.x >= outer.x &&
  inner.y >= outer.y &&
  inner.x + inner.width <= outer.x + outer.width &&
  inner.y + inner.height <= outer.y + outer.height;

/** No box and no line is hidden, and every line ends where its boxes are. */
function judge({ boxes, wires, bundles, labels }: StructureDrawing): void {
  const agents = [...boxes].filter(([path]) => !path.includes("."));
  const parts = [...boxes].filter(([path]) => path.includes("."));
  for (const all of [agents, parts])
    all.forEach(([path, box], at) => {
      for (const [other, one] of all.slice(at + 1)) expect(intersects(box, one), `${path} on ${other}`).toBe(false);
    });
  for (const [path, box] of parts) expect(isIn(box, boxes.get(path.split(".")[0]!)!), `${path} in its agent`).toBe(true);
  for (const { points, channel } of wires)
    for (const piece of pieces(points))
      for (const [path, box] of parts) expect(intersects(piece, shrunk(box)), `channel ${channel} through ${path}`).toBe(false);
  for (const { points, path } of bundles)
    for (const piece of pieces(points))
      for (const [agent, box] of agents) expect(intersects(piece, shrunk(box)), `${path} through ${agent}`).toBe(false);
  for (const [index, label] of labels)
    for (const [path, box] of parts) expect(intersects(label, box), `label ${index} on ${path}`).toBe(false);
  for (const bundle of bundles)
    for (const end of [bundle.points[0]!, bundle.points.at(-1)!]) {
      const inside = wires
        .filter((wire) => bundle.channels.includes(wire.channel))
        .flatMap(({ points }) => [points[0]!, points.at(-1)!]);
      expect(
        inside.some(({ x, y }) => Math.hypot(x - end.x, y - end.y) < 3),
        `${bundle.path} ends at its wires`,
      ).toBe(true);
    }
}

/** Numbers that are the same in every run. */
function random(seed: number): () => number {
  let state = seed;
  return () => (state = (state * 48271) % 2147483647) / 2147483647;
}

describe("moved boxes", () => {
  it("change nothing where nothing was moved", () => {
    expect(withMoved(drawing, {})).toBe(drawing);
    expect(withMoved(drawing, { nobody: [1, 2] })).toBe(drawing);
  });

  it("stand where they were put, and take what is in them along", () => {
    const moved = withMoved(drawing, { lookout: [2000, -300] });
    expect(moved.boxes.get("lookout")).toMatchObject({ x: 2000, y: -300 });
    const [before, after] = [drawing, moved].map(({ boxes }) => boxes.get("lookout.control")!.x - boxes.get("lookout")!.x);
    expect(after).toBe(before);
    expect(moved.boxes.get("carrier")).toEqual(drawing.boxes.get("carrier"));
    expect(moved.top).toBeLessThanOrEqual(-300);
    judge(moved);
  });

  it("hide neither boxes nor lines, wherever they are put", () => {
    const next = random(7);
    const paths = [...drawing.boxes.keys()].filter((path) => !path.includes("#"));
    for (let round = 0; round < 6; round += 1) {
      const moved: Record<string, [number, number]> = {};
      for (const path of paths) if (next() < 0.3) moved[path] = [Math.round(next() * 1200 - 200), Math.round(next() * 900 - 200)];
      judge(withMoved(drawing, moved, Object.keys(moved)[0]));
    }
  });

  it("keep a position from the corner of the agent, and no further than its rim", () => {
    const agent = drawing.boxes.get("lookout")!;
    expect(positionAfter(drawing, "lookout", { x: 10.4, y: 5 })).toEqual([Math.round(agent.x + 10.4), Math.round(agent.y + 5)]);
    const [x, y] = positionAfter(drawing, "lookout.control", { x: -5000, y: -5000 })!;
    expect(x).toBeGreaterThan(0);
    expect(y).toBeGreaterThan(0);
    expect(positionAfter(drawing, "lookout.control.seen", { x: 1, y: 1 })).toBeUndefined();
    const put = withMoved(drawing, { "lookout.control": [600, 400] });
    const [own, around] = [put.boxes.get("lookout.control")!, put.boxes.get("lookout")!];
    expect([own.x - around.x, own.y - around.y]).toEqual([600, 400]);
  });
});

describe("a way around boxes", () => {
  it("is direct if nothing is between, and leads around what is", () => {
    const [from, to] = [{ x: 0, y: 50, side: "right" } as const, { x: 300, y: 50, side: "left" } as const];
    expect(wayAround(from, to, [], [])).toEqual([
      { x: 0, y: 50 },
      { x: 300, y: 50 },
    ]);
    const box = { x: 100, y: 0, width: 100, height: 100 };
    const way = wayAround(from, to, [box], []);
    expect(way.length).toBe(6);
    for (const piece of pieces(way)) expect(intersects(piece, shrunk(box))).toBe(false);
  });
});

describe("changes of boxes", () => {
  const a: Positions = { a: [1, 1], b: [2, 2] };
  it("of two sides are joined box by box", () => {
    expect(joined(a, { ...a, a: [5, 5] }, { a: [1, 1], c: [3, 3] })).toEqual({ a: [5, 5], c: [3, 3] });
    expect(joined(a, { b: [2, 2] }, a)).toEqual({ b: [2, 2] });
    expect(joined({}, a, { a: [9, 9] })).toEqual(a);
  });

  it("are undone and done again with the text", () => {
    const first = { before: { a: null }, after: { a: [1, 1] as const } };
    const second = { before: { a: [1, 1] as const }, after: { a: [2, 2] as const } };
    expect(withChange(withChange({}, both(first, second)), reversed(both(first, second)))).toEqual({});
    const history = new History("text");
    history.moved(first, "move a", 0);
    history.moved(second, "move a", 100);
    history.change("other", "edit", 200);
    expect(history.undo()).toBe("text");
    expect(history.ahead("undo")?.boxes).toEqual({ before: { a: [2, 2] }, after: { a: null } });
    expect(history.undo()).toBe("text");
    expect(history.canUndo).toBe(false);
    expect(history.ahead("redo")?.boxes).toEqual({ before: { a: null }, after: { a: [2, 2] } });
  });
});
