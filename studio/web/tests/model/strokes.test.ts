import { describe, expect, it } from "vitest";
import { elementAt } from "../../model/net/hit";
import { Sheets, type Placed } from "../../model/net/sheets";
import { strokesOf } from "../../model/net/strokes";
import { elk, lineFollower } from "./line_follower";

const net = lineFollower();
const open = () => false;

async function everySheet(folded: (page: number) => boolean): Promise<{ sheets: Sheets; visible: Placed[] }> {
  let arrived = () => {};
  const sheets = new Sheets(net, folded, elk, () => arrived());
  const window = { x: 0, y: 0, width: 1e5, height: 1e5, zoom: 100 };
  for (;;) {
    const next = new Promise<void>((done) => (arrived = done));
    const pages = Array.from({ length: net.pages.length }, (_, page) => page);
    const missing = pages.filter((page) => sheets.placed(page) === undefined);
    if (missing.length === 0) return { sheets, visible: sheets.visible(window) };
    await next;
  }
}

/** The layout takes long, so all tests share one. */
const opened = everySheet(open);

/** Whether a point is on one of the lines: left, top, right, bottom of each. */
const covered = (lines: Float32Array, x: number, y: number) => {
  for (let at = 0; at < lines.length; at += 4)
    if (x >= lines[at]! - 0.2 && x <= lines[at + 2]! + 0.2 && y >= lines[at + 1]! - 0.2 && y <= lines[at + 3]! + 0.2) return true;
  return false;
};

describe("the arcs of a sheet as lines", () => {
  it("cover every arc, each part once, and name its tip", async () => {
    const { sheets } = await opened;
    let shared = 0;
    for (let page = 0; page < net.pages.length; page += 1) {
      const { sheet } = sheets.placed(page)!;
      const kinds = [...strokesOf(net, page, sheet, true).values()];
      const tips = kinds.reduce((sum, { tips }) => sum + tips.length / 4, 0);
      expect(tips).toBe(sheet.routes.filter(({ points }) => points.length > 1).length);
      for (const { points } of sheet.routes)
        for (let at = 1; at < points.length; at += 1) {
          const [a, b] = [points[at - 1]!, points[at]!];
          const straight = a.x === b.x || a.y === b.y;
          const isThere = kinds.some(({ lines }) => covered(lines, (a.x + b.x) / 2, (a.y + b.y) / 2));
          if (straight) expect(isThere).toBe(true);
        }
      for (const { lines } of kinds)
        for (let one = 0; one < lines.length; one += 4)
          for (let other = one + 4; other < lines.length; other += 4) {
            const isDown = lines[one] === lines[one + 2];
            if (isDown !== (lines[other] === lines[other + 2]) || lines[one + (isDown ? 0 : 1)] !== lines[other + (isDown ? 0 : 1)]) continue; // prettier-ignore
            const [from, to] = isDown ? [1, 3] : [0, 2];
            expect(lines[one + to]! < lines[other + from]! || lines[other + to]! < lines[one + from]!).toBe(true);
          }
      const segments = sheet.routes.reduce((sum, { points }) => sum + Math.max(0, points.length - 1), 0);
      if (kinds.reduce((sum, { lines }) => sum + lines.length / 4, 0) < segments) shared += 1;
    }
    // Arcs that share a part of their way are drawn once there.
    expect(shared).toBeGreaterThan(0);
  });
  it("leave room for rounded corners", async () => {
    const { sheets } = await opened;
    const page = net.pageByPath.get("robot.control.follow")!;
    const { sheet } = sheets.placed(page)!;
    const turns = sheet.routes.reduce((sum, { points }) => sum + Math.max(0, points.length - 2), 0);
    const corners = [...strokesOf(net, page, sheet, false).values()].reduce((sum, one) => sum + one.corners.length / 6, 0);
    expect(corners).toBe(turns);
    expect(turns).toBeGreaterThan(0);
  });
});

describe("the element at a point", () => {
  it("is the one whose symbol is there, the innermost first", async () => {
    const { sheets, visible } = await opened;
    for (let page = 0; page < net.pages.length; page += 1)
      for (const { path, kind } of net.elementsOf(page)) {
        if (kind === "page") continue;
        const box = sheets.boxOf(path)!;
        // A place of a channel is drawn on several pages; this is the first of them.
        const at = { x: box.x + box.width / 2, y: box.y + box.height / 2 };
        expect(elementAt(net, open, visible, at), path).toBe(path);
      }
  });
  it("is a page where its net shows nothing, and its folded symbol with its name", async () => {
    const control = net.pageByPath.get("robot.control")!;
    const { sheets, visible } = await opened;
    const box = sheets.boxOf("robot.control")!;
    expect(elementAt(net, open, visible, { x: box.x + 1, y: box.y + 1 })).toBe("robot.control");
    expect(elementAt(net, open, visible, { x: -1e4, y: 0 })).toBe(null);
    const folded = (page: number) => page === control;
    const robot = (await everySheet(folded)).sheets.placed(net.pageByPath.get("robot")!)!;
    const node = net.page(robot.page).nodes.findIndex((one) => one.page === control);
    const symbol = robot.sheet.nodes[node]!;
    const at = (x: number, y: number) => ({ x: robot.x + x * robot.scale, y: robot.y + y * robot.scale });
    const beside = at(symbol.x + symbol.width + 20, symbol.y + symbol.height / 2);
    expect(elementAt(net, folded, [robot], at(symbol.x + 20, symbol.y + 20))).toBe("robot.control");
    expect(elementAt(net, folded, [robot], beside)).toBe("robot.control");
  });
});
