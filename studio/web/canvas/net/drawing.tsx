import { Background, BackgroundVariant, ReactFlow, useReactFlow, useStore as useFlow, type ReactFlowState } from "@xyflow/react";
import {
  useEffect,
  useMemo,
  useRef,
  type CSSProperties,
  type KeyboardEvent,
  type MouseEvent,
  type PointerEvent,
  type ReactNode,
} from "react";
import { useStore, useStudio } from "../../hooks/use";
import { useLens } from "../../hooks/use_lens";
import type { Pane } from "../../live/scene";
import { stuck } from "../../live/verifier";
import { flagsOf } from "../../model/flags";
import { header, textWidth, type Box } from "../../model/net/geometry";
import { help } from "../../model/help";
import { elementAt } from "../../model/net/hit";
import type { NetModel } from "../../model/net/net";
import type { Placed, Sheets } from "../../model/net/sheets";
import { canvasKey } from "./canvas_keys";
import { currentPage } from "./current_page";
import { steps } from "../detail";
import { CanvasFoot } from "../canvas_foot";
import { Legend } from "../legend";
import { LensOverlay } from "../lens_overlay";
import { useFlight } from "../flight";
import { NetLayer } from "./painted/net_layer";
import { elementsIn, usePainted } from "./painted/use_painted";
import { painted as paintedMark } from "./painted/vectors";
import { SheetNodeView, type SheetNode } from "./sheet_node";
import { useNodes } from "./sheet_nodes";
import { useSharedView } from "../shared_view";
import { useSteadyView } from "../steady_view";

const nodeTypes = { sheet: SheetNodeView };
const noEdges: never[] = [];
const noSheets: Placed[] = [];
const windowOf = (state: ReactFlowState) => [...state.transform, state.width, state.height].join();

interface DrawingProps {
  pane: Pane;
  net: NetModel;
  sheets: Sheets;
  /** Grows when a sheet has arrived. */
  version: number;
  /** The other panes follow this one. */
  lead: boolean;
  label: string;
  legend: ReactNode;
  /** Receives the current page. */
  onCurrent: (page: number) => void;
}

/** A net in one pane: its visible part, with the tokens of the pane's stage. */
export function Drawing({ pane, net, sheets, version, lead, label, legend, onCurrent }: DrawingProps) {
  const studio = useStudio();
  const flow = useReactFlow();
  const { stage } = pane;
  const [x, y, zoom, width, height] = useFlow(windowOf).split(",").map(Number) as [number, number, number, number, number];
  const selected = useStore(studio.view, (view) => view.selected);
  const flags = useFlags(net);
  useFlight(sheets, version, lead);
  const root = sheets.placed(0)?.sheet;
  const shown = useSharedView(root);
  const window = useMemo(
    () => ({ x: -x / zoom, y: -y / zoom, width: width / zoom, height: height / zoom, zoom }),
    [x, y, zoom, width, height],
  );
  const visible = useMemo(() => (shown ? sheets.visible(window) : []), [sheets, version, shown, window]);
  const painted = usePainted(
    useMemo(() => elementsIn(visible, window), [visible, window]),
    window,
  );
  const nodes = useNodes(net, sheets, painted ? noSheets : visible, window, selected, flags, stage);
  const scene = useMemo(
    () => ({ net, folded: sheets.folded, visible, selected, flags }),
    [net, sheets, visible, selected, flags],
  );
  const current = currentPage(visible, window);
  useEffect(() => (lead ? onCurrent(current) : undefined), [lead, current, onCurrent]);
  useSteadyView(
    useMemo(() => root && { x: 0, y: 0, width: root.width, height: root.height }, [root]),
    lead,
  );

  const lens = useLens(net);
  const boxOf = (path: string) => {
    const page = net.pageByPath.get(path);
    const hidden = page === undefined || net.ancestry(page).some((at) => at !== 0 && at !== page && sheets.folded(at));
    return hidden ? undefined : sheets.boxOf(path);
  };
  useEffect(() => {
    if (!lead || !lens) return;
    const pages = lens.concerned.flatMap((path) => net.pageByPath.get(path) ?? []);
    const closed = pages.flatMap((page) => net.ancestry(page)).filter((page) => page !== 0 && sheets.folded(page));
    const agents = closed.filter((page) => !pages.includes(page)).map((page) => net.page(page).path);
    if (agents.length > 0) studio.foldMany(agents, false);
  }, [lens, lead, net, sheets, studio]);

  const pathAt = (event: MouseEvent) => {
    const target = event.target as Element;
    if (!painted || !target.closest(".react-flow__pane")) return target.closest("[data-path]")?.getAttribute("data-path") ?? null;
    const at = flow.screenToFlowPosition({ x: event.clientX, y: event.clientY }, { snapToGrid: false });
    return elementAt(net, sheets.folded, visible, at);
  };
  // The view may move between the two clicks of a double click; the first one
  // decides which element is meant.
  const first = useRef<string | null>(null);
  const click = (event: MouseEvent) => {
    const path = pathAt(event);
    if (event.detail <= 1) first.current = path;
    const transition = path === null ? undefined : net.transitionByName.get(path);
    if (stage.mode === "game" && transition !== undefined) studio.play.choose(transition);
    studio.select(path);
  };
  const pointed = useRef<string | null>(null);
  const point = (event: PointerEvent<HTMLElement>) => {
    if (event.buttons !== 0) return;
    const path = pathAt(event);
    const area = event.currentTarget;
    area.classList.toggle("on-element", painted && path !== null);
    if (path === pointed.current) return;
    pointed.current = path;
    area.title = path === null ? "" : help(net, path);
  };
  const doubleClick = () => {
    const path = first.current;
    if (path === null) return;
    const page = net.pageByPath.get(path);
    if (page !== undefined && sheets.folded(page)) studio.fold(path, false);
    else studio.fly(path);
  };
  const keys = (event: KeyboardEvent) => {
    if (canvasKey(event, { net, sheets, selected, current, studio, stage, flow })) event.preventDefault();
  };
  return (
    <>
      <div
        className="canvas-area"
        role="application"
        aria-label={`${label}. Arrow keys move, Enter opens, Escape goes up, F folds.`}
        tabIndex={0}
        style={{ "--zoom": steps(zoom) } as CSSProperties}
        {...(painted ? { [paintedMark]: "" } : {})}
        onPointerOver={point}
        onPointerMove={painted ? point : undefined}
        onClick={click}
        onDoubleClick={doubleClick}
        onKeyDown={keys}
      >
        <ReactFlow<SheetNode>
          id={lead ? "net" : "net-beside"}
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
          {painted && <NetLayer scene={scene} window={window} stage={stage} />}
          <Background variant={BackgroundVariant.Dots} gap={28} size={1} />
          {root && (
            <LensOverlay
              net={net}
              whole={{ x: 0, y: 0, width: root.width, height: root.height }}
              boxOf={boxOf}
              names={lens ? namesOf(net, sheets) : []}
              version={sheets}
            />
          )}
        </ReactFlow>
      </div>
      <CanvasFoot zoom={lead ? "near, far and whole" : "none"}>
        {lead && <Legend of="net" />}
        {legend}
      </CanvasFoot>
    </>
  );
}

/** The positions of the names of agents: above their nets, in up to 1.6 times their size. */
function namesOf(net: NetModel, sheets: Sheets): Box[] {
  return net.children(0).flatMap((page) => {
    const { path, name } = net.page(page);
    const box = sheets.boxOf(path);
    return box ? [{ x: box.x, y: box.y, width: Math.min(box.width, 14 + textWidth(name, 20)), height: header }] : [];
  });
}

/** The complaints about the text or of a verification, by path. */
function useFlags(net: NetModel): ReadonlyMap<string, "error" | "warning"> {
  const studio = useStudio();
  const diagnostics = useStore(studio.draft.store, (draft) => draft.diagnostics);
  const verified = useStore(studio.verifier.store, (all) => all);
  return useMemo(() => {
    const marked = flagsOf(net, diagnostics);
    if (verified.net === net) for (const path of stuck(verified.verdicts)) marked.set(path, "error");
    return marked;
  }, [net, diagnostics, verified]);
}
