import * as edits from "../../model/text/edits";
import {
  readStructure,
  type Agent,
  type Buffer,
  type Channel,
  type Structure,
  type Subsystem,
  type Thing,
} from "../../model/structure/structure";
import { fieldsOf, type FieldShape } from "../../model/text/schema_fields";
import type { YamlPath } from "../../model/text/yaml_text";
import { BehaviourForm } from "./behaviour_form";
import { Choice, Field } from "./field";
import { nameProblem, namesIn, Remove, SharedNote, useEdit } from "./form_parts";
import { ConnectForm } from "./connect_form";
import { ObjectFields } from "./object_fields";
import { ParameterFields } from "./parameter_fields";
import { schema } from "./schema";
import { MemoryFields, TypeInputs } from "./type_fields";
import { MapForm } from "./map_form";

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

const otherOptions = ["overrun", "watchdog", "non_finite", "recovery"];

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
        wrong={nameProblem(
          agent.name,
          structure.agents.map((one) => one.name),
        )}
        onChange={(name) => edit(edits.renameAgent(structure, agent, name), name)}
      />
      <Field
        label="How many"
        value={agent.count}
        placeholder="one"
        hint="A fleet of equal agents"
        onChange={(text) => edit(edits.setField(structure, agent.yaml, "count", text))}
      />
      <Field
        label="Uses the template"
        value={agent.template}
        placeholder="none: it has its own subsystems"
        choices={structure.yaml.keys(["templates"])}
        onChange={(text) => edit(edits.setField(structure, agent.yaml, "use", text))}
      />
      {agent.count && (
        <Choice
          label="The last one is followed by"
          value={structure.yaml.valueText([...agent.yaml, "ring"]) === "true" ? "true" : ""}
          choices={[
            { value: "", title: "nobody" },
            { value: "true", title: "the first one: a ring" },
          ]}
          onChange={(text) => edit(edits.setField(structure, agent.yaml, "ring", text))}
        />
      )}
      <SharedNote structure={structure} agent={agent} />
      <div className="buttons">
        {!names.includes("control") && <button onClick={() => add("control")}>Add control</button>}
        <button onClick={() => add("receptor")}>Add receptor</button>
        <button onClick={() => add("effector")}>Add effector</button>
        <Remove
          what="agent"
          structure={structure}
          at={agent.yaml}
          after={() => edits.removeAgent(structure, agent, readStructure)}
          onClick={(text) => edit(text, null)}
        />
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
          wrong={nameProblem(
            subsystem.name,
            agent.subsystems.map((one) => one.name),
          )}
          onChange={(name) => edit(edits.renameSubsystem(structure, subsystem, name), `${agent.name}.${name}`)}
        />
      )}
      <SharedNote structure={structure} agent={agent} />
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
        <Remove
          what="subsystem"
          structure={structure}
          at={subsystem.yaml}
          after={() => edits.removeSubsystem(structure, subsystem, readStructure)}
          onClick={(text) => edit(text, agent.name)}
        />
      </div>
      <ObjectFields structure={structure} at={subsystem.yaml} shapes={optionsOf[subsystem.kind]} />
      <MapForm
        structure={structure}
        at={[...subsystem.yaml, "memory"]}
        title="Memory"
        one="memory"
        fresh={{ name: "count", value: "int32" }}
        hint="Values that stay from one round to the next"
        fields={(name) => <MemoryFields structure={structure} at={[...subsystem.yaml, "memory", name]} />}
      />
      <MapForm
        structure={structure}
        at={[...subsystem.yaml, "parameters"]}
        title="Parameters"
        one="parameter"
        fresh={{ name: "limit", value: "1.0" }}
        fields={(name) => <ParameterFields structure={structure} at={[...subsystem.yaml, "parameters", name]} />}
      />
      {subsystem.kind === "effector" && subsystem.buffers.some(({ direction }) => direction === "real") && (
        <MapForm
          structure={structure}
          at={[...subsystem.yaml, "safe"]}
          title="Safe command"
          one="safe value"
          fresh={{ name: subsystem.buffers.find(({ direction }) => direction === "real")!.name, value: "0" }}
          hint="The command that the devices get when the subsystem stops or fails"
        />
      )}
    </>
  );
}

/** Keys of a subsystem that have no form of their own, and hold no map. */
const optionsOf = Object.fromEntries(
  (["control", "receptor", "effector"] as const).map((kind) => [
    kind,
    fieldsOf({ $ref: `#/$defs/${kind}` }, schema).filter(({ key }) => otherOptions.includes(key)),
  ]),
) as Record<Subsystem["kind"], FieldShape[]>;

const directionTitle = { input: "input buffer", output: "output buffer", real: "buffer of a device" };

function BufferForm({ structure, buffer, subsystem }: { structure: Structure; buffer: Buffer; subsystem: Subsystem }) {
  const edit = useEdit();
  return (
    <>
      <p className="faint">{directionTitle[buffer.direction]}</p>
      <Field
        label="Name"
        value={buffer.name}
        wrong={nameProblem(buffer.name, namesIn(subsystem))}
        onChange={(name) => edit(edits.renameBuffer(structure, subsystem, buffer, name), `${subsystem.path}.${name}`)}
      />
      <TypeInputs structure={structure} value={buffer.type} onChange={(type) => edit(edits.setType(structure, buffer, type))} />
      <ConnectForm key={buffer.path} structure={structure} buffer={buffer} />
      <div className="buttons">
        <Remove
          what="buffer"
          structure={structure}
          at={buffer.yaml}
          after={() => edits.removeBuffer(structure, subsystem, buffer, readStructure)}
          onClick={(text) => edit(text, subsystem.path)}
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
        <Remove
          what="channel"
          structure={structure}
          at={at}
          after={() => edits.removeChannel(structure, channel)}
          onClick={(text) => edit(text, null)}
        />
      </div>
    </>
  );
}
