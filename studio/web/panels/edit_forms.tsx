import { useStudio } from "../hooks/use";
import * as edits from "../model/edits";
import {
  readStructure,
  type Agent,
  type Behaviour,
  type Buffer,
  type Channel,
  type Structure,
  type Subsystem,
  type Thing,
} from "../model/structure";
import type { YamlPath } from "../model/yaml_text";
import { Choice, Field } from "./field";

const nameProblem = (text: string) =>
  edits.isName(text) ? undefined : "Letters, digits and single underscores, beginning with a letter";

/** Puts a changed text into the draft and selects the changed element. */
function useEdit() {
  const studio = useStudio();
  return (text: string, select?: string | null) => {
    studio.draft.edit(text, "edit");
    if (select !== undefined) studio.view.set({ selected: select });
  };
}

export function EditForm({ structure, thing }: { structure: Structure; thing: Thing }) {
  switch (thing.kind) {
    case "agent":
      return <AgentForm structure={structure} agent={thing.of} />;
    case "subsystem":
      return <SubsystemForm structure={structure} subsystem={thing.of} agent={thing.agent} />;
    case "behaviour":
      return <BehaviourForm structure={structure} behaviour={thing.of} subsystem={thing.subsystem} />;
    case "buffer":
      return <BufferForm structure={structure} buffer={thing.of} subsystem={thing.subsystem} />;
    case "channel":
      return <ChannelForm structure={structure} channel={thing.of} />;
  }
}

const Remove = ({ what, onClick }: { what: string; onClick: () => void }) => (
  <button className="danger" onClick={onClick}>
    Remove {what}
  </button>
);

function AgentForm({ structure, agent }: { structure: Structure; agent: Agent }) {
  const edit = useEdit();
  const names = agent.subsystems.map((one) => one.name);
  const add = (kind: Subsystem["kind"]) => {
    const name = kind === "control" ? "control" : edits.freeName(kind === "receptor" ? "sensor" : "motor", names);
    edit(edits.addSubsystem(structure, agent, kind, name), `${agent.name}.${name}`);
  };
  return (
    <>
      <Field
        label="Name"
        value={agent.name}
        wrong={nameProblem}
        onChange={(name) => edit(edits.renameAgent(structure, agent, name), name)}
      />
      <Field
        label="How many"
        value={agent.count}
        placeholder="one"
        hint="A fleet of equal agents"
        onChange={(text) => edit(edits.setField(structure, agent.yaml, "count", text))}
      />
      <div className="buttons">
        {!names.includes("control") && <button onClick={() => add("control")}>Add control</button>}
        <button onClick={() => add("receptor")}>Add receptor</button>
        <button onClick={() => add("effector")}>Add effector</button>
        <Remove what="agent" onClick={() => edit(edits.removeAgent(structure, agent, readStructure), null)} />
      </div>
    </>
  );
}

function SubsystemForm({ structure, subsystem, agent }: { structure: Structure; subsystem: Subsystem; agent: Agent }) {
  const edit = useEdit();
  const set = (key: string) => (text: string) => edit(edits.setField(structure, subsystem.yaml, key, text));
  const taken = [...subsystem.behaviours, ...subsystem.buffers].map((one) => one.name);
  const addBuffer = (direction: Buffer["direction"], wish: string) => {
    const name = edits.freeName(wish, taken);
    edit(edits.addBuffer(structure, subsystem, direction, name, structure.types[0] ?? "float64"), `${subsystem.path}.${name}`);
  };
  const addBehaviour = () => {
    const name = edits.freeName("act", taken);
    edit(edits.addBehaviour(structure, subsystem, name), `${subsystem.path}.${name}`);
  };
  return (
    <>
      {subsystem.kind !== "control" && (
        <Field
          label="Name"
          value={subsystem.name}
          wrong={nameProblem}
          onChange={(name) => edit(edits.renameSubsystem(structure, subsystem, name), `${agent.name}.${name}`)}
        />
      )}
      <Field label="Rate" value={subsystem.rate} placeholder="as its blocking channels say" onChange={set("rate")} />
      {subsystem.behaviours.length > 1 && (
        <Field
          label="Starts with"
          value={subsystem.start}
          placeholder={subsystem.behaviours[0]!.name}
          choices={subsystem.behaviours.map((one) => one.name)}
          onChange={set("start")}
        />
      )}
      {subsystem.kind === "effector" && (
        <Field
          label="Inputs are stale after"
          value={structure.yaml.valueText([...subsystem.yaml, "stale"]) ?? ""}
          placeholder="never"
          onChange={set("stale")}
        />
      )}
      <div className="buttons">
        <button onClick={addBehaviour}>Add behaviour</button>
        <button onClick={() => addBuffer("input", "input")}>Add input</button>
        <button onClick={() => addBuffer("output", "output")}>Add output</button>
        {subsystem.kind !== "control" && <button onClick={() => addBuffer("real", "device")}>Add real buffer</button>}
        <Remove what="subsystem" onClick={() => edit(edits.removeSubsystem(structure, subsystem, readStructure), agent.name)} />
      </div>
    </>
  );
}

function BehaviourForm({
  structure,
  behaviour,
  subsystem,
}: {
  structure: Structure;
  behaviour: Behaviour;
  subsystem: Subsystem;
}) {
  const edit = useEdit();
  const field = (key: string) => structure.yaml.valueText([...behaviour.yaml, key]) ?? "";
  const set = (key: string) => (text: string) => edit(edits.setField(structure, behaviour.yaml, key, text));
  return (
    <>
      <Field
        label="Name"
        value={behaviour.name}
        wrong={nameProblem}
        hint="Its C++ function has the same name; rename it there too"
        onChange={(name) => edit(edits.renameBehaviour(structure, subsystem, behaviour, name), `${subsystem.path}.${name}`)}
      />
      <Field
        label="Terminal condition"
        mono
        value={behaviour.terminal}
        placeholder="never"
        hint="C++ over in, out, memory, parameters"
        onChange={set("terminal")}
      />
      <Field label="Error condition" mono value={behaviour.error} placeholder="never" onChange={set("error")} />
      <NextForm structure={structure} behaviour={behaviour} subsystem={subsystem} />
      <Field label="Sends" mono value={field("send")} placeholder="all outputs" onChange={set("send")} />
      <Field label="Receives" mono value={field("receive")} placeholder="all inputs" onChange={set("receive")} />
      <Choice
        label="Transfer"
        value={field("transfer") === "parallel" ? "parallel" : "sequential"}
        choices={[
          { value: "sequential", title: "one channel after the other" },
          { value: "parallel", title: "all channels at once" },
        ]}
        onChange={(value) => set("transfer")(value === "parallel" ? value : "")}
      />
      <Field label="Takes" value={field("takes")} placeholder="no simulated time" onChange={set("takes")} />
      <div className="buttons">
        <Remove
          what="behaviour"
          onClick={() => edit(edits.removeBehaviour(structure, subsystem, behaviour, readStructure), subsystem.path)}
        />
      </div>
    </>
  );
}

function NextForm({ structure, behaviour, subsystem }: { structure: Structure; behaviour: Behaviour; subsystem: Subsystem }) {
  const edit = useEdit();
  const { next } = behaviour;
  const targets = [...subsystem.behaviours.map((one) => one.name), "end"];
  const write = (changed: Behaviour["next"]) => edit(edits.setNext(structure, behaviour, changed));
  const change = (at: number, part: Partial<Behaviour["next"][number]>) =>
    write(next.map((entry, index) => (index === at ? { ...entry, ...part } : entry)));
  return (
    <fieldset className="next">
      <legend>Then</legend>
      {next.length === 0 && <p className="faint">the subsystem ends</p>}
      {next.map((entry, at) => (
        <div key={at} className="next-entry">
          <Field
            label={`Then ${at + 1}: to`}
            value={entry.to}
            choices={targets}
            onChange={(to) => (to ? change(at, { to }) : write(next.filter((_, index) => index !== at)))}
          />
          <Field
            label="when"
            mono
            value={entry.when}
            placeholder="always"
            choices={["error"]}
            onChange={(when) => change(at, { when })}
          />
        </div>
      ))}
      <button onClick={() => write([...next, { to: targets.find((name) => name !== behaviour.name) ?? "end", when: "" }])}>
        Add what follows
      </button>
    </fieldset>
  );
}

const directionTitle = { input: "input buffer", output: "output buffer", real: "buffer of a device" };
const plainTypes = ["bool", "int32", "uint32", "float32", "float64", "string"];

function BufferForm({ structure, buffer, subsystem }: { structure: Structure; buffer: Buffer; subsystem: Subsystem }) {
  const edit = useEdit();
  return (
    <>
      <p className="faint">{directionTitle[buffer.direction]}</p>
      <Field
        label="Name"
        value={buffer.name}
        wrong={nameProblem}
        onChange={(name) => edit(edits.renameBuffer(structure, subsystem, buffer, name), `${subsystem.path}.${name}`)}
      />
      <Field
        label="Type"
        mono
        value={buffer.type}
        choices={[...structure.types, ...plainTypes]}
        hint="A unit may follow a number: float64 m/s"
        onChange={(type) => edit(edits.setType(structure, buffer, type))}
      />
      <div className="buttons">
        <Remove
          what="buffer"
          onClick={() => edit(edits.removeBuffer(structure, subsystem, buffer, readStructure), subsystem.path)}
        />
      </div>
    </>
  );
}

const modes = [
  { value: "non_blocking", title: "goes on at once" },
  { value: "blocking", title: "waits (blocking)" },
] as const;

function ChannelForm({ structure, channel }: { structure: Structure; channel: Channel }) {
  const edit = useEdit();
  const at: YamlPath = ["channels", channel.index];
  const set = (change: Partial<edits.ChannelModes>) => edit(edits.setChannel(structure, channel, change));
  return (
    <>
      <dl>
        <dt>From</dt>
        <dd className="path">{channel.from}</dd>
        <dt>To</dt>
        <dd className="path">{channel.to}</dd>
      </dl>
      {channel.model ? (
        <Field
          label="Communication model"
          value={channel.model}
          onChange={(text) => edit(edits.setField(structure, at, "model", text))}
        />
      ) : (
        <>
          <Choice label="The sender" value={channel.send} choices={modes} onChange={(send) => set({ send })} />
          <Choice label="The receiver" value={channel.receive} choices={modes} onChange={(receive) => set({ receive })} />
          <Field
            label="Timeout of a side that waits"
            value={channel.timeout}
            placeholder="waits for ever"
            onChange={(timeout) => set({ timeout })}
          />
        </>
      )}
      <div className="buttons">
        <Remove what="channel" onClick={() => edit(edits.removeChannel(structure, channel), null)} />
      </div>
    </>
  );
}
