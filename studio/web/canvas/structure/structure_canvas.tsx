import {
  Background,
  BackgroundVariant,
  MiniMap,
  ReactFlow,
  ReactFlowProvider,
  useReactFlow,
  useStore as useFlow,
  type Connection,
  type Edge,
  type Node,
} from "@xyflow/react";
import { useMemo, useRef, useState, type CSSProperties, type MouseEvent } from "react";
import { useStudio, useStore } from "../../hooks/use";
import { useLens } from "../../hooks/use_lens";
import { behavioursAt } from "../../model/causes";
import { useComplaints, useStructure } from "../../hooks/use_structure";
import type { Box } from "../../model/net/geometry";
import { connectEdits } from "../../model/text/connect_edits";
import { bundleAt, bundlePath, isBundlePath } from "../../model/structure/bundles";
import {
  agentFilled,
  agentHead,
  detailAt,
  sizeOfFilled,
  structureStep,
  subsystemFilled,
  type Detail,
} from "../../model/structure/levels";
import { channelOf, channelPath, withoutIndex } from "../../model/structure/structure";
import { mostBundleLetters } from "../../model/structure/structure_graph";
import { leastPixels } from "../../model/structure/text_size";
import { ChainOverlay } from "./chain_overlay";
import { ChannelLayer, ChannelTip } from "./channel_layer";
import { nothing, useDrawn, type Drawn } from "./drawn_structure";
import { PathText } from "../path_text";
import { useFocusInSight } from "../drawing_focus";
import { ExportButtons } from "../export_button";
import { LayoutProblem } from "../layout_problem";
import { CanvasFoot } from "../canvas_foot";
import { Legend } from "../legend";
import { LensOverlay } from "../lens_overlay";
import { mapClass, MapToggle, useMap } from "./map_toggle";
import { useMoved } from "./moved_drawing";
import { measured } from "./measured_text";
import { useSteadyView } from "../steady_view";
import { selectionAt, StructureHands } from "./structure_hands";
import { useComeNear, useNearness, useWholeUntilMoved } from "./structure_view";
import { AgentNode, DeviceNode, SubsystemNode, SurroundingsContext, type Surroundings } from "./structure_nodes";

const nodeTypes = { agent: AgentNode, subsystem: SubsystemNode, device: DeviceNode };

const still = matchMedia("(prefers-reduced-motion: reduce)");

type Complaints = ReturnType<typeof useComplaints>;

function nodesOf({ structure, drawing }: Drawn, selected: string | null, complaints: Complaints): Node[] {
  const nodes: Node[] = [];
  const add = (id: string, type: string, zIndex: number, data: Node["data"]) => {
    const box = drawing.boxes.get(id);
    if (!box) return;
    const { x, y, width, height } = box;
    nodes.push({
      id,
      type,
      position: { x, y },
      width,
      height,
      measured: { width, height },
      draggable: false,
      connectable: true,
      selectable: false,
      focusable: false,
      style: { pointerEvents: "all" as const },
      zIndex,
      data,
    });
  };
  for (const agent of structure.agents) {
    add(agent.name, "agent", 0, { agent, selected: selected === agent.name, complaint: complaints.get(agent.name) });
    for (const subsystem of agent.subsystems) {
      add(subsystem.path, "subsystem", 3, { subsystem, selected, complaints, card: drawing.cards.get(subsystem.path) });
      add(`${subsystem.path}#device`, "device", 3, { subsystem, selected });
    }
  }
  return nodes;
}

const none: readonly Box[] = [];

/** The positions of the names of agents and subsystems: in the middle of boxes without other text. */
function namesOf({ structure, drawing }: Drawn, detail: Detail, zoom: number): Box[] {
  const middle = (box: Box, size: { width: number; height: number }): Box => ({
    x: box.x + (box.width - size.width) / 2,
    y: box.y + (box.height - size.height) / 2,
    ...size,
  });
  const head = (box: Box): Box => ({ ...box, height: agentHead });
  return structure.agents.flatMap((agent) => {
    const box = drawing.boxes.get(agent.name);
    if (!box) return [];
    if (detail === "agents") {
      const text = agentFilled(agent, box, zoom, measured);
      return text ? [middle(box, sizeOfFilled(text, "agent", zoom, measured))] : [];
    }
    const inside = agent.subsystems.flatMap((one) => {
      const own = drawing.boxes.get(one.path);
      if (!own) return [];
      const text = detail === "all" ? undefined : subsystemFilled(one, own, zoom, measured);
      return [text ? middle(own, sizeOfFilled(text, "subsystem", zoom, measured)) : head(own)];
    });
    return [head(box), ...inside];
  });
}

/** The element, or the line of a channel, at a click. */
const pathOf = (target: Element) =>
  target.closest("[data-path]")?.getAttribute("data-path") ?? target.closest("[data-reach]")?.getAttribute("data-reach") ?? null;

/** The wires between virtual receptors and effectors and their devices. */
function wiresOf({ structure, drawing }: Drawn): Edge[] {
  return structure.agents
    .flatMap(({ subsystems }) => subsystems)
    .filter(({ path }) => drawing.boxes.has(`${path}#device`))
    .map((one) => {
      const [source, target] = one.kind === "effector" ? [one.path, `${one.path}#device`] : [`${one.path}#device`, one.path];
      return {
        id: `${one.path}#wire`,
        source,
        target,
        sourceHandle: "device",
        targetHandle: "device",
        className: "device-wire",
        focusable: false,
        selectable: false,
        zIndex: 1,
      };
    });
}

/** The agents of the bundle, or of the channel, under the pointer. */
function endsOf({ structure }: Drawn, over: string | null): readonly string[] {
  if (over === null) return [];
  const channel = structure.channels.find(({ index }) => channelPath(index) === over);
  const path = channel ? bundlePath(channel) : isBundlePath(over) ? over : undefined;
  return path === undefined ? [] : (bundleAt(structure, path)?.agents ?? []);
}

/** Says that a layout is being computed, or that it failed. It waits a moment: most layouts are there at once. */
const Notice = ({ first, problem }: { first: boolean; problem: string }) => (
  <p className={`layout-notice${first ? " first" : ""}`} role="status">
    {problem ? `The drawing could not be laid out: ${problem}` : "Arranging the drawing…"}
  </p>
);

/** Agents in the form that robotics uses. Dragging from an output to an input makes a channel. */
export function StructureCanvas() {
  return (
    <ReactFlowProvider>
      <Drawing />
    </ReactFlowProvider>
  );
}

function Drawing() {
  const studio = useStudio();
  const structure = useStructure();
  const complaints = useComplaints(structure);
  const selected = useStore(studio.view, (view) => view.selected);
  const net = useStore(studio.draft.store, (draft) => draft.net);
  const lens = useLens(net);
  const { drawn: laidOut, busy, problem } = useDrawn(structure);
  const { drawing, move: moveBox, arrange } = useMoved(laidOut.drawing);
  const drawn = useMemo((): Drawn => (drawing === laidOut.drawing ? laidOut : { ...laidOut, drawing }), [laidOut, drawing]);
  const { levels } = drawn;
  const [over, setOver] = useState<string | null>(null);
  const nodes = useMemo(() => nodesOf(drawn, selected, complaints), [drawn, selected, complaints]);
  const whole = useMemo(() => {
    const { left = 0, top = 0, width, height } = drawing;
    return { x: left, y: top, width, height };
  }, [drawing]);
  useSteadyView(drawn === nothing ? undefined : whole);
  const moved = useRef(false);
  const comeNear = useComeNear(drawn, moved);
  useWholeUntilMoved(drawn, whole, comeNear, moved);
  useNearness(drawn, comeNear);
  const edges = useMemo(() => wiresOf(drawn), [drawn]);
  const stuck = useMemo(
    () => new Set((lens?.waits ?? []).flatMap(({ channel }) => channelOf(drawn.structure, channel)?.index ?? [])),
    [lens, drawn],
  );
  const surroundings = useMemo((): Surroundings => {
    const connected = drawn.structure.channels.flatMap(({ from, to }) => [withoutIndex(from), withoutIndex(to)]);
    const standstill = lens && behavioursAt(lens.atEnd);
    return { structure: drawn.structure, levels, connected: new Set(connected), ends: endsOf(drawn, over), standstill };
  }, [drawn, levels, over, lens]);
  const select = (path: string | null) => studio.choose(path, structure);
  const connect = ({ sourceHandle, targetHandle }: Connection) => {
    if (!sourceHandle || !targetHandle) return;
    void studio.change(connectEdits(structure, sourceHandle, targetHandle), (now) => ({
      selected: channelPath(now.channels.length - 1),
      panel: "inspect",
    }));
  };
  const flow = useReactFlow();
  const zoom = useFlow(({ transform }) => structureStep(transform[2]));
  const detail = detailAt(zoom, levels);
  // If subsystems are not drawn, their agent replaces them.
  const boxOf = (path: string) => drawing.boxes.get(detail === "agents" ? path.split(/[.[]/)[0]! : withoutIndex(path));
  const dragged = useRef(false);
  // The click that ends a drag does not select the element below it.
  const dragEnds = () => void setTimeout(() => (dragged.current = false), 0);
  const click = (event: MouseEvent) => dragged.current || select(selectionAt(event.target as Element));
  const doubleClick = (event: MouseEvent) => {
    const path = pathOf(event.target as Element);
    if (path !== null) comeNear(path);
  };
  const area = useRef<HTMLDivElement>(null);
  useFocusInSight(area, moved);
  const drag = () => {
    dragged.current = true;
    addEventListener("pointerup", dragEnds, { once: true });
  };
  const overview = () => {
    moved.current = false;
    void flow.fitBounds(whole, { duration: still.matches ? 0 : 350, padding: 0.03 });
  };
  const map = useMap(whole);
  const counts = zoom * mostBundleLetters >= leastPixels;
  return (
    <div className="canvas structure" data-testid="structure">
      <div className="breadcrumbs">
        <span className="crumb" aria-current="page">
          <PathText of={structure.system || "system"} />
        </span>
        <span className="layer-name">
          {detail === "all" ? "drag from an output to an input to connect them" : "double-click an agent to see what is in it"}
        </span>
        <span className="spring" />
        <button className="quiet" title="Show the whole system" onClick={overview}>
          Overview
        </button>
        <button className="quiet" onClick={() => void studio.elements.addAgent()}>
          Add agent
        </button>
        <ExportButtons name={structure.system} />
      </div>
      <LayoutProblem />
      <ChannelTip />
      <div
        className={`canvas-area detail-${detail}${counts ? "" : " no-counts"}`}
        aria-busy={busy}
        style={{ "--zoom": zoom } as CSSProperties}
        onClick={click}
        onDoubleClick={doubleClick}
        ref={area}
        tabIndex={-1}
      >
        <SurroundingsContext.Provider value={surroundings}>
          <ReactFlow
            nodes={nodes}
            edges={edges}
            nodeTypes={nodeTypes}
            // Moves that the page itself makes have no event.
            onMove={(event) => void (moved.current ||= event !== null)}
            onConnect={connect}
            onConnectStart={() => (dragged.current = true)}
            onConnectEnd={dragEnds}
            nodesDraggable={false}
            elementsSelectable={false}
            zoomOnDoubleClick={false}
            disableKeyboardA11y
            fitViewOptions={{ padding: 0.08, maxZoom: 1.1 }}
            minZoom={Math.max(0.02, levels.agents)}
            proOptions={{ hideAttribution: true }}
            connectionRadius={28}
          >
            <ChannelLayer
              structure={drawn.structure}
              drawing={drawing}
              look={{ selected, complaints, stuck, over, onOver: setOver }}
            />
            <ChainOverlay drawn={drawn} boxOf={boxOf} />
            <LensOverlay
              net={net}
              whole={whole}
              boxOf={boxOf}
              names={lens ? namesOf(drawn, detail, zoom) : none}
              version={drawing}
            />
            <Background variant={BackgroundVariant.Dots} gap={28} size={1} />
            {map.shown && (
              <MiniMap position="top-right" pannable zoomable nodeClassName={mapClass} ariaLabel="Map of the whole system" />
            )}
            <StructureHands
              structure={structure}
              area={area}
              boxes={drawing.boxes}
              move={(path, by, end) => {
                // The view stays while boxes move in it.
                moved.current = true;
                return moveBox(withoutIndex(path), by, end);
              }}
              arrange={arrange}
              onDrag={drag}
            />
          </ReactFlow>
        </SurroundingsContext.Provider>
        {(busy || problem) && <Notice first={drawn === nothing} problem={problem} />}
      </div>
      <CanvasFoot zoom="near and far">
        <Legend of="structure" />
        <MapToggle map={map} />
      </CanvasFoot>
    </div>
  );
}
