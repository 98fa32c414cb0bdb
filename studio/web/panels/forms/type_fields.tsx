import { insert, remove, rename, replace, set } from "../../model/text/edits";
import { keysNow, named, type Now } from "../../live/editor";
import type { Edit, EditValue } from "../../model/protocol";
import { isGoal, keptCell } from "../../model/structure/kept_cells";
import { type Structure } from "../../model/structure/structure";
import { isNumber, plainTypes, typeParts, typeText, type TypeParts } from "../../model/text/type_text";
import type { YamlPath } from "../../model/text/yaml_text";
import { Choice, Field } from "./field";
import { nameProblem, useEdit } from "./form_parts";

interface TypeInputsProps {
  structure: Structure;
  value: string;
  /** The thing that has the type: "of left"; empty: the element of the form. */
  of?: string;
  /** Types that may not be chosen, such as the one that is described. */
  without?: readonly string[];
  /** change: gives the new type for the present one, which may have changed since it was drawn. */
  onChange: (change: (now: string) => string) => unknown;
}

/** Sets the type at a path to what `change` makes of it. */
export const changed =
  (at: YamlPath, change: (now: string) => string) =>
  (now: Now): Edit =>
    set(at.slice(0, -1), String(at.at(-1)), change(now.structure.yaml.valueText(now.at(at)) ?? ""));

const wrongNumber = (text: string) => (/^\d*$/.test(text.trim()) ? undefined : "A whole number");

const wrongLength = (text: string) =>
  /^(<=\s*\d+|\d*|each\s+\w+)$/.test(text.trim())
    ? undefined
    : "A whole number, <=16 for at most so many, or each robot for one of each member of a fleet";

/** A type, chosen by its parts: kind, number of elements, and unit. */
export function TypeInputs({ structure, value, of = "", without = [], onChange }: TypeInputsProps) {
  const parts = typeParts(value);
  const about = of ? { of } : {};
  if (!parts) return <Field label="Type" {...about} mono value={value} onChange={(text) => onChange(() => text)} />;
  const change = (part: Partial<TypeParts>) => onChange((now) => typeText({ ...(typeParts(now) ?? parts), ...part }));
  const types = [...structure.types.filter((one) => !without.includes(one)), ...plainTypes];
  // An unknown type stays until another one is chosen.
  const choices = (types.includes(parts.base) ? types : [parts.base, ...types]).map((one) => ({ value: one, title: one }));
  return (
    <div className="type-inputs">
      <Choice label="Type" {...about} value={parts.base} choices={choices} onChange={(base) => change({ base })} />
      {isNumber(parts.base) && (
        <Field label="Unit" {...about} value={parts.unit} placeholder="none" onChange={(unit) => change({ unit: unit.trim() })} />
      )}
      {parts.base === "string" && (
        <Field
          label="Letters"
          {...about}
          value={parts.most}
          wrong={wrongNumber}
          onChange={(most) => change({ most: most.trim() })}
        />
      )}
      {parts.base !== "string" && (
        <Field
          label="Length"
          {...about}
          value={parts.length}
          placeholder="no array"
          choices={structure.agents.flatMap(({ name, count }) => (count ? [`each ${name}`] : []))}
          wrong={wrongLength}
          onChange={(length) => change({ length: length.trim() })}
        />
      )}
    </div>
  );
}

/** The fields of a structure: a name and a type each. */
export function StructureFields({ structure, at }: { structure: Structure; at: YamlPath }) {
  const edit = useEdit();
  const { yaml } = structure;
  const names = yaml.keys(at);
  return (
    <>
      {names.map((name, index) => (
        <div key={index} className="type-row">
          <Field
            label={`Field ${index + 1}`}
            value={name}
            wrong={nameProblem(name, names)}
            onChange={(to) => edit(rename([...at, name], to))}
          />
          <TypeInputs
            structure={structure}
            of={`of ${name}`}
            without={[String(at.at(-1))]}
            value={yaml.valueText([...at, name]) ?? ""}
            onChange={(change) => edit(changed([...at, name], change))}
          />
          {names.length > 1 && (
            <button className="quiet" aria-label={`Remove the field ${name}`} onClick={() => void edit(remove([...at, name]))}>
              ×
            </button>
          )}
        </div>
      ))}
      <button onClick={() => void edit(named("value", keysNow(at), (name) => insert(at, name, "float64")).wish)}>
        Add field
      </button>
    </>
  );
}

/** Kinds of memory, and a fresh cell of each. */
const memoryKinds = [
  { value: "type", title: "any value, by functions", fresh: "int32" },
  { value: "values", title: "few values, by the net", fresh: { values: ["nobody", "a"] } },
  { value: "counts", title: "a counter, by the net", fresh: { counts: "0..4" } },
  { value: "goal", title: "the life of a goal, by the net", fresh: { goal: "out.goal", progress: "in.progress" } },
] as const;

/** A field of a subsystem's memory: its type and its value at the start, or the values that the net keeps. */
export function MemoryFields({ structure, at }: { structure: Structure; at: YamlPath }) {
  const edit = useEdit();
  const cell = keptCell(structure.yaml, at);
  const name = String(at.at(-1));
  const goal = isGoal(structure.yaml, at);
  const kind = goal ? "goal" : !cell ? "type" : cell.counts ? "counts" : "values";
  return (
    <>
      <Choice
        label="Holds"
        of={`of ${name}`}
        value={kind}
        choices={memoryKinds}
        onChange={(to) => to !== kind && edit(replace(at, memoryKinds.find((one) => one.value === to)!.fresh as EditValue))}
      />
      {!cell && !goal && <TypedMemory structure={structure} at={at} />}
      {goal &&
        (["goal", "progress"] as const).map((key) => (
          <Field
            key={key}
            label={key === "goal" ? "Ordered by" : "Told by"}
            of={`of ${name}`}
            mono
            value={structure.yaml.lineText([...at, key])}
            hint={
              key === "goal"
                ? "An output, out.NAME, whose type has call: uint32, and cancel: bool if it can be cancelled"
                : "An input, in.NAME, whose type has call: uint32 and state: uint8"
            }
            onChange={(text) => edit(set(at, key, text))}
          />
        ))}
      {cell && (
        <Field
          label={cell.counts ? "Counts" : "Values"}
          of={`of ${name}`}
          mono
          value={structure.yaml.lineText([...at, kind])}
          hint={
            cell.counts
              ? "From 0 to 4: 0..4. The lowest count is there at the start; sets changes it"
              : "[nobody, a, b]: the first value is there at the start; sets changes it"
          }
          onChange={(text) => edit(set(at, kind, text))}
        />
      )}
    </>
  );
}

function TypedMemory({ structure, at }: { structure: Structure; at: YamlPath }) {
  const edit = useEdit();
  const { yaml } = structure;
  const isMap = ({ structure, at: present }: Now) => structure.yaml.map(present(at)) !== undefined;
  const map = yaml.map(at) !== undefined;
  const name = String(at.at(-1));
  const type = yaml.valueText(map ? [...at, "type"] : at) ?? "";
  return (
    <>
      <TypeInputs
        structure={structure}
        value={type}
        of={`of ${name}`}
        onChange={(change) => edit((now) => changed(isMap(now) ? [...at, "type"] : at, change)(now))}
      />
      <Field
        label="Start"
        of={`of ${name}`}
        value={(map && yaml.valueText([...at, "initial"])) || ""}
        placeholder="zero"
        onChange={(text) =>
          edit((now) => {
            if (isMap(now)) return set(at, "initial", text);
            return replace(at, { type: now.structure.yaml.valueText(now.at(at)) ?? "", initial: text });
          })
        }
      />
    </>
  );
}
