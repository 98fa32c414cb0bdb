import { describe, expect, it } from "vitest";
import { foldedPage, intersects, type Point, type Sheet } from "../../model/net/geometry";
import { layoutPage } from "../../model/net/layout";
import { NetModel, type FoldedNet, type Page } from "../../model/net/net";
import { boxWithin, Sheets } from "../../model/net/sheets";
import { elk, lineFollower } from "./line_follower";

const net = lineFollower();
const nothingFolded = () => false;

/** A system of agents without insides. */
function manyAgents(count: number): FoldedNet {
  const span = { line: 0, column: 0, length: 1 };
  const node = (name: string, page: number | null) => ({ name, page, fusion: null, tokens: 0, operation: null });
  const page = (path: string, parent: number | null, inside: string[]): Page => ({
    path,
    name: path,
    layer: parent === null ? "system" : "agent",
    parent,
    subsystem: null,
    input: 0,
    output: inside.length + 1,
    span,
    nodes: [node("in", null), ...inside.map((name, at) => node(name, at + 1)), node("out", null)],
    transitions: [
      { name: "t_in", inputs: [0], outputs: inside.map((_, at) => at + 1), condition: null, role: "start_system", span },
      {
        name: "t_out",
        inputs: inside.map((_, at) => at + 1),
        outputs: [inside.length + 1],
        condition: null,
        role: "end_system",
        span,
      },
    ],
  });
  const names = Array.from({ length: count }, (_, at) => `robot[${at}]`);
  return {
    system: { pages: [page("", null, names)], places: [], transitions: [] },
    shapes: [
      {
        pages: [page("", null, [])].map((one) => ({ ...one, layer: "agent" })),
        places: [],
        transitions: [],
        subsystems: 0,
        memory: [],
      },
    ],
    agents: names.map((name) => ({ name, shape: 0, channels: [] })),
    memories: [],
    channels: [],
  };
}

const around = (a: Point, b: Point) => ({
  x: Math.min(a.x, b.x) - 0.5,
  y: Math.min(a.y, b.y) - 0.5,
  width: Math.abs(a.x - b.x) + 1,
  height: Math.abs(a.y - b.y) + 1,
});

async function complete(sheets: Sheets, of: NetModel): Promise<void> {
  for (let page = 0; page < of.pages.length; page += 1) while (!sheets.get(page)) await new Promise((done) => setImmediate(done));
}

describe("layoutPage", () => {
  it("draws no two symbols over each other and every arc from border to border", async () => {
    for (let page = 0; page < net.pages.length; page += 1) {
      const sheet = await layoutPage(net, page, nothingFolded, elk);
      const boxes = [...sheet.nodes, ...sheet.transitions];
      boxes.forEach((a, at) => boxes.slice(at + 1).forEach((b) => expect(intersects(a, b), net.page(page).path).toBe(false)));
      const arcs = net.page(page).transitions.reduce((sum, t) => sum + t.inputs.length + t.outputs.length, 0);
      expect(sheet.routes.length).toBe(arcs);
      for (const route of sheet.routes) endsTouch(sheet, route);
    }
  });
  it("draws arcs from what a subsystem knows, which stands beside the flow", async () => {
    const knowing = lineFollower();
    const page = [...knowing.pages].findIndex(({ layer }) => layer === "subsystem");
    const { nodes, input: known } = knowing.page(page);
    Object.assign(nodes[known]!, { fusion: 0 });
    const sheet = await layoutPage(knowing, page, nothingFolded, elk);
    const arcs = sheet.routes.filter((route) => route.node === known);
    expect(arcs.length).toBeGreaterThan(0);
    for (const route of arcs) endsTouch(sheet, route);
  });
  it("leaves the names of many folded pages clear of arcs", async () => {
    const fleet = new NetModel(manyAgents(30));
    const sheet = await layoutPage(fleet, 0, () => true, elk);
    expect(sheet.grid).toBe(true);
    for (const box of sheet.nodes.filter((one) => one.width === foldedPage)) {
      const below = { x: box.x - 10, y: box.y + box.height + 1, width: box.width + 20, height: 16 };
      for (const { points } of sheet.routes)
        points.slice(1).forEach((end, at) => expect(intersects(around(points[at]!, end), below)).toBe(false));
    }
  });
  it("is the same for equal pages, which are laid out once", async () => {
    let asked = 0;
    const counting = (graph: Parameters<typeof elk>[0]) => ((asked += 1), elk(graph));
    const sheets = new Sheets(net, nothingFolded, counting, () => undefined);
    await complete(sheets, net);
    expect(asked).toBeLessThan([...net.pages].filter((page) => page.layer !== "system" && page.layer !== "agent").length);
  });
});

function endsTouch(sheet: Sheet, route: Sheet["routes"][number]): void {
  const around = (at: { x: number; y: number }, box: { x: number; y: number; width: number; height: number }) =>
    at.x >= box.x - 1 && at.x <= box.x + box.width + 1 && at.y >= box.y - 1 && at.y <= box.y + box.height + 1;
  const last = route.points.at(-1)!;
  expect(around(last, route.into === "node" ? sheet.nodes[route.node]! : sheet.transitions[route.transition]!)).toBe(true);
}

describe("Sheets", () => {
  it("keeps what is inside a page within its box", async () => {
    const sheets = new Sheets(net, nothingFolded, elk, () => undefined);
    await complete(sheets, net);
    for (let page = 1; page < net.pages.length; page += 1) {
      const outer = sheets.boxOf(net.page(page).path)!;
      const placed = sheets.placed(page)!;
      const inner = boxWithin(placed, { x: 0, y: 0, width: placed.sheet.width, height: placed.sheet.height });
      expect(
        inner.x >= outer.x &&
          inner.y >= outer.y &&
          inner.x + inner.width <= outer.x + outer.width + 1e-6 &&
          inner.y + inner.height <= outer.y + outer.height + 1e-6,
        net.page(page).path,
      ).toBe(true);
    }
  });
  it("moves nothing outside of a page when only its inside changes", async () => {
    const before = new Sheets(net, nothingFolded, elk, () => undefined);
    await complete(before, net);
    const changed = lineFollower();
    const inside = changed.pageByPath.get("robot.motor.drive.rcv")!;
    changed.page(inside).nodes.push({ name: "more", page: null, fusion: null, tokens: 0, operation: null });
    const after = new Sheets(changed, nothingFolded, elk, () => undefined, before);
    await complete(after, changed);
    for (const page of net.pages) if (page.path) expect(after.boxOf(page.path), page.path).toEqual(before.boxOf(page.path));
  });
  it("shows more layers the nearer one looks", async () => {
    const sheets = new Sheets(net, nothingFolded, elk, () => undefined);
    await complete(sheets, net);
    const depth = (path: string) => {
      const box = sheets.boxOf(path)!;
      const zoom = Math.min(1400 / box.width, 900 / box.height);
      return new Set(sheets.visible({ ...box, zoom }).map((placed) => net.page(placed.page).layer));
    };
    expect(depth("").has("communication")).toBe(false);
    expect(depth("robot.control.follow.snd").has("communication")).toBe(true);
  });
});
