import {
  Background,
  BackgroundVariant,
  Controls,
  ReactFlow,
  ReactFlowProvider,
  useReactFlow,
  useStore as useFlow,
  type ReactFlowState,
} from "@xyflow/react";
import { useEffect, useMemo, useRef, useState, type KeyboardEvent, type MouseEvent } from "react";
import { useStore, useStudio } from "../app/use";
import { stuck } from "../live/verifier";
import { flagsOf } from "../model/flags";
import { spoken } from "../model/labels";
import type { NetModel } from "../model/net";
import { neighbour, type Direction } from "../model/neighbour";
import { Sheets, type Placed } from "../model/sheets";
import type { Box } from "../model/geometry";
import { Breadcrumbs } from "./breadcrumbs";
import { elk } from "./elk";
import { SheetNodeView, type SheetNode } from "./sheet_node";
import { useSteadyView } from "./steady_view";
import { ArrowTips } from "./symbols";

const nodeTypes = { sheet: SheetNodeView };
/** Pages with more children than this open with them folded. */
const many = 24;
const still = matchMedia("(prefers-reduced-motion: reduce)");

export function NetCanvas({ net }: { net: NetModel }) {
  return (
    <ReactFlowProvider>
      <Drawing net={net} />
    </ReactFlowProvider>
  );
}

const windowOf = (state: ReactFlowState) => [...state.transform, state.width, state.height].join();

/** The sheets of the net; the drawing is asked to look again when one arrives. */
function useSheets(net: NetModel): { sheets: Sheets; version: number } {
  const studio = useStudio();
  const folds = useStore(studio.view, (view) => view.folds);
  const [version, setVersion] = useState(0);
  const before = useRef<Sheets | undefined>(undefined);
  const sheets = useMemo(() => {
    const crowded = net.pages.map((_, index) => net.children(index).length > many);
    const folded = (page: number) => folds.get(net.page(page).path) ?? crowded[net.page(page).parent ?? 0]!;
    return (before.current = new Sheets(net, folded, elk, () => setVersion((at) => at + 1), before.current));
  }, [net, folds]);
  return { sheets, version };
}

/** Flies to where a request leads, as soon as the sheets on the way are there; what is folded on the way is opened. */
function useFlight(sheets: Sheets, version: number): void {
  const studio = useStudio();
  const flow = useReactFlow();
  const flight = useStore(studio.view, (view) => view.flight);
  const done = useRef(0);
  useEffect(() => {
    const element = flight && sheets.net.find(flight.path);
    if (!flight || !element || flight.request === done.current) return;
    const closed = sheets.net.ancestry(element.page).filter((page) => page !== 0 && sheets.folded(page));
    if (closed.length > 0)
      return studio.foldMany(
        closed.map((page) => sheets.net.page(page).path),
        false,
      );
    const box = sheets.boxOf(flight.path);
    if (!box) return;
    done.current = flight.request;
    const open = element.kind === "page" && (element.index < 0 || !sheets.folded(sheets.net.pageByPath.get(flight.path)!));
    void flow.fitBounds(open ? box : wider(box, 9), { duration: still.matches ? 0 : 350, padding: 0.06 });
  }, [flight, sheets, version, flow, studio]);
}

const wider = (box: Box, times: number): Box => {
  const size = Math.max(box.width, box.height) * times;
  return { x: box.x + box.width / 2 - size / 2, y: box.y + box.height / 2 - size / 2, width: size, height: size };
};

function Drawing({ net }: { net: NetModel }) {
  const studio = useStudio();
  const flow = useReactFlow();
  const { sheets, version } = useSheets(net);
  const [x, y, zoom, width, height] = useFlow(windowOf).split(",").map(Number) as [number, number, number, number, number];
  const selected = useStore(studio.view, (view) => view.selected);
  const diagnostics = useStore(studio.draft.store, (draft) => draft.diagnostics);
  const verified = useStore(studio.verifier.store, (all) => all);
  const flags = useMemo(() => {
    const marked = flagsOf(net, diagnostics);
    if (verified.net === net) for (const path of stuck(verified.verdicts)) marked.set(path, "error");
    return marked;
  }, [net, diagnostics, verified]);
  useFlight(sheets, version);
  const shown = useFirstView(sheets, version, width);
  const visible = useMemo(
    () => (shown ? sheets.visible({ x: -x / zoom, y: -y / zoom, width: width / zoom, height: height / zoom, zoom }) : []),
    [sheets, version, shown, x, y, zoom, width, height],
  );
  const nodes = useNodes(net, sheets, visible, zoom, selected, flags);
  const current = currentPage(visible, { x: -x / zoom, y: -y / zoom, width: width / zoom, height: height / zoom });
  const root = sheets.placed(0)?.sheet;
  useSteadyView(useMemo(() => root && { x: 0, y: 0, width: root.width, height: root.height }, [root]));

  const pathAt = (event: MouseEvent) => (event.target as Element).closest("[data-path]")?.getAttribute("data-path") ?? null;
  const click = (event: MouseEvent) => {
    const path = pathAt(event);
    const transition = path === null ? undefined : net.transitionByName.get(path);
    if (studio.stage.mode === "game" && transition !== undefined) studio.play.choose(transition);
    studio.select(path);
  };
  const doubleClick = (event: MouseEvent) => {
    const path = pathAt(event);
    if (path === null) return;
    const page = net.pageByPath.get(path);
    if (page !== undefined && sheets.folded(page)) studio.fold(path, false);
    else studio.fly(path);
  };
  const keys = (event: KeyboardEvent) => {
    if (canvasKey(event, { net, sheets, visible, selected, current, studio, flow })) event.preventDefault();
  };
  return (
    <div className="canvas" data-testid="canvas">
      <ArrowTips />
      <Breadcrumbs net={net} page={current} />
      <div
        className="canvas-area"
        role="application"
        aria-label="Drawing of the net. Arrow keys move, Enter opens, Escape goes up, F folds."
        tabIndex={0}
        onClick={click}
        onDoubleClick={doubleClick}
        onKeyDown={keys}
      >
        <ReactFlow<SheetNode>
          nodes={nodes}
          edges={noEdges}
          nodeTypes={nodeTypes}
          minZoom={0.02}
          maxZoom={60}
          nodesDraggable={false}
          nodesConnectable={false}
          nodesFocusable={false}
          elementsSelectable={false}
          zoomOnDoubleClick={false}
          disableKeyboardA11y
          proOptions={{ hideAttribution: true }}
        >
          <Background variant={BackgroundVariant.Dots} gap={28} size={1} />
          <Controls showInteractive={false} position="bottom-right" />
        </ReactFlow>
      </div>
      <div className="visually-hidden" aria-live="polite">
        {selected === null ? "" : spoken(net, selected)}
      </div>
    </div>
  );
}

const noEdges: never[] = [];

function useNodes(
  net: NetModel,
  sheets: Sheets,
  visible: Placed[],
  zoom: number,
  selected: string | null,
  flags: ReadonlyMap<string, "error" | "warning">,
): SheetNode[] {
  const before = useRef(new Map<number, SheetNode>());
  return useMemo(() => {
    const shown = new Set(visible.map((placed) => placed.page));
    const next = new Map<number, SheetNode>();
    for (const placed of visible) {
      const children = net.children(placed.page);
      const open = children.filter((child) => shown.has(child)).join();
      const folded = children.filter((child) => sheets.folded(child)).join();
      const mine = selected !== null && isOn(net, placed.page, selected) ? selected : null;
      const near = Math.min(5, Math.max(-3, Math.floor(Math.log2((placed.scale * zoom) / 0.95))));
      const data = { net, placed, open, folded, near, selected: mine, flags };
      const old = before.current.get(placed.page);
      next.set(placed.page, old && alike(old, data) ? old : sheetNode(data));
    }
    before.current = next;
    return [...next.values()];
  }, [net, sheets, visible, zoom, selected, flags]);
}

const isOn = (net: NetModel, page: number, path: string) => path.startsWith(net.page(page).path) || net.placeByName.has(path);

function alike(node: SheetNode, data: SheetNode["data"]): boolean {
  const old = node.data;
  return (
    old.net === data.net &&
    old.open === data.open &&
    old.folded === data.folded &&
    old.near === data.near &&
    old.selected === data.selected &&
    old.flags === data.flags &&
    old.placed.sheet === data.placed.sheet &&
    node.position.x === data.placed.x &&
    node.position.y === data.placed.y &&
    old.placed.scale === data.placed.scale
  );
}

function sheetNode(data: SheetNode["data"]): SheetNode {
  const { page, x, y, sheet, scale } = data.placed;
  const size = { width: sheet.width * scale, height: sheet.height * scale };
  return {
    id: String(page),
    type: "sheet",
    position: { x, y },
    ...size,
    measured: size,
    data,
    zIndex: data.net.ancestry(page).length,
    style: { pointerEvents: "none" },
  };
}

/** The page one looks at: the outermost in the middle of the window that can be seen as a whole, or else the innermost there. */
function currentPage(visible: Placed[], window: Box): number {
  const [cx, cy] = [window.x + window.width / 2, window.y + window.height / 2];
  let current = 0;
  for (const { page, sheet, x, y, scale } of visible) {
    const [width, height] = [sheet.width * scale, sheet.height * scale];
    if (cx < x || cx > x + width || cy < y || cy > y + height) continue;
    if (page !== 0 && width < 0.3 * window.width && height < 0.3 * window.height) continue;
    current = page;
    const whole =
      x >= window.x && y >= window.y && x + width <= window.x + window.width && y + height <= window.y + window.height;
    if (whole) break;
  }
  return current;
}

/** Shows the whole drawing once, when it is there; before that nothing is drawn, for it would be drawn twice. */
function useFirstView(sheets: Sheets, version: number, width: number): boolean {
  const flow = useReactFlow();
  const asked = useRef(false);
  const [shown, setShown] = useState(false);
  useEffect(() => {
    const root = sheets.placed(0);
    if (asked.current || !root || width === 0) return;
    asked.current = true;
    const whole = { x: 0, y: 0, width: root.sheet.width, height: root.sheet.height };
    void flow.fitBounds(whole, { duration: 0, padding: 0.03 }).then(() => setShown(true));
  }, [sheets, version, width, flow]);
  return shown;
}

interface KeyContext {
  net: NetModel;
  sheets: Sheets;
  visible: Placed[];
  selected: string | null;
  current: number;
  studio: ReturnType<typeof useStudio>;
  flow: ReturnType<typeof useReactFlow>;
}

const directions: Record<string, Direction> = { ArrowLeft: "left", ArrowRight: "right", ArrowUp: "up", ArrowDown: "down" };

function canvasKey(event: KeyboardEvent, context: KeyContext): boolean {
  const { net, sheets, selected, current, studio, flow } = context;
  // Keys of the browser, and of the buttons within the drawing, stay theirs.
  if (event.ctrlKey || event.metaKey || event.altKey || event.target instanceof HTMLButtonElement) return false;
  const direction = directions[event.key];
  if (direction) {
    const on = selected === null ? current : net.find(selected)!.page;
    const next = neighbour(net, sheets, on, selected, direction);
    if (next !== null) studio.select(next);
    return true;
  }
  const page = selected === null ? undefined : net.pageByPath.get(selected);
  switch (event.key) {
    case "Enter":
    case " ": {
      const transition = selected === null ? undefined : net.transitionByName.get(selected);
      if (transition !== undefined && studio.stage.mode === "game") return studio.play.choose(transition);
      if (page === undefined) return false;
      if (sheets.folded(page)) studio.fold(selected!, false);
      studio.fly(selected!);
      const first = net.elementsOf(page)[net.page(page).input];
      if (first && !sheets.folded(page)) studio.select(first.path);
      return true;
    }
    case "Escape":
    case "Backspace": {
      const up = net.page(current).parent ?? 0;
      studio.select(current === 0 ? null : net.page(current).path);
      studio.fly(net.page(up).path);
      return true;
    }
    case "f":
      if (page === undefined) return false;
      studio.fold(selected!, !sheets.folded(page));
      return true;
    case "+":
    case "=":
      void flow.zoomIn();
      return true;
    case "-":
      void flow.zoomOut();
      return true;
    case "0":
      studio.fly("");
      return true;
    default:
      return false;
  }
}
