import type { FieldShape } from "../../model/text/schema_fields";
import { listAsTyped } from "../../model/text/list_text";
import type { Edit } from "../../model/protocol";
import { Choice, Field } from "./field";

/** "per_second" as a label: "Per second". */
export const titleOf = (key: string) => (key[0] ?? "").toUpperCase() + key.slice(1).replaceAll("_", " ");

interface OneFieldProps {
  shape: FieldShape;
  value: string;
  choices: readonly string[];
  parts: readonly string[];
  /** The label, if it is not the key. */
  label?: string;
  mono?: boolean;
  problem?: string | undefined;
  /** text: the new value, or a function that gives it for the present one, which may have changed since it was drawn. */
  onChange: (text: string | ((now: string) => string), as?: Edit["as"]) => unknown;
}

/** A value of one line, as its schema says: a choice, a list, parts with a field each, or a text. */
export function OneField({ shape, value, choices, parts, label = titleOf(shape.key), mono, problem, onChange }: OneFieldProps) {
  const { description, wrong } = shape;
  const known = value === "" || shape.choices.includes(value);
  if (shape.choices.length > 0)
    return (
      <Choice
        label={label}
        value={value}
        choices={[...(shape.required && value ? [] : [""]), ...shape.choices, ...(known ? [] : [value])].map((one) => ({
          value: one,
          title: one || (shape.required ? "…" : "default"),
        }))}
        {...(description ? { hint: description } : {})}
        problem={problem}
        onChange={(text) => onChange(text)}
      />
    );
  if (shape.parts > 0) {
    const partsIn = (value: string) => (value ? listAsTyped(value).split(/\s*,\s*/) : []);
    const now = partsIn(value);
    const write = (at: number, text: string) =>
      onChange((value) => {
        const now = partsIn(value);
        const next = Array.from({ length: shape.parts }, (_, index) => (index === at ? text : (now[index] ?? "0")) || "0");
        return `[${next.join(", ")}]`;
      });
    return (
      <fieldset className="tuple" aria-label={label}>
        <legend>{label}</legend>
        {Array.from({ length: shape.parts }, (_, at) => (
          <Field key={at} label={parts[at] ?? `${at + 1}`} value={now[at] ?? ""} onChange={(text) => write(at, text.trim())} />
        ))}
        <p className={problem ? "problem-hint" : "faint"}>{problem ?? description}</p>
      </fieldset>
    );
  }
  return (
    <Field
      label={label}
      value={shape.list ? listAsTyped(value) : value}
      wrong={wrong}
      {...(mono ? { mono } : {})}
      problem={problem}
      {...(description ? { hint: description } : {})}
      {...(choices.length > 0 ? { choices } : {})}
      onChange={(text) => (shape.list ? onChange(text, "list") : onChange(text))}
    />
  );
}
