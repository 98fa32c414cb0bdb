import { useState } from "react";
import { useStudio } from "../../hooks/use";
import { fieldOf, type FieldShape, type Schema } from "../../model/text/schema_fields";
import { freshValue, shapeOf, type Case, type ValueShape } from "../../model/text/value_shape";
import { lineText } from "../../model/text/list_text";
import type { Now } from "../../live/editor";
import type { Edit, EditValue } from "../../model/protocol";
import type { Structure } from "../../model/structure/structure";
import * as edits from "../../model/text/edits";
import type { YamlPath } from "../../model/text/yaml_text";
import { Choice, Field } from "./field";
import { useEdit } from "./form_parts";
import { ListForm } from "./list_form";
import { MapForm } from "./map_form";
import { OneField, titleOf } from "./one_field";
import { schema as root } from "./schema";
import { OwnProblem, useProblems } from "./use_problems";

/** The facts about the value of a key that the schema does not say. */
export interface Help {
  /** The word for one entry: "check". */
  one?: string;
  title?: string;
  hint?: string;
  mono?: boolean;
  /** Entries are opened one at a time. */
  folds?: boolean;
  /** Entries with short values: several fields in a row, and what they mean as tips. */
  compact?: boolean;
  /** A new entry, and its name in a map. */
  fresh?: { name?: string; value?: EditValue };
  /** Proposals while a value is typed, here or in an entry. */
  choices?: readonly string[];
  /** Proposals while the name of an entry is typed. */
  names?: readonly string[];
  /** The names of the parts of a list. */
  parts?: readonly string[];
}

/** Help by key, for all maps below. */
export type HelpByKey = { readonly [key: string]: Help };

interface ObjectFieldsProps {
  structure: Structure;
  at: YamlPath;
  /** The keys that the schema names. */
  shapes: readonly FieldShape[];
  /** Keys that have fields elsewhere. */
  without?: readonly string[];
  /** Keys that have fields although they are not there: all, or those named. */
  always?: "all" | readonly string[];
  /** Keys may have any name. */
  open?: boolean;
  /** The key that says of which kind the map is. Its field stays the same, with what is typed there, if that changes. */
  kind?: string | undefined;
  /** Keys that the shapes do not have are shown, so that they can be removed; otherwise they are shown elsewhere. */
  strays?: boolean;
  help?: HelpByKey;
  /** The map is left out with its last key; called when that happens. */
  onEmpty?: () => void;
}

/** A text, or what a function makes of the present value at a path. */
const presentText = (text: string | ((now: string) => string), { structure, at }: Now, where: YamlPath) =>
  typeof text === "string" ? text : text(lineText(structure.yaml, at(where)));

const anyText = (key: string): FieldShape => ({
  key,
  description: "",
  required: false,
  schema: {},
  choices: [],
  parts: 0,
  list: false,
  wrong: () => undefined,
});

/** The keys of a map, each as a field of its kind in the schema. An empty field leaves its key out. */
export function ObjectFields(props: ObjectFieldsProps) {
  const { structure, at, shapes, without = [], always = [], open, kind, strays = open, help = {}, onEmpty } = props;
  const edit = useEdit();
  const problem = useProblems(structure);
  const [wanted, want] = useState<readonly string[]>([]);
  const { yaml } = structure;
  const there = yaml.keys(at);
  const hidden = (key: string) => without.includes(key);
  const known = shapes.filter(({ key }) => !hidden(key));
  const shown = [
    ...known.filter(
      ({ key, required }) => required || there.includes(key) || wanted.includes(key) || always === "all" || always.includes(key),
    ),
    ...(strays ? there : []).filter((key) => !hidden(key) && !shapes.some((one) => one.key === key)).map(anyText),
  ];
  const left = known.filter((one) => !shown.includes(one));
  const label = ({ key, title }: FieldShape) => help[key]?.title ?? title ?? titleOf(key);
  const set = (key: string, text: string | ((now: string) => string), as: Edit["as"] = "scalar") =>
    edit((now) => {
      const value = presentText(text, now, [...at, key]);
      const left = now.structure.yaml.keys(now.at(at));
      const last = onEmpty && value.trim() === "" && left.length === 1 && left[0] === now.at([...at, key]).at(-1);
      if (last) onEmpty();
      return last ? edits.remove(at) : edits.set(at, key, value, as);
    });
  return (
    <>
      {shown.map((field) => {
        const where = [...at, field.key];
        const key = field.key === kind ? "" : field.key;
        const shape = shapeOf(field.schema, root, yaml.data(where));
        const value = lineText(yaml, where);
        if (shape.kind !== "line")
          return (
            <ValueForm
              key={key}
              structure={structure}
              at={where}
              shape={shape}
              title={label(field)}
              hint={help[field.key]?.hint ?? field.description}
              help={help}
              onEmpty={() => want([...wanted, field.key])}
            />
          );
        if (value.includes("\n")) return <InTheText key={key} structure={structure} at={where} title={label(field)} />;
        return (
          <div key={key}>
            <OneField
              shape={field}
              label={label(field)}
              mono={help[field.key]?.mono ?? false}
              value={value}
              choices={help[field.key]?.choices ?? []}
              parts={help[field.key]?.parts ?? []}
              problem={problem(where)}
              onChange={(text, as) => set(field.key, text, as)}
            />
            {yaml.range(where) && <MoreOf structure={structure} at={where} schema={field.schema} />}
          </div>
        );
      })}
      {left.length > 0 && (
        <Choice
          label="Add a setting"
          value=""
          choices={[{ value: "", title: "…" }, ...left.map((one) => ({ value: one.key, title: label(one) }))]}
          onChange={(key) => want([...wanted, key])}
        />
      )}
      {open && (
        <Field
          label="Another option"
          value=""
          placeholder="its name"
          wrong={(name) => (there.includes(name) ? `The name ${name} is taken here` : undefined)}
          onChange={(name) => set(name.trim(), "0")}
        />
      )}
    </>
  );
}

/** A value that is changed in the text: one of several lines, or an alias of a map or a list. */
function InTheText({ structure: { yaml }, at, title }: { structure: Structure; at: YamlPath; title: string }) {
  const studio = useStudio();
  return (
    <p>
      <button className="link" onClick={() => studio.showLine(yaml.line(at))}>
        {title}: {yaml.isAlias(at) && `${yaml.valueText(at)} `}in the text, line {yaml.line(at)}
      </button>
    </p>
  );
}

/** Writes a value of one line as a map, if the schema allows that: a map has more fields. */
function MoreOf({ structure, at, schema }: { structure: Structure; at: YamlPath; schema: Schema }) {
  const edit = useEdit();
  const { yaml } = structure;
  const shape = shapeOf(schema, root, yaml.data(at));
  if (shape.kind !== "line" || !shape.more) return null;
  const { key } = shape.more;
  const inFields = ({ structure: { yaml }, at: present }: Now) => {
    const now = lineText(yaml, present(at));
    return edits.replace(at, key && now ? { [key]: now } : {});
  };
  return (
    <button className="link" aria-label={`Give ${String(at.at(-1))} in several fields`} onClick={() => void edit(inFields)}>
      In several fields
    </button>
  );
}

interface ValueFormProps {
  structure: Structure;
  at: YamlPath;
  shape: Exclude<ValueShape, { kind: "line" }>;
  title: string;
  hint?: string;
  help?: HelpByKey;
  onEmpty?: () => void;
}

/** The form of a map or a list of the specification, made from its schema. */
export function ValueForm({ structure, at, shape, title, hint, help = {}, onEmpty }: ValueFormProps) {
  const own = help[String(at.at(-1))] ?? {};
  if (structure.yaml.isAlias(at)) return <InTheText structure={structure} at={at} title={title} />;
  if (shape.kind === "record" || shape.kind === "cases")
    return (
      <fieldset className="entry" aria-label={title}>
        <legend>{title}</legend>
        {hint && <p className="faint">{hint}</p>}
        <div className={own.compact ? "compact" : ""}>
          <Inside structure={structure} at={at} shape={shape} help={help} {...(onEmpty ? { onEmpty } : {})} />
        </div>
      </fieldset>
    );
  if (shape.kind === "list")
    return (
      <ListForm
        structure={structure}
        at={at}
        title={title}
        one={own.one ?? oneOf(String(at.at(-1)))}
        fresh={own.fresh?.value ?? freshValue(shape.of, root)}
        {...(hint ? { hint } : {})}
        fields={(index) => <Entry structure={structure} at={[...at, index]} schema={shape.of} help={help} />}
      />
    );
  const inOneLine = (name: string) => {
    const of = shapeOf(shape.of(name), root, structure.yaml.data([...at, name]));
    return of.kind === "line" || (of.kind === "record" && of.fields.length === 0);
  };
  return (
    <MapForm
      structure={structure}
      at={at}
      title={title}
      one={own.one ?? oneOf(String(at.at(-1)))}
      fresh={{ name: own.fresh?.name ?? "one", value: own.fresh?.value ?? freshValue(shape.of(""), root) }}
      wrong={shape.wrong}
      {...(hint ? { hint } : {})}
      {...(own.names ? { names: own.names } : {})}
      line={inOneLine}
      field={(name) => <OneEntry structure={structure} at={at} name={name} schema={shape.of(name)} own={own} />}
      folds={own.folds ?? false}
      fields={(name) => (
        <div className={own.compact ? "compact" : ""}>
          <Entry structure={structure} at={[...at, name]} schema={shape.of(name)} help={help} />
        </div>
      )}
    />
  );
}

interface OneEntryProps {
  structure: Structure;
  at: YamlPath;
  name: string;
  schema: Schema;
  own: Help;
}

/** An entry of a map whose value is one line. */
function OneEntry({ structure, at, name, schema, own }: OneEntryProps) {
  const edit = useEdit();
  const problem = useProblems(structure);
  const { yaml } = structure;
  const field = fieldOf(name, schema, root, true);
  const where = [...at, name];
  if (shapeOf(schema, root, yaml.data(where)).kind === "record" && !yaml.isAlias(where)) return <p className="mono">{name}</p>;
  return (
    <div>
      <OneField
        shape={{ ...field, description: "" }}
        label={name}
        value={lineText(yaml, where)}
        choices={own.choices ?? []}
        parts={[]}
        problem={problem(where)}
        onChange={(text, as) =>
          (typeof text !== "string" || text.trim() !== "") &&
          edit((now) => edits.set(at, name, presentText(text, now, where), as))
        }
      />
      {!yaml.map(where) && <MoreOf structure={structure} at={where} schema={schema} />}
    </div>
  );
}

/** "processes" as the word for one of them. */
const oneOf = (key: string) =>
  (/s$/.test(key) ? key.replace(/sses$/, "ss ").replace(/s$/, "").trim() : "entry").replaceAll("_", " ");

/** An entry of a map or a list: its fields, without a frame. */
function Entry({ structure, at, schema, help }: { structure: Structure; at: YamlPath; schema: Schema; help: HelpByKey }) {
  const shape = shapeOf(schema, root, structure.yaml.data(at));
  if (structure.yaml.isAlias(at)) return <InTheText structure={structure} at={at} title="This entry" />;
  if (shape.kind === "record" || shape.kind === "cases")
    return <Inside structure={structure} at={at} shape={shape} help={help} />;
  if (shape.kind === "line") return null;
  return <ValueForm structure={structure} at={at} shape={shape} title="Entries" help={help} />;
}

interface InsideProps {
  structure: Structure;
  at: YamlPath;
  shape: { kind: "record"; fields: readonly FieldShape[] } | { kind: "cases"; cases: readonly Case[] };
  help: HelpByKey;
  onEmpty?: () => void;
}

/** So many fields are all shown; of more, only those that are given or needed. */
const fewFields = 5;

function Inside({ structure, at, shape, help, onEmpty }: InsideProps) {
  const edit = useEdit();
  const { yaml } = structure;
  const keys = yaml.keys(at);
  const cases = shape.kind === "cases" ? shape.cases : [];
  const is = cases.find(({ key }) => keys.includes(key));
  const fields = shape.kind === "record" ? shape.fields : (is?.fields ?? []);
  const choose = (key: string) => {
    const next = cases.find((one) => one.key === key);
    if (!next) return false;
    return edit(({ structure: { yaml }, at: present }) => {
      const keys = yaml.keys(present(at));
      const is = cases.find(({ key }) => keys.includes(key));
      if (!is) return edits.set(at, key, "name");
      const gone = is.fields.filter(
        (one) => one.key !== is.key && keys.includes(one.key) && !next.fields.some((other) => other.key === one.key),
      );
      return [...gone.map((one) => edits.remove([...at, one.key])), edits.rename([...at, is.key], key)];
    });
  };
  // The fields of every case, such as the name, stay in their place.
  const first = is ? fields.findIndex(({ key }) => key === is.key) : 0;
  const part = (shapes: readonly FieldShape[], without: readonly FieldShape[] = []) => (
    <ObjectFields
      structure={structure}
      at={at}
      shapes={shapes}
      without={without.map(({ key }) => key)}
      kind={is?.key}
      strays={shapes.at(-1) === fields.at(-1)}
      always={fields.length <= fewFields ? "all" : []}
      help={help}
      {...(onEmpty ? { onEmpty } : {})}
    />
  );
  return (
    <>
      <OwnProblem structure={structure} at={at} />
      {first > 0 && part(fields.slice(0, first))}
      {cases.length > 0 && (
        <Choice
          label="Kind"
          value={is?.key ?? ""}
          choices={[
            ...(is ? [] : [{ value: "", title: "…" }]),
            ...cases.map(({ key }) => ({ value: key, title: key.replaceAll("_", " ") })),
          ]}
          onChange={choose}
        />
      )}
      {part(fields.slice(first), fields.slice(0, first))}
    </>
  );
}
