import * as edits from "../../model/text/edits";
import {
  exampleOf,
  keptCells,
  leadsFailures,
  listAround,
  type Behaviour,
  type Structure,
  type Subsystem,
} from "../../model/structure/structure";
import { CodeForm } from "./code_form";
import { Choice, Field } from "./field";
import { nameProblem, namesIn, Remove, useEdit } from "./form_parts";

export function BehaviourForm({
  structure,
  behaviour,
  subsystem,
}: {
  structure: Structure;
  behaviour: Behaviour;
  subsystem: Subsystem;
}) {
  const edit = useEdit();
  const field = (key: string) => structure.yaml.lineText([...behaviour.yaml, key]);
  const kept = keptCells(structure, subsystem);
  const set = (key: string) => (text: string) => edit(edits.set(behaviour.yaml, key, text));
  const list = (key: "send" | "receive", all: string) => {
    const around = listAround(structure, subsystem, key);
    return around ? `${around}, as the subsystem` : all;
  };
  return (
    <>
      <Field
        label="Name"
        value={behaviour.name}
        wrong={nameProblem(behaviour.name, namesIn(subsystem))}
        hint="Its C++ function has the same name, and changes with it"
        onChange={(name) => edit(edits.rename(behaviour.yaml, name), `${subsystem.path}.${name}`)}
      />
      <Field
        label="Terminal condition"
        mono
        value={behaviour.terminal}
        placeholder="never"
        hint="C++ over in, out, memory, parameters; or the name of a condition of the subsystem"
        onChange={set("terminal")}
      />
      <Field label="Error condition" mono value={behaviour.error} placeholder="never" onChange={set("error")} />
      {(kept.length > 0 || behaviour.sets) && (
        <Field
          label="Sets"
          mono
          value={behaviour.sets}
          placeholder="no memory"
          hint={`Memory when the behaviour begins: ${exampleOf(kept)}`}
          onChange={set("sets")}
        />
      )}
      <NextForm structure={structure} behaviour={behaviour} subsystem={subsystem} />
      <Field
        label="Sends"
        mono
        value={field("send")}
        placeholder={list("send", "all outputs")}
        hint="[a, b] in this order; [+a, -b] changes the list of the subsystem"
        onChange={set("send")}
      />
      <Field
        label="Receives"
        mono
        value={field("receive")}
        placeholder={list("receive", "all inputs")}
        hint="[a, b] in this order; [+a, -b] changes the list of the subsystem"
        onChange={set("receive")}
      />
      <Choice
        label="Transfer"
        value={field("transfer") === "parallel" ? "parallel" : "sequential"}
        choices={[
          { value: "sequential", title: "one channel after the other" },
          { value: "parallel", title: "all channels at once" },
        ]}
        onChange={(value) => set("transfer")(value === "parallel" ? value : "")}
      />
      <CodeForm behaviour={behaviour} subsystem={subsystem} />
      <Field label="Takes" value={field("takes")} placeholder="no simulated time" onChange={set("takes")} />
      <div className="buttons">
        <Remove what="behaviour" at={behaviour.yaml} select={subsystem.path} />
      </div>
    </>
  );
}

function NextForm({ structure, behaviour, subsystem }: { structure: Structure; behaviour: Behaviour; subsystem: Subsystem }) {
  const edit = useEdit();
  const { next } = behaviour;
  const failures = leadsFailures(structure, subsystem, behaviour);
  const targets = [...subsystem.behaviours.map((one) => one.name), "end"];
  const change = (at: number, part: Partial<Behaviour["next"][number]>) => edit(edits.changeNext(behaviour, at, part));
  const kept = keptCells(structure, subsystem);
  const other = targets.find((name) => name !== behaviour.name) ?? "end";
  return (
    <fieldset className="next">
      <legend>Then</legend>
      {failures && (
        <p className="faint">
          {failures.text}, after a failure that no entry names: on_error of the {failures.of}
        </p>
      )}
      {next.length === 0 && <p className="faint">the subsystem ends</p>}
      {next.map((entry, at) => (
        <div key={at} className="next-entry">
          <Field
            label={`Then ${at + 1}: to`}
            value={entry.to}
            choices={targets}
            onChange={(to) => change(at, { to: to.trim() })}
          />
          <Field
            label="when"
            mono
            value={entry.when}
            placeholder="always"
            choices={["error"]}
            onChange={(when) => change(at, { when })}
          />
          {(kept.length > 0 || entry.sets) && (
            <Field
              label="sets"
              mono
              value={entry.sets}
              placeholder="no memory"
              hint={`Memory when this entry is taken: ${exampleOf(kept)}`}
              onChange={(sets) => change(at, { sets })}
            />
          )}
        </div>
      ))}
      <button onClick={() => void edit(edits.addNext(behaviour, { to: other, when: "" }))}>Add what follows</button>
    </fieldset>
  );
}
