import { useStudio } from "../../hooks/use";
import { isGroupTemplate } from "../../model/structure/group_templates";
import {
  readTemplate,
  sharersOf,
  templatePath,
  type Agent,
  type Structure,
  type Subsystem,
} from "../../model/structure/structure";
import { keysNow, named } from "../../live/editor";
import * as edits from "../../model/text/edits";
import { Field } from "./field";
import { namespaceHint, nameProblem, SharedNote, useEdit } from "./form_parts";
import { OwnProblem } from "./use_problems";

/** The templates: each leads to its form. */
export function TemplatesForm({ structure }: { structure: Structure }) {
  const edit = useEdit();
  const { yaml } = structure;
  const names = yaml.keys(["templates"]);
  const add = () => {
    const added = named("member", keysNow(["templates"]), (name) => edits.insert(["templates"], name, edits.freshAgent));
    void edit(added.wish, () => templatePath(added.name));
  };
  return (
    <fieldset className="map-form">
      <legend>Templates</legend>
      <OwnProblem structure={structure} at={["templates"]} />
      {names.map((name) => {
        if (isGroupTemplate(yaml, name)) return <GroupTemplate key={name} structure={structure} name={name} />;
        const template = readTemplate(structure, name);
        const users = template ? sharersOf(structure, template).map((one) => one.name) : [];
        return (
          <div key={name} className="template">
            <TemplateLink name={name} />
            <p className="faint">{users.length > 0 ? `Used by ${users.join(", ")}` : "Not used"}</p>
          </div>
        );
      })}
      <p className="faint">An agent that uses a template shares its subsystems</p>
      <button onClick={add}>Add template</button>
    </fieldset>
  );
}

/** A template of a group: its behaviours have their forms in each group that uses it. */
function GroupTemplate({ structure, name }: { structure: Structure; name: string }) {
  const behaviours = structure.agents.flatMap((agent) => agent.subsystems.flatMap((one) => one.behaviours));
  const users = behaviours.filter((one) => one.template === name).map(({ path }) => path);
  return (
    <div className="template">
      <p>Template {name}, of a group</p>
      <p className="faint">{users.length > 0 ? `Used by ${users.join(", ")}` : "Not used"}</p>
    </div>
  );
}

/** Leads to the form of a template. */
export function TemplateLink({ name }: { name: string }) {
  const studio = useStudio();
  return (
    <button className="link" onClick={() => studio.view.set({ selected: templatePath(name) })}>
      Template {name}
    </button>
  );
}

/** The buttons that add a subsystem to an agent or a template. */
export function AddSubsystem({ agent }: { agent: Agent }) {
  const edit = useEdit();
  const names = agent.subsystems.map((one) => one.name);
  const add = (kind: Subsystem["kind"]) => {
    const wish = { control: "control", receptor: "sensor", effector: "motor" }[kind];
    const taken = kind === "control" ? () => [] : keysNow([...agent.body, "receptors"], [...agent.body, "effectors"]);
    const added = named(wish, taken, (name) => edits.addSubsystem(agent, kind, name));
    void edit(added.wish, () => `${agent.name}.${added.name}`);
  };
  return (
    <>
      {!names.includes("control") && <button onClick={() => add("control")}>Add control</button>}
      <button onClick={() => add("receptor")}>Add receptor</button>
      <button onClick={() => add("effector")}>Add effector</button>
    </>
  );
}

/** A template: its name, its subsystems, and the agents that use it. */
export function TemplateForm({ structure, template }: { structure: Structure; template: Agent }) {
  const edit = useEdit();
  const studio = useStudio();
  const { yaml } = structure;
  const name = String(template.yaml[1]);
  const used = ["agents", "templates"].some((part) =>
    yaml.keys([part]).some((key) => yaml.valueText([part, key, "use"]) === name),
  );
  const addAgent = () => {
    const added = named(name, keysNow(["agents"]), (agent) => edits.insert(["agents"], agent, `{ use: ${name} }`));
    void edit(added.wish, () => added.name);
  };
  return (
    <>
      <OwnProblem structure={structure} at={template.yaml} />
      <Field
        label="Name"
        value={name}
        wrong={nameProblem(name, yaml.keys(["templates"]))}
        hint={template.template ? "" : namespaceHint}
        onChange={(to) => edit(edits.rename(template.yaml, to), templatePath(to))}
      />
      {template.template && (
        <Field
          label="Another name for the template"
          value={template.template}
          choices={yaml.keys(["templates"]).filter((one) => one !== name)}
          onChange={(text) => text.trim() !== "" && edit(edits.set(template.yaml, "use", text))}
        />
      )}
      <SharedNote structure={structure} agent={template} />
      <div className="links">
        {template.subsystems.map((one) => (
          <button key={one.name} className="link" onClick={() => studio.view.set({ selected: one.path })}>
            {one.kind === "control" ? "Control" : `${one.kind === "receptor" ? "Receptor" : "Effector"} ${one.name}`}
          </button>
        ))}
      </div>
      <div className="buttons">
        <AddSubsystem agent={template} />
        <button onClick={addAgent}>Add an agent of it</button>
      </div>
      {!used && (
        <div className="buttons apart">
          <button className="danger" onClick={() => void edit(edits.remove(template.yaml), null)}>
            Remove template
          </button>
        </div>
      )}
    </>
  );
}
