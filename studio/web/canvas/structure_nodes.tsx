import { Handle, Position, useStore as useFlow, type NodeProps } from "@xyflow/react";
import { Fragment, type CSSProperties } from "react";
import { useStore, useStudio } from "../hooks/use";
import { useRunning } from "../hooks/use_stage";
import { behavioursIn, withoutIndex, type Agent, type Buffer, type Subsystem } from "../model/structure/structure";
import { chipText, chipWidth, head, ports, row } from "../model/structure/structure_layout";
import { linesIn } from "./detail";

interface Complaint {
  severity: "error" | "warning";
  messages: string[];
}
const Flag = ({ of }: { of: Complaint | undefined }) =>
  of ? (
    <span
      className={`dot ${of.severity}`}
      role="img"
      aria-label={`${of.severity}: ${of.messages.join("; ")}`}
      title={of.messages.join("\n")}
    />
  ) : null;

/** A name that may break after its underscores. */
const Name = ({ of }: { of: string }) =>
  of.split(/(?<=_)/).map((part, at) => (
    <Fragment key={at}>
      {part}
      <wbr />
    </Fragment>
  ));

/** The number of lines of a name that fills its box; it changes seldom during a zoom. */
const useLines = (height: number, letters: number) =>
  ({ "--lines": useFlow(({ transform }) => linesIn(height, transform[2], letters)) }) as CSSProperties;

export function AgentNode({ data, height = 0 }: NodeProps) {
  const { agent, selected, complaint } = data as { agent: Agent; selected: boolean; complaint: Complaint | undefined };
  return (
    <div className={`agent-box${selected ? " selected" : ""}`} style={useLines(height - 60, 13)}>
      <button className="agent-name" data-path={agent.name} aria-pressed={selected} title={agent.name}>
        <span className="cut">
          <Name of={agent.name} />
        </span>
        {agent.count && <span className="faint"> × {agent.count}</span>}
        {agent.template && <span className="faint"> uses {agent.template}</span>}
        <Flag of={complaint} />
      </button>
    </div>
  );
}

const kindTitle = { control: "control subsystem", receptor: "virtual receptor", effector: "virtual effector" };

export function SubsystemNode({ data, height = 0 }: NodeProps) {
  const { subsystem, selected, complaints } = data as {
    subsystem: Subsystem;
    selected: string | null;
    complaints: ReadonlyMap<string, Complaint>;
  };
  const studio = useStudio();
  const running = useRunning(useStore(studio.scene.store, ({ panes }) => panes[0]!.stage));
  const now = running.get(subsystem.path) ?? [...running].find(([path]) => path.replace(/\[\d+\]/, "") === subsystem.path)?.[1];
  const of = (direction: Buffer["direction"]) => subsystem.buffers.filter((buffer) => buffer.direction === direction);
  const isSelected = selected === subsystem.path;
  return (
    <div
      className={`subsystem-box ${subsystem.kind}${isSelected ? " selected" : ""}`}
      style={useLines(height - (now ? 60 : 0), 10)}
    >
      <button
        className="subsystem-head"
        data-path={subsystem.path}
        aria-pressed={isSelected}
        title={subsystem.path}
        style={{ height: head - 4 }}
      >
        <span className="subsystem-name">
          <Name of={subsystem.name} />
        </span>
        {now && <span className="now">{now}</span>}
        <span className="kind">
          {kindTitle[subsystem.kind]}
          {subsystem.rate && ` · ${subsystem.rate}`}
        </span>
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
      <div className="chips">
        <Chips subsystem={subsystem} group="" selected={selected} complaints={complaints} now={now && withoutIndex(now)} />
      </div>
    </div>
  );
}

/** The behaviours of a subsystem or of a group. A group stands on lines of its own, with what is in it. */
function Chips({
  subsystem,
  group,
  ...shown
}: {
  subsystem: Subsystem;
  group: string;
  selected: string | null;
  complaints: ReadonlyMap<string, Complaint>;
  now: string | undefined;
}) {
  return behavioursIn(subsystem, group).map((behaviour) => {
    const { selected, complaints, now } = shown;
    const own = behaviour.path.slice(subsystem.path.length + 1);
    const runs = now === own || (behaviour.isGroup && now?.startsWith(`${own}.`));
    const what = behaviour.isGroup ? "group" : "behaviour";
    const chip = (
      <button
        key={behaviour.path}
        style={{ width: chipWidth(behaviour, subsystem) }}
        className={`chip${behaviour.isGroup ? " group" : ""}${runs ? " running" : ""}`}
        data-path={behaviour.path}
        aria-pressed={selected === behaviour.path}
        title={behaviour.for ? `${own}, for ${behaviour.for}` : own}
        aria-label={`${what} ${own}${runs ? ", running" : ""}`}
      >
        {chipText(behaviour)}
        <Flag of={complaints.get(behaviour.path)} />
      </button>
    );
    if (!behaviour.isGroup) return chip;
    return (
      <div key={behaviour.path} className="chip-group">
        {chip}
        <Chips subsystem={subsystem} group={behaviour.path} {...shown} />
      </div>
    );
  });
}

function Ports({ buffers, selected, side }: { buffers: Buffer[]; selected: string | null; side: "in" | "out" }) {
  return (
    <div className={`port-list ${side}`}>
      {buffers.map((buffer, at) => (
        <div key={buffer.selection} className="port">
          <Handle
            id={buffer.path}
            type={side === "in" ? "target" : "source"}
            position={side === "in" ? Position.Left : Position.Right}
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
  const receptor = subsystem.kind !== "effector";
  return (
    <div className="device-box">
      <span className="kind">{receptor ? "real receptor" : "real effector"}</span>
      {subsystem.buffers
        .filter((buffer) => buffer.direction === "real")
        .map((buffer) => (
          <BufferButton key={buffer.selection} of={buffer} selected={selected} />
        ))}
      <Handle
        id="device"
        type={receptor ? "source" : "target"}
        position={Position.Top}
        className="device-handle"
        isConnectable={false}
      />
    </div>
  );
}
