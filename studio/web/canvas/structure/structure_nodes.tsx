import { Handle, Position, useStore as useFlow, type NodeProps } from "@xyflow/react";
import { createContext, useContext } from "react";
import { useStore, useStudio } from "../../hooks/use";
import { useRunning } from "../../hooks/use_stage";
import { agentNote, deviceTitle, head, kindTitle, ports, rateText, row, type Card } from "../../model/structure/cards";
import {
  agentAbove,
  agentFilled,
  detailAt,
  structureStep,
  subsystemFilled,
  type FilledBox,
  type Levels,
} from "../../model/structure/levels";
import type { Agent, Buffer, Structure, Subsystem } from "../../model/structure/structure";
import { lineHeight, leastPixels, type FittedText } from "../../model/structure/text_size";
import { Flag, type Complaint } from "./flag";
import { MachineView } from "./machine_view";
import { measured } from "./measured_text";

/** The facts that all boxes share: they are drawn again when it changes, and not for each move of the view. */
export interface Surroundings {
  structure: Structure;
  levels: Levels;
  /** Buffers that have a channel. */
  connected: ReadonlySet<string>;
  /** The agents at the ends of the bundle under the pointer. */
  ends: readonly string[];
  /** The behaviours in which subsystems stand still, while they are shown; null: those of the run are shown. */
  standstill: ReadonlyMap<string, string> | null;
}
export const SurroundingsContext = createContext<Surroundings | null>(null);
const useSurroundings = () => useContext(SurroundingsContext)!;

/** The step of the zoom while it scales letters; 0: everything is drawn, in letters of fixed size. */
function useStep(levels: Levels): number {
  return useFlow(({ transform }) => {
    const step = structureStep(transform[2]);
    return detailAt(step, levels) === "all" ? 0 : step;
  });
}

/** Lines of a text in letters of a fixed size on the screen. */
function Lines({ of, step, notes = [] }: { of: FittedText; step: number; notes?: readonly string[] }) {
  const style = (size: number) => ({ fontSize: size / step, lineHeight });
  return (
    <>
      {of.lines.map((line, at) => (
        <span key={at} className="line" style={style(of.size)}>
          {line}
        </span>
      ))}
      {notes.map((note) => (
        <span key={note} className="line note" style={style(leastPixels + 1)}>
          {note}
        </span>
      ))}
    </>
  );
}

export function AgentNode({ data, width = 0, height = 0 }: NodeProps) {
  const { agent, selected, complaint } = data as { agent: Agent; selected: boolean; complaint: Complaint | undefined };
  const { levels, ends } = useSurroundings();
  const step = useStep(levels);
  const box = { x: 0, y: 0, width, height };
  const far = step > 0 && detailAt(step, levels) === "agents";
  const note = agentNote(agent);
  const text = step === 0 ? undefined : far ? agentFilled(agent, box, step, measured) : agentAbove(agent, box, step, measured);
  return (
    <div className={`agent-box${selected ? " selected" : ""}${ends.includes(agent.name) ? " end" : ""}`}>
      <button className="agent-name" data-path={agent.name} aria-pressed={selected} title={agent.name + note}>
        <span className="agent-title">
          {step === 0 ? agent.name : text ? <Lines of={text} step={step} notes={(text as FilledBox).notes} /> : null}
        </span>
        {step === 0 && note && <span className="faint">{note}</span>}
        <Flag of={complaint} />
      </button>
      {agent.included && step > 0 && !far && (
        <span className="included-note" style={{ fontSize: (leastPixels + 1) / step }}>
          in an included file
        </span>
      )}
    </div>
  );
}

export function SubsystemNode({ data, width = 0, height = 0 }: NodeProps) {
  const { subsystem, selected, complaints, card } = data as {
    subsystem: Subsystem;
    selected: string | null;
    complaints: ReadonlyMap<string, Complaint>;
    card: Card;
  };
  const studio = useStudio();
  const { structure, levels, standstill } = useSurroundings();
  const step = useStep(levels);
  const running = useRunning(useStore(studio.scene.store, ({ panes }) => panes[0]!.stage));
  const present = standstill ?? running;
  const now = present.get(subsystem.path) ?? [...present].find(([path]) => path.replace(/\[\d+\]/, "") === subsystem.path)?.[1];
  const of = (direction: Buffer["direction"]) => subsystem.buffers.filter((buffer) => buffer.direction === direction);
  const isSelected = selected === subsystem.path;
  const rate = rateText(structure, subsystem);
  const kind = kindTitle[subsystem.kind];
  const box = { x: 0, y: 0, width, height };
  const far = step > 0 && detailAt(step, levels) === "subsystems" && subsystemFilled(subsystem, box, step, measured, now);
  const title = `${subsystem.path}\n${kind}${rate && `, ${rate}`}${now ? `\n${now} is running` : ""}`;
  return (
    <div className={`subsystem-box ${subsystem.kind}${isSelected ? " selected" : ""}`}>
      <button
        className={`subsystem-head${now ? " running" : ""}`}
        data-path={subsystem.path}
        aria-pressed={isSelected}
        title={title}
        style={far ? undefined : { height: head - 2 }}
      >
        {far ? (
          <span className="subsystem-name">
            <Lines of={far} step={step} notes={far.notes} />
          </span>
        ) : (
          <>
            <span className="first-line">
              <span className="subsystem-name">{subsystem.name}</span>
              {rate && <span className="rate">{rate}</span>}
            </span>
            <span className="kind">{kind}</span>
          </>
        )}
        <Flag of={complaints.get(subsystem.path)} />
      </button>
      {subsystem.kind !== "control" && (
        <Handle
          id="device"
          type={subsystem.kind === "effector" ? "source" : "target"}
          position={Position.Bottom}
          className="device-handle"
          isConnectable={false}
        />
      )}
      <div className="ports" style={{ height: ports(subsystem) * row }}>
        <Ports buffers={of("input")} selected={selected} side="in" />
        <Ports buffers={of("output")} selected={selected} side="out" />
      </div>
      <div className="machine" style={{ left: card.machineAt.x, top: card.machineAt.y }}>
        <MachineView subsystem={subsystem} machine={card.machine} selected={selected} complaints={complaints} now={now} />
      </div>
    </div>
  );
}

function Ports({ buffers, selected, side }: { buffers: Buffer[]; selected: string | null; side: "in" | "out" }) {
  const { connected } = useSurroundings();
  return (
    <div className={`port-list ${side}`}>
      {buffers.map((buffer, at) => (
        <div key={buffer.selection} className="port" style={{ height: row }}>
          <Handle
            id={buffer.path}
            type={side === "in" ? "target" : "source"}
            position={side === "in" ? Position.Left : Position.Right}
            className={connected.has(buffer.path) ? "connected" : ""}
            style={{ top: head + at * row + row / 2 }}
            data-handle={buffer.path}
          />
          <BufferButton of={buffer} selected={selected} />
        </div>
      ))}
    </div>
  );
}

const BufferButton = ({ of, selected }: { of: Buffer; selected: string | null }) => (
  <button
    data-path={of.path}
    data-selection={of.selection}
    aria-pressed={selected === of.selection}
    title={`${of.name}: ${of.type}`}
  >
    {of.name}
  </button>
);

export function DeviceNode({ data }: NodeProps) {
  const { subsystem, selected } = data as { subsystem: Subsystem; selected: string | null };
  return (
    <div className="device-box">
      <span className="kind">{deviceTitle(subsystem)}</span>
      {subsystem.buffers
        .filter((buffer) => buffer.direction === "real")
        .map((buffer) => (
          <BufferButton key={buffer.selection} of={buffer} selected={selected} />
        ))}
      <Handle
        id="device"
        type={subsystem.kind === "effector" ? "target" : "source"}
        position={Position.Top}
        className="device-handle"
        isConnectable={false}
      />
    </div>
  );
}
