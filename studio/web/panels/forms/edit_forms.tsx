import { keysNow, named } from "../../live/editor";
import * as edits from "../../model/text/edits";
import {
  behavioursIn,
  bufferSelection,
  targetsIn,
  type Agent,
  type Buffer,
  type Structure,
  type Subsystem,
  type Thing,
} from "../../model/structure/structure";
import { nameList } from "../../model/text/name_list";
import { fieldOf, fieldsOf, type FieldShape } from "../../model/text/schema_fields";
import { limitNames, titled } from "../../model/structure/inside_types";
import { BehaviourForm } from "./behaviour_form";
import { ChannelForm } from "./channel_form";
import { Choice, Field } from "./field";
import { namespaceHint, nameProblem, namesIn, Remove, SharedNote, useEdit } from "./form_parts";
import { ConnectForm } from "./connect_form";
import { limitHelp, limitsHelp, safeHelp } from "./form_help";
import { ObjectFields } from "./object_fields";
import { ParameterFields } from "./parameter_fields";
import { schema } from "./schema";
import { changed, MemoryFields, TypeInputs } from "./type_fields";
import { AddSubsystem, TemplateForm, TemplateLink } from "./templates_form";
import { MapForm } from "./map_form";
import { OnErrorField } from "./on_error_field";
import { OwnProblem } from "./use_problems";

export function EditForm({ structure, thing }: { structure: Structure; thing: Thing }) {
  switch (thing.kind) {
    case "agent":
      return <AgentForm structure={structure} agent={thing.of} />;
    case "template":
      return <TemplateForm structure={structure} template={thing.of} />;
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

/** Keys of a subsystem that have fields of their own. Every other one is shown as the schema describes it. */
const shownAlone =
  "rate start stale inputs outputs real behaviours memory parameters safe limits send receive on_error conditions".split(" ");

function AgentForm({ structure, agent }: { structure: Structure; agent: Agent }) {
  const edit = useEdit();
  return (
    <>
      <Field
        label="Name"
        value={agent.name}
        wrong={nameProblem(
          agent.name,
          structure.agents.map((one) => one.name),
        )}
        hint={agent.template ? "" : namespaceHint}
        onChange={(name) => edit(edits.rename(agent.yaml, name), name)}
      />
      <Field
        label="How many"
        value={agent.count}
        placeholder="one"
        hint="A fleet of equal agents"
        onChange={(text) => edit(edits.set(agent.yaml, "count", text))}
      />
      <Field
        label="Uses the template"
        value={agent.template}
        placeholder="none: it has its own subsystems"
        choices={structure.yaml.keys(["templates"])}
        onChange={(text) => edit(edits.set(agent.yaml, "use", text))}
      />
      {agent.count && (
        <Choice
          label="The last one is followed by"
          value={structure.yaml.valueText([...agent.yaml, "ring"]) === "true" ? "true" : ""}
          choices={[
            { value: "", title: "nobody" },
            { value: "true", title: "the first one: a ring" },
          ]}
          onChange={(text) => edit(edits.set(agent.yaml, "ring", text))}
        />
      )}
      {agent.included ? (
        <p className="faint">
          The template {agent.template} is in an included file, which the studio does not change. The net shows its subsystems and
          their channels.
        </p>
      ) : (
        <>
          <OnErrorField structure={structure} at={agent.body} behaviours={agent.subsystems.flatMap((one) => targetsIn(one))} />
          <SharedNote structure={structure} agent={agent} />
          {agent.template && <TemplateLink name={agent.template} />}
        </>
      )}
      <div className="buttons">
        {!agent.included && <AddSubsystem agent={agent} />}
        {!agent.template && <button onClick={() => void edit(edits.makeTemplate(agent), agent.name)}>Make it a template</button>}
      </div>
      <Remove what="agent" at={agent.yaml} select={null} />
    </>
  );
}

function SubsystemForm({ structure, subsystem, agent }: { structure: Structure; subsystem: Subsystem; agent: Agent }) {
  const edit = useEdit();
  const set = (key: string) => (text: string) => edit(edits.set(subsystem.yaml, key, text));
  const taken = keysNow(...["behaviours", "inputs", "outputs", "real"].map((key) => [...subsystem.yaml, key]));
  const addBuffer = (direction: Buffer["direction"], wish: string) => {
    const type = structure.types[0] ?? "float64";
    const added = named(wish, taken, (name) => edits.addBuffer(subsystem, direction, name, type));
    void edit(added.wish, () => bufferSelection(direction, `${subsystem.path}.${added.name}`));
  };
  const add = (wish: string, adding: typeof edits.addBehaviour) => {
    const added = named(wish, taken, (name) => adding(subsystem, name));
    void edit(added.wish, () => `${subsystem.path}.${added.name}`);
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
          hint={namespaceHint}
          onChange={(name) => edit(edits.rename(subsystem.yaml, name), `${agent.name}.${name}`)}
        />
      )}
      <SharedNote structure={structure} agent={agent} />
      <Field label="Rate" value={subsystem.rate} placeholder="as its blocking channels say" onChange={set("rate")} />
      {behavioursIn(subsystem).length > 1 && (
        <Field
          label="Starts with"
          value={subsystem.start}
          placeholder={subsystem.behaviours[0]!.name}
          choices={targetsIn(subsystem)}
          onChange={set("start")}
        />
      )}
      <OnErrorField structure={structure} at={subsystem.yaml} behaviours={targetsIn(subsystem)} />
      <Field
        label="Behaviours send"
        mono
        value={structure.yaml.lineText([...subsystem.yaml, "send"])}
        placeholder="all outputs"
        hint="a, b: the outputs that a behaviour without a list sends, in this order"
        onChange={(text) => set("send")(nameList(text))}
      />
      {subsystem.buffers.some(({ direction }) => direction === "input") && (
        <Field
          label="Behaviours receive"
          mono
          value={structure.yaml.lineText([...subsystem.yaml, "receive"])}
          placeholder="all inputs, last"
          hint="first or last: before or after the function; [a, b]: these inputs; { first: [a, b] }: both"
          choices={["last", "first"]}
          onChange={set("receive")}
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
        <button onClick={() => add("act", edits.addBehaviour)}>Add behaviour</button>
        <button onClick={() => add("group", edits.addGroup)}>Add group</button>
        <button onClick={() => addBuffer("input", "input")}>Add input</button>
        <button onClick={() => addBuffer("output", "output")}>Add output</button>
        {subsystem.kind !== "control" && <button onClick={() => addBuffer("real", "device")}>Add real buffer</button>}
      </div>
      <ObjectFields structure={structure} at={subsystem.yaml} shapes={optionsOf[subsystem.kind]} />
      <MapForm
        structure={structure}
        at={[...subsystem.yaml, "conditions"]}
        title="Conditions"
        one="condition"
        fresh={{ name: "late", value: "elapsed > 1 s" }}
        hint="Named once, for the terminal and error conditions of several behaviours"
      />
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
        <ObjectFields
          structure={structure}
          at={subsystem.yaml}
          shapes={[safeField(structure, subsystem), limits]}
          always="all"
          help={{ ...safeHelp(subsystem), ...limitsHelp(structure, subsystem) }}
        />
      )}
      <Remove what="subsystem" at={subsystem.yaml} select={agent.name} />
    </>
  );
}

const limits = fieldsOf({ $ref: "#/$defs/effector" }, schema).find(({ key }) => key === "limits")!;
const limitFields = fieldsOf({ $ref: "#/$defs/effector/properties/limits/additionalProperties" }, schema);

/** The safe command: a value for each real buffer, in the fields of its type. */
function safeField(structure: Structure, { buffers }: Subsystem): FieldShape {
  const real = buffers.filter(({ direction }) => direction === "real");
  const properties = Object.fromEntries(real.map(({ name, type }) => [name, titled(name, type, structure)]));
  return fieldOf("safe", { type: "object", properties, additionalProperties: false }, schema, false);
}

/** The limits of a real buffer that is a number or an array of numbers. */
function LimitsForm({ structure, subsystem, buffer }: { structure: Structure; subsystem: Subsystem; buffer: Buffer }) {
  const edges =
    subsystem.kind === "effector" && buffer.direction === "real" && limitNames(structure, buffer).includes(buffer.name);
  if (!edges) return null;
  const at = [...subsystem.yaml, "limits", buffer.name];
  return (
    <fieldset className="entry" aria-label="Limits">
      <legend>Limits</legend>
      <OwnProblem structure={structure} at={at} />
      <div className="compact">
        <ObjectFields structure={structure} at={at} shapes={limitFields} always="all" help={limitHelp} onEmpty={() => {}} />
      </div>
    </fieldset>
  );
}

const optionsOf = Object.fromEntries(
  (["control", "receptor", "effector"] as const).map((kind) => [
    kind,
    fieldsOf({ $ref: `#/$defs/${kind}` }, schema).filter(({ key }) => !shownAlone.includes(key)),
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
        onChange={(name) => edit(edits.rename(buffer.yaml, name), bufferSelection(buffer.direction, `${subsystem.path}.${name}`))}
      />
      <TypeInputs structure={structure} value={buffer.type} onChange={(change) => edit(changed(buffer.yaml, change))} />
      <LimitsForm structure={structure} subsystem={subsystem} buffer={buffer} />
      <ConnectForm key={buffer.selection} structure={structure} buffer={buffer} />
      <Remove what="buffer" at={buffer.yaml} select={subsystem.path} />
    </>
  );
}
