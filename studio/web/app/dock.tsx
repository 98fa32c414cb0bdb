import "flexlayout-react/style/light.css";
import { Actions, Layout, Model, type Action, type IJsonModel, type IJsonTabSetNode } from "flexlayout-react";
import { Suspense, useEffect, useMemo, useRef } from "react";
import { useStore, useStudio } from "../hooks/use";
import { tabSets, type Cell, type Row } from "../model/dock/dock_tree";
import { Boundary } from "../panels/boundary";
import { panelTable, type Panel } from "./panel_table";
import { useDockKeys } from "./dock_keys";

const panelOf = (name: string): Panel => panelTable.find((one) => one.name === name)!;

/** The panels around the drawing. The user moves them by their tabs, sizes them by the borders between them, and closes them. */
export function Dock() {
  const studio = useStudio();
  const shown = useStore(studio.dock.store, (all) => all.shown);
  useOffer();
  useWidth();
  useDockKeys();
  if (!shown) return <main className="dock" />;
  return (
    <main className="dock">
      <Arrangement shown={shown} />
    </main>
  );
}

function Arrangement({ shown }: { shown: Row }) {
  const studio = useStudio();
  // The library changes its model itself. A model of it that means the same as `shown` stays.
  const held = useRef<{ model: Model; tree: string } | null>(null);
  const model = useMemo(() => {
    const tree = JSON.stringify(shown);
    if (held.current?.tree !== tree) held.current = { model: Model.fromJson(toJson(shown), held.current?.model), tree };
    return held.current.model;
  }, [shown]);
  const changed = (now: Model, action: Action) => {
    if (action.isAdjusting()) return;
    const tree = fromJson(now.toJson());
    held.current = { model: now, tree: JSON.stringify(tree) };
    if (action.type === Actions.SELECT_TAB) studio.dock.choose(String(action.data.tabNode));
    studio.dock.arrange(tree);
  };
  return (
    <Layout
      model={model}
      factory={(node) => <Content panel={panelOf(node.getId())} />}
      onModelChange={changed}
      invalidateTabContentOnParentRender={false}
      i18nTranslator={(key) => words[key] ?? key}
    />
  );
}

/** Texts of the library in the words of this page. */
const words: Record<string, string> = {
  "flexlayout.ui.maximize.tabset": "Maximise (Alt Enter)",
  "flexlayout.ui.restore.tabset": "Back to its place (Alt Enter)",
  "flexlayout.ui.overflow.menu.tooltip": "More panels",
  "flexlayout.ui.splitter": "Border between panels",
};

/** A panel is drawn while it can be seen, unless it stays. */
function Content({ panel }: { panel: Panel }) {
  const studio = useStudio();
  const visible = useStore(studio.dock.store, ({ seen }) => seen.includes(panel.name));
  const unlabelled = useStore(studio.dock.store, ({ shown }) => shown !== null && hasNoTab(shown, panel.name));
  const Shown = panel.component;
  if (!visible && !panel.stays) return null;
  return (
    <Boundary>
      {/* The library names a panel after its tab. */}
      {unlabelled && (
        <span hidden id={`flexlayout-tabbutton-${panel.name}`}>
          {panel.title}
        </span>
      )}
      <Suspense fallback={<div className="pane-empty">Loading…</div>}>
        <Shown />
      </Suspense>
    </Boundary>
  );
}

/** Tells the dock which panels have something to show. */
function useOffer(): void {
  const studio = useStudio();
  // The table never changes, so the hooks are the same ones in each drawing.
  const has = panelTable.map(({ useContent }) => useContent?.() ?? true);
  const names = panelTable
    .filter((_, at) => has[at])
    .map(({ name }) => name)
    .join(" ");
  useEffect(() => studio.dock.offer(names.split(" ")), [studio, names]);
}

function useWidth(): void {
  const studio = useStudio();
  useEffect(() => {
    const tell = () => studio.dock.resized(innerWidth);
    addEventListener("resize", tell);
    return () => removeEventListener("resize", tell);
  }, [studio]);
}

/** The drawing alone needs no tab. */
const isAlone = ({ tabs }: { tabs: readonly string[] }) => tabs.length === 1 && tabs[0] === "drawing";
const hasNoTab = (tree: Row, name: string) => name === "drawing" && tabSets(tree).some(isAlone);

function toJson(tree: Row): IJsonModel {
  const cell = (one: Cell): IJsonModel["layout"]["children"] extends (infer C)[] | undefined ? C : never => {
    if (one.kind === "row") return { type: "row", id: one.id, weight: one.weight, children: one.children.map(cell) };
    const tabs: IJsonTabSetNode = {
      type: "tabset",
      id: one.id,
      weight: one.weight,
      name: one.tabs.map((name) => panelOf(name).title).join(", "),
      selected: Math.max(0, one.tabs.indexOf(one.front)),
      enableTabStrip: !isAlone(one),
      children: one.tabs.map((name) => ({
        type: "tab",
        component: name,
        id: name,
        name: panelOf(name).title,
        enableClose: name !== "drawing",
      })),
    };
    return one.maximised ? { ...tabs, maximized: true } : tabs;
  };
  return {
    global: {
      rootOrientationVertical: true,
      tabEnableRename: false,
      tabEnableScrollbars: false,
      tabSetEnableTabWrap: true,
      tabSetEnableTabGroups: false,
      tabSetMinWidth: 120,
      tabSetMinHeight: 90,
      tabSetEnableActiveIcon: false,
    },
    borders: [],
    layout: { type: "row", id: tree.id, weight: 100, children: tree.children.map(cell) },
  };
}

function fromJson({ layout }: IJsonModel): Row {
  const cell = (one: IJsonModel["layout"] | IJsonTabSetNode): Cell => {
    const { id = "", weight = 100 } = one;
    if (one.type !== "tabset")
      return { kind: "row", id, weight, children: ((one.children ?? []) as IJsonTabSetNode[]).map(cell) };
    const { selected = 0, children = [], maximized } = one as IJsonTabSetNode;
    const tabs = children.map((tab) => String(tab.id));
    return { kind: "tabs", id, weight, tabs, front: tabs[selected] ?? tabs[0] ?? "", ...(maximized ? { maximised: true } : {}) };
  };
  return cell(layout) as Row;
}
