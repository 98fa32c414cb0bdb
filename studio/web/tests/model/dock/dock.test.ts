import { expect, test } from "vitest";
import { Dock } from "../../../live/dock/dock";
import { followDock } from "../../../live/dock/dock_view";
import { Store } from "../../../live/store";
import { panelsIn, pruned, readTree, restored, seenIn, tabSets, type Cell, type Row } from "../../../model/dock/dock_tree";
import { layoutNames, readyLayout, type Places } from "../../../model/dock/ready_layouts";
import type { ViewState } from "../../../model/view_state";

const at = (name: string, slot: Places["edit"], more: Partial<Places> = {}): Places => ({
  ...{ name, title: name, edit: slot, debug: slot, operate: slot },
  ...more,
});
const panels: Places[] = [
  at("drawing", "centre"),
  at("text", "left", { closed: ["operate"] }),
  at("inspect", "right"),
  at("run", "right"),
  at("timeline", "below"),
  at("values", "middle"),
  at("world", "end"),
];
const idle = ["drawing", "text", "inspect", "run"];
const all = panels.map(({ name }) => name);

class Kept {
  readonly items = new Map<string, string>();
  getItem = (key: string) => this.items.get(key) ?? null;
  setItem = (key: string, value: string) => void this.items.set(key, value);
}

function opened(storage = new Kept(), available = idle, width = 1440): Dock {
  const dock = new Dock(storage);
  dock.offer(available);
  dock.choose("inspect");
  dock.begin("robot", panels, width);
  return dock;
}
const shownIn = (dock: Dock) => panelsIn(dock.store.get().shown!).sort();
const byId = (cell: Cell, id: string) => tabSets(cell).find((one) => one.id === id)!;

test("every ready layout has every panel once, at every width", () => {
  for (const layout of layoutNames)
    for (const width of [640, 1024, 1440]) expect(panelsIn(readyLayout(layout, panels, width)).sort()).toEqual([...all].sort());
});

test("a narrow window has the drawing above a stack of tabs", () => {
  const sets = tabSets(readyLayout("debug", panels, 640));
  expect(sets.map(({ tabs }) => tabs[0])).toEqual(["drawing", "text"]);
  expect(sets[1]!.front).toBe("run");
});

test("a window of medium width has two columns, with the text below the drawing", () => {
  const [top] = readyLayout("edit", panels, 1024).children;
  expect(top).toMatchObject({
    children: [
      { kind: "row", children: [{ tabs: ["drawing"] }, { tabs: ["text", "timeline"] }] },
      { kind: "row", children: [{ tabs: ["inspect", "run"] }, { tabs: ["values", "world"] }] },
    ],
  });
});

test("panels that go and come back keep their shares, however often the user chooses a tab meanwhile", () => {
  const shares = (cell: Cell): string[] => {
    if (cell.kind === "tabs") return [];
    const sum = cell.children.reduce((all, { weight }) => all + weight, 0);
    const mine = cell.children.map(({ weight }) => Math.round((100 * weight) / sum)).join();
    return [mine, ...cell.children.flatMap(shares)];
  };
  const dock = opened(new Kept(), all);
  const before = shares(dock.store.get().shown!);
  for (let run = 0; run < 4; run += 1) {
    dock.offer(idle);
    dock.arrange(dock.store.get().shown!);
    dock.offer(all);
    dock.arrange(dock.store.get().shown!);
  }
  expect(shares(dock.store.get().shown!)).toEqual(before);
});

test("a panel without content takes no room, and comes back to its place", () => {
  const dock = opened();
  expect(shownIn(dock)).toEqual([...idle].sort());
  const before = dock.store.get().shown;
  dock.offer(all);
  expect(shownIn(dock)).toEqual([...all].sort());
  dock.offer(idle);
  expect(dock.store.get().shown).toEqual(before);
});

test("what is restored is where it was: pruning and restoring change nothing", () => {
  for (const layout of layoutNames) {
    const whole = readyLayout(layout, panels, 1440);
    for (const name of all.filter((one) => one !== "drawing")) {
      const without = pruned(whole, (panel) => panel !== name);
      const again = restored(without, whole, [name]);
      const shape = (tree: Row) => tabSets(tree).map(({ id, tabs }) => `${id}: ${tabs.join()}`);
      expect(shape(again), `${layout} ${name}`).toEqual(shape(whole));
    }
  }
});

test("a rearrangement during a run is kept when the run is gone, and comes back with the next one", () => {
  const storage = new Kept();
  const dock = opened(storage, all);
  const { shown } = dock.store.get();
  // The world goes to the tabs of the text.
  const walk = (cell: Cell): Cell =>
    cell.kind === "row"
      ? { ...cell, children: cell.children.map(walk) }
      : { ...cell, tabs: cell.id === "left" ? ["text", "world"] : cell.tabs.filter((name) => name !== "world") };
  dock.arrange(pruned(walk(shown!) as Row, () => true));
  dock.offer(idle);
  dock.offer(all);
  expect(byId(dock.store.get().shown!, "left").tabs).toEqual(["text", "world"]);
  expect(byId(opened(storage, all).store.get().shown!, "left").tabs).toEqual(["text", "world"]);
});

test("a closed panel stays closed after a reload, and opens in its place, in front", () => {
  const storage = new Kept();
  const dock = opened(storage);
  dock.close("run");
  dock.close("drawing");
  const again = opened(storage);
  expect(shownIn(again)).toEqual(["drawing", "inspect", "text"]);
  again.open("run");
  expect(byId(again.store.get().shown!, "right")).toMatchObject({ tabs: ["inspect", "run"], front: "run" });
});

test("a maximised panel is the only one that is seen, until another one is asked for", () => {
  const dock = opened();
  dock.maximise("text");
  expect(dock.store.get().seen).toEqual(["text"]);
  dock.open("run");
  expect(dock.store.get().seen).toEqual(["text", "drawing", "run"]);
  dock.maximise("drawing");
  dock.maximise("drawing");
  expect(seenIn(dock.store.get().shown!)).toHaveLength(3);
});

test("a broken layout that was kept gives the ready one, and never a blank page", () => {
  const ready = opened().store.get().shown;
  const whole = readyLayout("edit", panels, 1440);
  const twice = { ...whole, children: [...whole.children, whole.children[0]] };
  const noDrawing = pruned(whole, (name) => name !== "drawing");
  const trees = [
    null,
    7,
    "x",
    {},
    [],
    { kind: "row" },
    { ...whole, weight: NaN },
    twice,
    noDrawing,
    { ...whole, children: [null] },
  ];
  const texts = [
    "",
    "{",
    "null",
    "7",
    '"x"',
    "[]",
    '{"layout":"moon"}',
    '{"layouts":7}',
    ...trees.map((tree) => JSON.stringify({ layout: "edit", layouts: { "edit wide": { tree, closed: [] } } })),
    JSON.stringify({ layouts: { "edit wide": { tree: whole, closed: 5 } } }),
    JSON.stringify({ layouts: { "edit wide": null } }),
  ];
  for (const text of texts) {
    const storage = new Kept();
    storage.setItem("tessera.panels robot", text);
    expect(opened(storage).store.get().shown, text).toEqual(ready);
  }
});

test("a panel that is unknown now is left out, and one that is new gets its ready place", () => {
  const older = readyLayout("edit", panels.filter(({ name }) => name !== "run").concat(at("gone", "right")), 1440);
  const storage = new Kept();
  storage.setItem("tessera.panels robot", JSON.stringify({ layouts: { "edit wide": { tree: older, closed: [] } } }));
  expect(byId(opened(storage).store.get().shown!, "right").tabs).toEqual(["inspect", "run"]);
  expect(readTree(older, (name) => name === "drawing")).toMatchObject({ children: [{ tabs: ["drawing"] }] });
});

test("a browser that keeps nothing shows the ready layout", () => {
  const full = new Dock({
    getItem: () => {
      throw new Error("denied");
    },
    setItem: () => {
      throw new Error("full");
    },
  });
  full.offer(idle);
  full.begin("robot", panels, 1440);
  full.close("text");
  expect(shownIn(full)).toEqual(["drawing", "inspect", "run"]);
  full.reset();
  expect(shownIn(full)).toEqual([...idle].sort());
});

test("the address and the button of the text follow the panels, and lead them", () => {
  const dock = opened(new Kept(), idle);
  const view = new Store({ panel: "inspect", text: true } as ViewState);
  followDock(view, dock);
  view.set({ panel: "run" });
  expect(dock.store.get().seen).toContain("run");
  view.set({ text: false });
  expect(dock.store.get().open).not.toContain("text");
  dock.open("text");
  expect(view.get()).toMatchObject({ panel: "text", text: true });
  view.set({ panel: "run" });
  dock.close("run");
  expect(view.get().panel).toBe("inspect");
});
