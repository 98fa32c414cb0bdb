import {
  Background,
  BackgroundVariant,
  Controls,
  ReactFlow,
  ReactFlowProvider,
  type Connection,
  type Edge,
  type Node,
} from "@xyflow/react";
import { useMemo, useRef, type KeyboardEvent, type MouseEvent } from "react";
import { useStudio, useStore } from "../hooks/use";
import { useComplaints, useStructure } from "../hooks/use_structure";
import { addAgent, addChannel, freeName, removeChannel } from "../model/edits";
import type { Box } from "../model/geometry";
import { channelPath, findThing, withoutIndex, type Structure } from "../model/structure";
import { channelLabels } from "../model/channel_labels";
import { lanes, layoutStructure } from "../model/structure_layout";
import { ChannelEdge, ChannelTip } from "./channel_edge";
import { ExportButtons } from "./export_button";
import { useSteadyView } from "./steady_view";
import { AgentNode, DeviceNode, SubsystemNode } from "./structure_nodes";

const nodeTypes = { agent: AgentNode, subsystem: SubsystemNode, device: DeviceNode };
const edgeTypes = { channel: ChannelEdge };

type Complaints = ReturnType<typeof useComplaints>;

function nodesOf(structure: Structure, selected: string | null, complaints: Complaints): Node[] {
  const nodes: Node[] = [];
  for (const box of layoutStructure(structure)) {
    const common = {
      draggable: false,
      connectable: true,
      selectable: false,
      focusable: false,
      style: { pointerEvents: "all" as const },
    };
    const sized = (one: { x: number; y: number; width: number; height: number }) => ({
      position: { x: one.x, y: one.y },
      width: one.width,
      height: one.height,
      measured: { width: one.width, height: one.height },
    });
    const agent = structure.agents.find((one) => one.name === box.path)!;
    nodes.push({
      id: box.path,
      type: "agent",
      ...sized(box),
      ...common,
      zIndex: 0,
      data: { agent, selected: selected === box.path, complaint: complaints.get(box.path) },
    });
    for (const inner of box.subsystems) {
      const subsystem = agent.subsystems.find((one) => one.path === inner.path)!;
      nodes.push({
        id: inner.path,
        type: "subsystem",
        ...sized(inner),
        ...common,
        zIndex: 2,
        data: { subsystem, selected, complaints },
      });
    }
    for (const device of box.devices) {
      const subsystem = agent.subsystems.find((one) => one.path === device.of)!;
      nodes.push({ id: device.path, type: "device", ...sized(device), ...common, zIndex: 2, data: { subsystem, selected } });
    }
  }
  return nodes;
}

function boxAround(nodes: Node[]): Box | undefined {
  if (nodes.length === 0) return undefined;
  const right = Math.max(...nodes.map((one) => one.position.x + (one.width ?? 0)));
  const bottom = Math.max(...nodes.map((one) => one.position.y + (one.height ?? 0)));
  return { x: 0, y: 0, width: right, height: bottom };
}

function edgesOf(structure: Structure, selected: string | null, complaints: Complaints): Edge[] {
  const edges: Edge[] = [];
  const boxes = layoutStructure(structure);
  const heights = lanes(structure, boxes);
  const labels = channelLabels(structure, boxes, heights);
  for (const channel of structure.channels) {
    const ends = [channel.from, channel.to].map((end) => findThing(structure, end));
    if (ends.some((end) => end?.kind !== "buffer")) continue;
    const [from, to] = [withoutIndex(channel.from), withoutIndex(channel.to)];
    const id = channelPath(channel.index);
    edges.push({
      id,
      type: "channel",
      source: from.slice(0, from.lastIndexOf(".")),
      sourceHandle: from,
      target: to.slice(0, to.lastIndexOf(".")),
      targetHandle: to,
      data: {
        channel,
        selected: selected === id,
        complaint: complaints.get(id)?.severity,
        lane: heights.get(channel.index),
        label: labels.get(channel.index),
      },
      focusable: false,
      zIndex: 3,
    });
  }
  for (const { subsystems } of structure.agents)
    for (const one of subsystems) {
      if (!one.buffers.some((buffer) => buffer.direction === "real")) continue;
      const [source, target] = one.kind === "effector" ? [one.path, `${one.path}#device`] : [`${one.path}#device`, one.path];
      edges.push({
        id: `${one.path}#wire`,
        source,
        target,
        sourceHandle: "device",
        targetHandle: "device",
        className: "device-wire",
        focusable: false,
        selectable: false,
        zIndex: 1,
      });
    }
  return edges;
}

/** Agents as roboticists draw them. A channel is made by dragging from an output to an input. */
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
  const nodes = useMemo(() => nodesOf(structure, selected, complaints), [structure, selected, complaints]);
  useSteadyView(useMemo(() => boxAround(nodes), [nodes]));
  const edges = useMemo(() => edgesOf(structure, selected, complaints), [structure, selected, complaints]);
  const select = (path: string | null) => studio.choose(path, structure);
  const connect = ({ sourceHandle, targetHandle }: Connection) => {
    if (!sourceHandle || !targetHandle) return;
    const end = (path: string) => {
      const agent = structure.agents.find((one) => path.startsWith(`${one.name}.`));
      return agent?.count ? path.replace(agent.name, `${agent.name}[i]`) : path;
    };
    studio.draft.edit(
      addChannel(structure, end(sourceHandle), end(targetHandle), { send: "non_blocking", receive: "non_blocking", timeout: "" }),
      "edit",
    );
    studio.view.set({ selected: channelPath(structure.channels.length), panel: "inspect" });
  };
  const dragged = useRef(false);
  // The click that ends a drag is not meant for the element below it.
  const dragEnds = () => void setTimeout(() => (dragged.current = false), 0);
  const click = (event: MouseEvent) =>
    dragged.current || select((event.target as Element).closest("[data-path]")?.getAttribute("data-path") ?? null);
  const key = (event: KeyboardEvent) => {
    const thing = selected === null ? undefined : findThing(structure, selected);
    if ((event.key === "Delete" || event.key === "Backspace") && thing?.kind === "channel") {
      studio.draft.edit(removeChannel(structure, thing.of), "edit");
      select(null);
    }
  };
  const add = () => {
    const name = freeName(
      "agent",
      structure.agents.map((agent) => agent.name),
    );
    studio.draft.edit(addAgent(structure, name), "edit");
    studio.view.set({ selected: name, panel: "inspect" });
  };
  return (
    <div className="canvas structure" data-testid="structure">
      <div className="breadcrumbs">
        <span className="crumb" aria-current="page">
          {structure.system || "system"}
        </span>
        <span className="layer-name">drag from an output to an input to connect them</span>
        <span className="spring" />
        <button className="quiet" onClick={add}>
          Add agent
        </button>
        <ExportButtons name={structure.system} />
      </div>
      <ChannelTip />
      <div className="canvas-area" onClick={click} onKeyDown={key}>
        <ReactFlow
          nodes={nodes}
          edges={edges}
          nodeTypes={nodeTypes}
          edgeTypes={edgeTypes}
          onConnect={connect}
          onConnectStart={() => (dragged.current = true)}
          onConnectEnd={dragEnds}
          nodesDraggable={false}
          elementsSelectable={false}
          zoomOnDoubleClick={false}
          disableKeyboardA11y
          fitView
          fitViewOptions={{ padding: 0.08, maxZoom: 1.1 }}
          minZoom={0.05}
          proOptions={{ hideAttribution: true }}
          connectionRadius={28}
        >
          <Background variant={BackgroundVariant.Dots} gap={28} size={1} />
          <Controls showInteractive={false} position="bottom-right" />
        </ReactFlow>
      </div>
    </div>
  );
}
