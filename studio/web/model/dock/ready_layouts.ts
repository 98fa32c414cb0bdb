import { pruned, type Cell, type Row } from "./dock_tree";

/** The layouts that come with the page. */
export const layoutNames = ["edit", "debug", "operate"] as const;
export type LayoutName = (typeof layoutNames)[number];

export const layoutTitles: Record<LayoutName, string> = { edit: "Edit", debug: "Debug", operate: "Operate" };

/** The panels that are in front of their tab sets. */
const fronts: Record<LayoutName, readonly string[]> = {
  edit: ["inspect"],
  debug: ["run", "timeline", "events"],
  operate: ["run"],
};

/** The widths of windows that have layouts of their own: panels on both sides of the drawing, on one side, or below it. */
export type WidthName = "wide" | "medium" | "narrow";

/** The name of a width of so many pixels. */
export const widthName = (pixels: number): WidthName => (pixels < 900 ? "narrow" : pixels < 1240 ? "medium" : "wide");

/** The places of a layout where panels stand. */
export type Slot = "left" | "centre" | "right" | "corner" | "below" | "middle" | "end";

/** The place of a panel in each layout, and whether it is open there from the beginning. */
export interface Places {
  name: string;
  /** The text of its tab. */
  title: string;
  edit: Slot;
  debug: Slot;
  operate: Slot;
  /** The layouts in which it is closed until the user opens it. */
  closed?: readonly LayoutName[];
}

const tabs = (id: Slot, weight: number): Cell => ({ kind: "tabs", id, weight, tabs: [], front: "" });
const row = (id: string, weight: number, ...children: Cell[]): Row => ({ kind: "row", id, weight, children });

/** The tabs at the right stand in one row. */
const rightPixels = 386;

/** The drawing gets what the text and the forms leave. */
function shares(width: number): { left: number; right: number } {
  const left = Math.min(400, Math.max(300, width - 1080));
  return { left: (100 * left) / width, right: (100 * rightPixels) / width };
}

const skeletons: Record<LayoutName, (width: number) => Row> = {
  edit: (width) => {
    const { left, right } = shares(width);
    return row(
      "root",
      100,
      row(
        "top",
        70,
        tabs("left", left),
        row("inner", 100 - left - right, tabs("centre", 74), tabs("corner", 26)),
        tabs("right", right),
      ),
      row("bottom", 30, tabs("below", 44), tabs("middle", 33), tabs("end", 23)),
    );
  },
  debug: (width) => {
    const { right } = shares(width);
    return row(
      "root",
      100,
      row("top", 62, tabs("left", 26), tabs("centre", 74 - right), row("side", right, tabs("end", 45), tabs("right", 55))),
      row("bottom", 38, tabs("below", 50), tabs("middle", 27), tabs("corner", 23)),
    );
  },
  operate: () =>
    row(
      "root",
      100,
      row(
        "top",
        72,
        row("seen", 64, tabs("end", 68), tabs("centre", 32)),
        row("side", 36, tabs("right", 60), tabs("middle", 40)),
      ),
      row("bottom", 28, tabs("below", 55), tabs("corner", 25), tabs("left", 20)),
    ),
};

/** In a window of medium width, panels stand in two columns: those at the left of a wide window below the drawing. */
function mediumLayout(layout: LayoutName, width: number): Row {
  if (layout === "operate") return skeletons.operate(width);
  const right = (100 * rightPixels) / width;
  const side =
    layout === "edit"
      ? row("side", right, tabs("right", 62), tabs("middle", 38))
      : row("side", right, tabs("end", 34), tabs("right", 36), tabs("middle", 30));
  return row("root", 100, row("top", 100, row("inner", 100 - right, tabs("centre", 60), tabs("below", 40)), side));
}

/** The places of a medium window that stand for others. */
const mediumSlots: Record<LayoutName, Partial<Record<Slot, Slot>>> = {
  edit: { left: "below", end: "middle", corner: "middle" },
  debug: { left: "below", corner: "middle" },
  operate: {},
};

/** In a narrow window, the panels are a stack of tabs below the drawing. */
const stack = row("root", 100, tabs("centre", 46), tabs("right", 54));

/** A layout as it comes with the page, for a window of so many pixels. */
export function readyLayout(layout: LayoutName, panels: readonly Places[], width: number): Row {
  const name = widthName(width);
  const whole = { narrow: () => stack, medium: () => mediumLayout(layout, width), wide: () => skeletons[layout](width) }[name]();
  const slotOf = ({ [layout]: slot }: Places): Slot =>
    name === "narrow" && slot !== "centre" ? "right" : (name === "medium" && mediumSlots[layout][slot]) || slot;
  const walk = (cell: Cell): Cell => {
    if (cell.kind === "row") return { ...cell, children: cell.children.map(walk) };
    const mine = panels.filter((one) => slotOf(one) === cell.id).map(({ name }) => name);
    return { ...cell, tabs: mine, front: fronts[layout].find((name) => mine.includes(name)) ?? mine[0] ?? "" };
  };
  return pruned(walk(whole) as Row, () => true);
}

/** The panels that a layout does not show until the user opens them. */
export const closedIn = (layout: LayoutName, panels: readonly Places[]): string[] =>
  panels.filter(({ closed }) => closed?.includes(layout)).map(({ name }) => name);
