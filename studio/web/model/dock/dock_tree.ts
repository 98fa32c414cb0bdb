/** The arrangement of panels: rows of tab sets and rows, in turn below each other and side by side. */

/** Panels as tabs in one place. */
export interface TabSet {
  kind: "tabs";
  id: string;
  /** Its share of its row; only the proportions count. */
  weight: number;
  /** Names of panels, in the order of the tabs. */
  tabs: readonly string[];
  /** The panel whose tab is chosen. */
  front: string;
  /** Whether it fills the whole page. */
  maximised?: boolean;
}

/** The children of the root stand below each other, theirs side by side, and so on. */
export interface Row {
  kind: "row";
  id: string;
  weight: number;
  children: readonly Cell[];
}

export type Cell = Row | TabSet;

/** All tab sets, in the order in which they are seen. */
export function tabSets(cell: Cell): TabSet[] {
  return cell.kind === "tabs" ? [cell] : cell.children.flatMap(tabSets);
}

/** All panels of an arrangement. */
export const panelsIn = (tree: Cell): string[] => tabSets(tree).flatMap(({ tabs }) => tabs);

/** The panels that can be seen: those in front, or the one that is maximised. */
export function seenIn(tree: Row): string[] {
  const all = tabSets(tree);
  const whole = all.find(({ maximised }) => maximised);
  return (whole ? [whole] : all).map(({ front }) => front);
}

/** The same arrangement with a change of the tab set that holds a panel. */
export function withTabSet(tree: Row, panel: string, change: (found: TabSet) => TabSet): Row {
  const walk = (cell: Cell): Cell =>
    cell.kind === "row" ? { ...cell, children: cell.children.map(walk) } : cell.tabs.includes(panel) ? change(cell) : cell;
  return walk(tree) as Row;
}

/** The arrangement of some of its panels. Tab sets and rows that are left empty are gone; a row of one cell is that cell. */
export function pruned(tree: Row, shown: (panel: string) => boolean): Row {
  const walk = (cell: Cell): Cell[] => {
    if (cell.kind === "tabs") {
      const tabs = cell.tabs.filter(shown);
      if (tabs.length === 0) return [];
      return [{ ...cell, tabs, front: tabs.includes(cell.front) ? cell.front : tabs[0]! }];
    }
    return tidied({ ...cell, children: cell.children.flatMap(walk) });
  };
  return { ...tree, children: tree.children.flatMap(walk) };
}

const weightOf = (cells: readonly Cell[]) => cells.reduce((sum, { weight }) => sum + weight, 0);

/** A row without needless levels: nothing for an empty one; the cells of a row that is alone in it take its place. */
function tidied(row: Row): Cell[] {
  const [only] = row.children;
  if (!only) return [];
  if (row.children.length > 1) return [row];
  if (only.kind === "tabs") return [{ ...only, weight: row.weight }];
  const sum = weightOf(only.children) || 1;
  return only.children.map((cell) => ({ ...cell, weight: (row.weight * cell.weight) / sum }));
}

/**
 * Puts panels that are missing in `tree` where they are in `whole`: among the same tabs, or else beside the same neighbours.
 * Both may have been changed since they were one.
 */
export function restored(tree: Row, whole: Row, panels: readonly string[]): Row {
  return panels.reduce((now, panel) => {
    const home = tabSets(whole).find(({ tabs }) => tabs.includes(panel));
    if (!home || panelsIn(now).includes(panel)) return now;
    return tabSets(now).some(({ id }) => id === home.id) ? amongTabs(now, home, panel) : beside(now, whole, home, panel);
  }, tree);
}

function amongTabs(tree: Row, home: TabSet, panel: string): Row {
  const walk = (cell: Cell): Cell => {
    if (cell.kind === "row") return { ...cell, children: cell.children.map(walk) };
    if (cell.id !== home.id) return cell;
    const before = home.tabs.slice(0, home.tabs.indexOf(panel));
    const at = cell.tabs.findLastIndex((tab) => before.includes(tab)) + 1;
    return { ...cell, tabs: [...cell.tabs.slice(0, at), panel, ...cell.tabs.slice(at)] };
  };
  return walk(tree) as Row;
}

/** The way from the root to a tab set, the root first. */
function wayTo(cell: Cell, id: string): Cell[] {
  if (cell.id === id) return [cell];
  if (cell.kind === "tabs") return [];
  for (const child of cell.children) {
    const way = wayTo(child, id);
    if (way.length > 0) return [cell, ...way];
  }
  return [];
}

/** The smallest cell that holds all these tab sets, with the way to it. */
function smallest(tree: Row, ids: readonly string[]): Cell[] {
  const ways = ids.map((id) => wayTo(tree, id));
  const first = ways[0]!;
  const common = first.filter((cell, depth) => ways.every((way) => way[depth] === cell));
  return common.length > 0 ? common : [tree];
}

function beside(tree: Row, whole: Row, home: TabSet, panel: string): Row {
  const added: TabSet = { ...home, tabs: [panel], front: panel };
  delete added.maximised;
  const present = new Set(tabSets(tree).map(({ id }) => id));
  const way = wayTo(whole, home.id);
  // From the nearest row outwards: which of its other cells are still there?
  for (let depth = way.length - 2; depth >= 0; depth--) {
    const row = way[depth] as Row;
    const at = row.children.indexOf(way[depth + 1]!);
    const nearest = [...row.children.keys()].filter((one) => one !== at).sort((a, b) => Math.abs(a - at) - Math.abs(b - at));
    for (const one of nearest) {
      const ids = tabSets(row.children[one]!)
        .map(({ id }) => id)
        .filter((id) => present.has(id));
      if (ids.length === 0) continue;
      // Its other cells that are missing come later, and take their shares then.
      const there = row.children.filter((cell) => tabSets(cell).some(({ id }) => present.has(id)));
      const mine = row.children[at]!.weight;
      const share = mine / (mine + weightOf(there));
      return inserted(tree, smallest(tree, ids), { added, share, vertical: depth % 2 === 0, after: at > one });
    }
  }
  return { ...tree, children: [...tree.children, added] };
}

interface Insertion {
  added: TabSet;
  /** The part of the row that it takes. */
  share: number;
  vertical: boolean;
  after: boolean;
}

/** Puts a tab set beside the last cell of a way. */
function inserted(tree: Row, way: readonly Cell[], { added, share, vertical, after }: Insertion): Row {
  const anchor = way.at(-1)!;
  const part = Math.min(Math.max(share, 0.1), 0.8);
  const among = (cells: readonly Cell[], at: number): Cell[] => {
    const mine = { ...added, weight: (weightOf(cells) * part) / (1 - part) };
    return [...cells.slice(0, at), mine, ...cells.slice(at)];
  };
  const around = (weight: number, cell: Cell): Row => ({
    kind: "row",
    id: freshId(tree, `${added.id}-row`),
    weight,
    children: among([{ ...cell, weight: 100 }], after ? 1 : 0),
  });
  if (anchor === tree && !vertical) {
    const old: Row = { kind: "row", id: freshId(tree, `${added.id}-beside`), weight: 100, children: tree.children };
    return { ...tree, children: [around(100, old)] };
  }
  // Cells of a row at an even depth stand below each other; those of a row within it, side by side.
  const depth = way.length - 1;
  const walk = (cell: Cell): Cell => {
    if (cell === anchor) {
      if ((depth % 2 === 0) !== vertical) return cell;
      if (cell.kind === "row") return { ...cell, children: among(cell.children, after ? cell.children.length : 0) };
      return around(cell.weight, cell);
    }
    if (cell.kind === "tabs") return cell;
    const at = (depth % 2 === 0) === vertical ? -1 : cell.children.indexOf(anchor);
    return { ...cell, children: at < 0 ? cell.children.map(walk) : among(cell.children, at + (after ? 1 : 0)) };
  };
  return walk(tree) as Row;
}

function freshId(tree: Cell, wanted: string): string {
  const taken = new Set<string>();
  const walk = (cell: Cell) => {
    taken.add(cell.id);
    if (cell.kind === "row") cell.children.forEach(walk);
  };
  walk(tree);
  let id = wanted;
  for (let number = 2; taken.has(id); number++) id = `${wanted}-${number}`;
  return id;
}

/** An arrangement that was kept as JSON; null: it is none, or its drawing is gone. Unknown panels are left out. */
export function readTree(kept: unknown, known: (panel: string) => boolean): Row | null {
  const ids = new Set<string>();
  const panels = new Set<string>();
  const read = (one: unknown): Cell | null => {
    if (typeof one !== "object" || one === null) return null;
    const { kind, id, weight, tabs, front, maximised, children } = one as Record<string, unknown>;
    if (typeof id !== "string" || ids.has(id) || typeof weight !== "number" || !(weight > 0 && weight < 1e6)) return null;
    ids.add(id);
    if (kind === "row" && Array.isArray(children)) {
      const cells = children.map(read);
      return cells.includes(null) ? null : { kind, id, weight, children: cells as Cell[] };
    }
    if (kind !== "tabs" || !Array.isArray(tabs) || typeof front !== "string") return null;
    const mine = tabs.filter((tab): tab is string => typeof tab === "string" && known(tab) && !panels.has(tab));
    mine.forEach((tab) => panels.add(tab));
    return { kind, id, weight, tabs: mine, front, ...(maximised === true ? { maximised } : {}) };
  };
  const tree = read(kept);
  if (tree?.kind !== "row" || !panels.has("drawing")) return null;
  return pruned(tree, () => true);
}
