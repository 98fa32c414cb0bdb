import { useEffect, useRef } from "react";
import { useStore, useStudio } from "../../hooks/use";
import { keysNow, named } from "../../live/editor";
import * as edits from "../../model/text/edits";
import { nameList } from "../../model/text/name_list";
import { exampleOf, goalsOf, keptCells } from "../../model/structure/kept_cells";
import { groupTemplates, takenBy } from "../../model/structure/group_templates";
import {
  leadsFailures,
  listAround,
  nextEntryOf,
  targetsIn,
  withoutIndex,
  type Behaviour,
  type Structure,
  type Subsystem,
} from "../../model/structure/structure";
import { CodeInForm } from "./code_form";
import { Choice, Field } from "./field";
import { nameProblem, namesIn, Remove, useEdit } from "./form_parts";
import { useProblems } from "./use_problems";

interface Shown {
  structure: Structure;
  behaviour: Behaviour;
  subsystem: Subsystem;
}

export const BehaviourForm = (shown: Shown) => (shown.behaviour.isGroup ? <GroupForm {...shown} /> : <OneForm {...shown} />);

function NameField({ behaviour, subsystem }: Shown) {
  const edit = useEdit();
  return (
    <Field
      label="Name"
      value={behaviour.name}
      wrong={nameProblem(behaviour.name, namesIn(subsystem, behaviour.group))}
      hint={
        behaviour.isGroup
          ? "The C++ functions of what is in it begin with its name, and change with it"
          : behaviour.group
            ? `Its C++ function is ${behaviour.function}, and changes with it`
            : "Its C++ function has the same name, and changes with it"
      }
      onChange={(name) => edit(edits.rename(behaviour.yaml, name), `${behaviour.group || subsystem.path}.${name}`)}
    />
  );
}

/** The group that a behaviour is in. A choice of another one moves it there. */
function InGroup({ behaviour, subsystem }: Shown) {
  const edit = useEdit();
  const own = (path: string) => path.slice(subsystem.path.length + 1);
  const groups = subsystem.behaviours.filter(
    (one) =>
      one.isGroup &&
      !one.template &&
      !one.inTemplate &&
      one.path !== behaviour.path &&
      !one.path.startsWith(`${behaviour.path}.`),
  );
  if (groups.length === 0 || behaviour.inTemplate) return null;
  return (
    <Choice
      label="In the group"
      value={own(behaviour.group)}
      choices={[{ value: "", title: "none" }, ...groups.map(({ path }) => ({ value: own(path), title: own(path) }))]}
      onChange={(group) =>
        edit(edits.moveTo(behaviour, group), `${group ? `${subsystem.path}.${group}` : subsystem.path}.${behaviour.name}`)
      }
    />
  );
}

/** The template of a group, and what stands for the names that it takes. */
function Template({ structure, behaviour }: Shown) {
  const edit = useEdit();
  const { yaml } = structure;
  if (!behaviour.template) return null;
  return (
    <>
      <Field
        label="Template"
        value={behaviour.template}
        choices={groupTemplates(yaml)}
        hint="Its behaviours stand under templates; what is set here comes instead of what it says"
        onChange={(text) => text.trim() !== "" && edit(edits.set(behaviour.yaml, "use", text))}
      />
      {takenBy(yaml, behaviour.template).map((name) => (
        <Field
          key={name}
          label={name}
          mono
          value={yaml.valueText([...behaviour.yaml, "with", name]) ?? ""}
          placeholder="not given"
          hint={`The name or number that stands for ${name} in ${behaviour.template}`}
          onChange={(text) => edit(edits.set([...behaviour.yaml, "with"], name, text))}
        />
      ))}
    </>
  );
}

/** A behaviour that stands in a template is the same in each group that uses it. */
const TemplateNote = ({ behaviour }: { behaviour: Behaviour }) =>
  behaviour.inTemplate ? (
    <p className="faint">written in template {behaviour.inTemplate}: a change is one for each group that uses it</p>
  ) : null;

/** A group has behaviours instead of conditions and communication. */
function GroupForm(shown: Shown) {
  const { structure, behaviour, subsystem } = shown;
  const edit = useEdit();
  const field = (key: string) => structure.yaml.lineText([...behaviour.yaml, key]);
  const set = (key: string) => (text: string) => edit(edits.set(behaviour.yaml, key, text));
  const inside = targetsIn(subsystem, behaviour.path);
  const add = (wish: string, adding: typeof edits.addBehaviour) => {
    const added = named(wish, keysNow([...behaviour.yaml, "behaviours"]), (name) => adding(behaviour, name));
    void edit(added.wish, () => `${behaviour.path}.${added.name}`);
  };
  return (
    <>
      <p className="faint">group of behaviours: {inside.join(", ")}</p>
      <TemplateNote behaviour={behaviour} />
      <NameField {...shown} />
      <InGroup {...shown} />
      <Template {...shown} />
      <Field
        label="Starts with"
        value={field("start")}
        placeholder={inside[0] ?? "the first one"}
        choices={inside}
        onChange={set("start")}
      />
      <Field
        label="Until"
        mono
        value={field("until")}
        placeholder="a behaviour in it leads to end"
        hint="A condition, asked after each iteration in the group: it leaves the group"
        onChange={set("until")}
      />
      <Field
        label="On error"
        value={field("on_error")}
        placeholder="leave the group"
        choices={inside}
        hint="Where failures in it lead that no behaviour in it names"
        onChange={set("on_error")}
      />
      <Sets {...shown} what="group" />
      <NextForm structure={structure} behaviour={behaviour} subsystem={subsystem} />
      {!behaviour.template && (
        <div className="buttons">
          <button onClick={() => add("act", edits.addBehaviour)}>Add behaviour</button>
          <button onClick={() => add("group", edits.addGroup)}>Add group</button>
        </div>
      )}
      <Remove what="group" at={behaviour.yaml} select={behaviour.group || subsystem.path} />
    </>
  );
}

/** The field of what memory with few values becomes when a behaviour or a group begins. */
function Sets({ structure, behaviour, subsystem, what }: Shown & { what: string }) {
  const edit = useEdit();
  const kept = keptCells(structure, subsystem);
  if (kept.length === 0 && !behaviour.sets) return null;
  return (
    <Field
      label="Sets"
      mono
      value={behaviour.sets}
      placeholder="no memory"
      hint={`Memory when the ${what} begins: ${exampleOf(kept)}`}
      onChange={(text) => edit(edits.set(behaviour.yaml, "sets", text))}
    />
  );
}

/** The goal that the beginning of a behaviour orders, and whether leaving it cancels the goal. */
function Orders({ structure, behaviour, subsystem }: Shown) {
  const edit = useEdit();
  const field = (key: string) => structure.yaml.lineText([...behaviour.yaml, key]);
  const goals = goalsOf(structure, subsystem);
  const orders = field("orders"),
    cancels = field("cancel");
  if (goals.length === 0 && !orders && !cancels) return null;
  return (
    <>
      <Field
        label="Orders"
        value={orders}
        placeholder="no goal"
        choices={goals}
        hint="The goal that is ordered anew when the behaviour begins"
        onChange={(text) => edit(edits.set(behaviour.yaml, "orders", text))}
      />
      {(orders || cancels) && (
        <Choice
          label="Cancel on leaving"
          value={cancels === "on_leave" ? "on_leave" : ""}
          choices={[
            { value: "", title: "the goal goes on" },
            { value: "on_leave", title: "a goal that has not ended is cancelled" },
          ]}
          onChange={(value) => edit(edits.set(behaviour.yaml, "cancel", value))}
        />
      )}
    </>
  );
}

const listHint = "Names in this order: a, b; or +a, -b to change the list of the subsystem";

function OneForm(shown: Shown) {
  const { structure, behaviour, subsystem } = shown;
  const edit = useEdit();
  const field = (key: string) => structure.yaml.lineText([...behaviour.yaml, key]);
  const set = (key: string) => (text: string) => edit(edits.set(behaviour.yaml, key, text));
  // Groups have none for each member of a fleet.
  const fleets = behaviour.group ? [] : structure.agents.filter(({ count }) => count).map(({ name }) => name);
  const list = (key: "send" | "receive", all: string) => {
    const around = listAround(structure, subsystem, key);
    return around ? `${around}, as the subsystem` : all;
  };
  const problem = useProblems(structure);
  /** The names that such a list can have. A behaviour for each member of a fleet uses its own part of an array. */
  const buffers = (direction: "input" | "output") =>
    subsystem.buffers
      .filter((one) => one.direction === direction)
      .map(({ name, type }) => (behaviour.for && type.includes(`[${behaviour.for}]`) ? `${name}[i]` : name));
  return (
    <>
      <TemplateNote behaviour={behaviour} />
      <NameField {...shown} />
      <InGroup {...shown} />
      {(fleets.length > 0 || behaviour.for) && (
        <Field
          label="For"
          value={behaviour.for}
          placeholder="one behaviour"
          choices={fleets.map((fleet) => `each ${fleet}`)}
          hint="One for each member of a fleet; i is the number of the member"
          onChange={set("for")}
        />
      )}
      <Field
        label="Terminal condition"
        mono
        value={behaviour.terminal}
        placeholder="never"
        hint="C++ over in, out, memory, parameters; or the name of a condition of the subsystem"
        onChange={set("terminal")}
      />
      <Field label="Error condition" mono value={behaviour.error} placeholder="never" onChange={set("error")} />
      <Sets {...shown} what="behaviour" />
      <Orders {...shown} />
      <NextForm structure={structure} behaviour={behaviour} subsystem={subsystem} />
      <Field
        label="Sends"
        mono
        value={field("send")}
        placeholder={list("send", "all outputs")}
        choices={buffers("output")}
        problem={problem([...behaviour.yaml, "send"])}
        hint={listHint}
        onChange={(text) => set("send")(nameList(text))}
      />
      <Field
        label="Receives"
        mono
        value={field("receive")}
        placeholder={list("receive", "all inputs")}
        choices={buffers("input")}
        problem={problem([...behaviour.yaml, "receive"])}
        hint={listHint}
        onChange={(text) => set("receive")(nameList(text))}
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
      <CodeInForm behaviour={behaviour} subsystem={subsystem} />
      <Field
        label="Takes"
        value={field("takes")}
        placeholder="no simulated time"
        problem={problem([...behaviour.yaml, "takes"])}
        hint="1..3 ms, { normal: [2 ms, 0.3 ms], within: 1..3 ms } or { measured: run.tsr, within: 1..3 ms }"
        onChange={set("takes")}
      />
      <Field
        label="Uses"
        value={field("uses")}
        placeholder="nothing that is counted"
        problem={problem([...behaviour.yaml, "uses"])}
        hint="Amounts per time: { energy: 12 W, bandwidth: 3 MB/s }"
        onChange={set("uses")}
      />
      <Remove what="behaviour" at={behaviour.yaml} select={behaviour.group || subsystem.path} />
    </>
  );
}

function NextForm({ structure, behaviour, subsystem }: Shown) {
  const edit = useEdit();
  // The entry whose arrow is selected.
  const chosen = useStore(useStudio().view, ({ selected }) => nextEntryOf(selected ?? ""));
  const own = useRef<HTMLFieldSetElement>(null);
  useEffect(() => {
    if (chosen !== undefined) own.current?.querySelector(".chosen")?.scrollIntoView({ block: "nearest" });
  }, [chosen, behaviour.path]);
  const { next } = behaviour;
  const failures = leadsFailures(structure, subsystem, behaviour);
  const targets = [...targetsIn(subsystem, behaviour.group, "[i]"), "end"];
  const change = (at: number, part: Partial<Behaviour["next"][number]>) => edit(edits.changeNext(behaviour, at, part));
  const kept = keptCells(structure, subsystem);
  const other = targets.find((name) => withoutIndex(name) !== behaviour.name) ?? "end";
  return (
    <fieldset className="next" ref={own}>
      <legend>Then</legend>
      {failures && (
        <p className="faint">
          {failures.text}, after a failure that no entry names: on_error of the {failures.of}
        </p>
      )}
      {next.length === 0 && <p className="faint">{behaviour.group ? "the group is left" : "the subsystem ends"}</p>}
      {next.map((entry, at) => (
        <div key={at} className={`next-entry${at === chosen ? " chosen" : ""}`} aria-current={at === chosen || undefined}>
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
            choices={behaviour.isGroup ? ["error", "until"] : ["error"]}
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
      <button onClick={() => void edit(edits.addNext(behaviour, { to: other, when: "" }))}>Add a next behaviour</button>
    </fieldset>
  );
}
