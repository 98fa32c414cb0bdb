import { useRef, type ReactNode } from "react";
import type { Structure } from "../../model/structure/structure";
import { append, remove } from "../../model/text/edits";
import type { YamlPath } from "../../model/text/yaml_text";
import type { EditValue } from "../../model/protocol";
import { useEdit } from "./form_parts";
import { OwnProblem } from "./use_problems";

interface ListFormProps {
  structure: Structure;
  /** The position of the list; it is made with its first item. */
  at: YamlPath;
  title: string;
  /** The word for one item: "check". */
  one: string;
  /** A new item. */
  fresh: EditValue;
  hint?: string;
  fields: (index: number) => ReactNode;
}

/** The items of a list of the specification, each with its fields. */
export function ListForm({ structure, at, title, one, fresh, hint, fields }: ListFormProps) {
  const edit = useEdit();
  const add = useRef<HTMLButtonElement>(null);
  const { yaml } = structure;
  return (
    <fieldset className="map-form">
      <legend>{title}</legend>
      <OwnProblem structure={structure} at={at} />
      {(yaml.seq(at)?.items ?? []).map((_, index) => {
        const label = `${one[0]!.toUpperCase()}${one.slice(1)} ${index + 1}`;
        return (
          <fieldset key={index} className="entry" aria-label={label}>
            <legend>{label}</legend>
            {fields(index)}
            <button
              className="danger"
              onClick={() => {
                void edit(remove([...at, index]));
                add.current?.focus();
              }}
            >
              Remove the {one}
            </button>
          </fieldset>
        );
      })}
      {hint && <p className="faint">{hint}</p>}
      <button ref={add} onClick={() => void edit(append(at, fresh))}>
        Add {one}
      </button>
    </fieldset>
  );
}
