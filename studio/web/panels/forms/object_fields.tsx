import { useState } from "react";
import type { FieldShape } from "../../model/text/schema_fields";
import type { Structure } from "../../model/structure/structure";
import { apply, scalarText, type YamlPath } from "../../model/text/yaml_text";
import { Choice, Field } from "./field";
import { useEdit } from "./form_parts";

interface ObjectFieldsProps {
  structure: Structure;
  at: YamlPath;
  /** The keys that the schema names. */
  shapes: readonly FieldShape[];
  /** Keys that have fields elsewhere. */
  without?: readonly string[];
  /** Keys may have any name; otherwise keys unknown to the shapes are shown elsewhere. */
  open?: boolean;
  /** Proposals while typing, by key. */
  choices?: { readonly [key: string]: readonly string[] };
  /** The names of the parts of a list, by key. */
  parts?: { readonly [key: string]: readonly string[] };
}

const titleOf = (key: string) => key[0]!.toUpperCase() + key.slice(1).replaceAll("_", " ");
const anyText = (key: string): FieldShape => ({
  key,
  description: "",
  required: false,
  choices: [],
  parts: 0,
  list: false,
  wrong: () => undefined,
});

/** The keys of a map, each as a field of its kind in the schema. An empty field leaves its key out. */
export function ObjectFields({ structure, at, shapes, without = [], open, choices = {}, parts = {} }: ObjectFieldsProps) {
  const edit = useEdit();
  const [wanted, want] = useState<readonly string[]>([]);
  const { yaml } = structure;
  const there = yaml.keys(at);
  const hidden = (key: string) => without.includes(key);
  const known = shapes.filter(({ key }) => !hidden(key));
  const shown = [
    ...known.filter(({ key, required }) => required || there.includes(key) || wanted.includes(key)),
    ...(open ? there : []).filter((key) => !hidden(key) && !shapes.some((one) => one.key === key)).map(anyText),
  ];
  const left = known.filter((one) => !shown.includes(one));
  const set = (key: string, text: string, as = scalarText) => edit(apply(yaml.text, yaml.set(at, key, text, as)));
  return (
    <>
      {shown.map((shape) => (
        <OneField
          key={shape.key}
          shape={shape}
          value={yaml.valueText([...at, shape.key]) ?? ""}
          choices={choices[shape.key] ?? []}
          parts={parts[shape.key] ?? []}
          onChange={(text, as) => set(shape.key, text, as)}
        />
      ))}
      {left.length > 0 && (
        <Choice
          label="Also give"
          value=""
          choices={[{ value: "", title: "…" }, ...left.map(({ key }) => ({ value: key, title: titleOf(key) }))]}
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

interface OneFieldProps {
  shape: FieldShape;
  value: string;
  choices: readonly string[];
  parts: readonly string[];
  onChange: (text: string, as?: (text: string) => string) => void;
}

/** "[a, b]" in the form for typing: "a, b". */
export const listAsTyped = (text: string) => text.replace(/^\[\s*(.*?)\s*\]$/s, "$1");
/** "a, b" in the form of the file; a single name is no list. */
export const listAsWritten = (text: string) =>
  /^[^[{"']*,[^[{"']*$/.test(text)
    ? `[${text
        .split(",")
        .map((one) => scalarText(one))
        .join(", ")}]`
    : scalarText(text);

function OneField({ shape, value, choices, parts, onChange }: OneFieldProps) {
  const { key, description, wrong } = shape;
  const label = titleOf(key);
  if (shape.choices.length > 0)
    return (
      <Choice
        label={label}
        value={value}
        choices={["", ...shape.choices].map((one) => ({ value: one, title: one || "as it is by default" }))}
        onChange={(text) => onChange(text)}
      />
    );
  if (shape.parts > 0) {
    const now = value ? listAsTyped(value).split(/\s*,\s*/) : [];
    const write = (at: number, text: string) => {
      const next = Array.from({ length: shape.parts }, (_, index) => (index === at ? text : (now[index] ?? "0")) || "0");
      onChange(`[${next.join(", ")}]`);
    };
    return (
      <fieldset className="tuple" aria-label={label}>
        <legend>{label}</legend>
        {Array.from({ length: shape.parts }, (_, at) => (
          <Field key={at} label={parts[at] ?? `${at + 1}`} value={now[at] ?? ""} onChange={(text) => write(at, text.trim())} />
        ))}
        <p className="faint">{description}</p>
      </fieldset>
    );
  }
  return (
    <Field
      label={label}
      value={shape.list ? listAsTyped(value) : value}
      wrong={wrong}
      {...(description ? { hint: description } : {})}
      {...(choices.length > 0 ? { choices } : {})}
      onChange={(text) => (shape.list ? onChange(text, listAsWritten) : onChange(text))}
    />
  );
}
