import { useState, type ReactNode } from "react";
import { useStudio } from "../../hooks/use";
import { keysNow, named } from "../../live/editor";
import type { EditValue } from "../../model/protocol";
import { insert, remove, rename, set } from "../../model/text/edits";
import type { Structure } from "../../model/structure/structure";
import type { YamlPath } from "../../model/text/yaml_text";
import { Field } from "./field";
import { nameProblem, useEdit } from "./form_parts";
import { OwnProblem, useProblems } from "./use_problems";

interface MapFormProps {
  structure: Structure;
  /** The position of the map; it is made with its first entry. */
  at: YamlPath;
  title: string;
  /** The word for one entry: "type". */
  one: string;
  /** A new entry; none: entries are not added here. */
  fresh?: { name: string; value: EditValue };
  hint?: string;
  /** Why a name cannot be used; plain names can, unless this says otherwise. */
  wrong?: (name: string) => string | undefined;
  /** Proposals while a name is typed. */
  names?: readonly string[];
  /** Entries that are shown elsewhere. */
  without?: readonly string[];
  /** The fields of an entry; without them it is shown as text. */
  fields?: (name: string) => ReactNode;
  /** Entries are opened one at a time; the others are shown in a line. */
  folds?: boolean;
  /** Whether an entry is shown in one line in spite of `fields`. */
  line?: (name: string) => boolean;
  /** The field of such an entry, if it is more than its text. */
  field?: (name: string) => ReactNode;
}

/** The entries of a map of the specification: each has a name, and fields or a value. */
export function MapForm(props: MapFormProps) {
  const { structure, at, title, one, fresh, hint, without = [] } = props;
  const edit = useEdit();
  const { yaml } = structure;
  const [opened, open] = useState<string | null>(null);
  // A renamed entry keeps its form, with what is typed there.
  const [forms] = useState(new Map<string, string>());
  const taken = yaml.keys(at);
  return (
    <fieldset className="map-form">
      <legend>{title}</legend>
      <OwnProblem structure={structure} at={at} />
      {taken
        .filter((name) => !without.includes(name))
        .map((name) => (
          <Entry
            key={forms.get(name) ?? name}
            of={props}
            name={name}
            taken={taken}
            opened={opened === name}
            open={open}
            renamed={(to) => forms.set(to, forms.get(name) ?? name)}
          />
        ))}
      {hint && <p className="faint">{hint}</p>}
      {fresh && (
        <button
          onClick={() => {
            const added = named(fresh.name, keysNow(at), (name) => insert(at, name, fresh.value));
            void edit(added.wish).then(() => open(added.name));
          }}
        >
          Add {one}
        </button>
      )}
    </fieldset>
  );
}

interface EntryProps {
  of: MapFormProps;
  name: string;
  taken: readonly string[];
  opened: boolean;
  open: (name: string | null) => void;
  renamed: (to: string) => void;
}

function Entry({ of, name, taken, opened, open, renamed }: EntryProps) {
  const { structure, at, names, line, field } = of;
  const fields = line?.(name) ? undefined : of.fields;
  const studio = useStudio();
  const problem = useProblems(structure);
  const { yaml } = structure;
  const where = [...at, name];
  const edit = useEdit();
  const renameTo = async (to: string) => {
    // With the new name, before it is drawn.
    const begin = () => {
      renamed(to);
      open(to);
      return undefined;
    };
    await edit(rename(where, to), begin);
  };
  const wrong = (text: string) =>
    of.wrong
      ? text !== name && taken.includes(text)
        ? `The name ${text} is taken here`
        : of.wrong(text)
      : nameProblem(name, taken)(text);
  const value = yaml.valueText(where) ?? "";
  const asText = value.includes("\n") ? (
    <button className="link" onClick={() => studio.showLine(yaml.line(where))}>
      {name}: in the text, line {yaml.line(where)}
    </button>
  ) : (
    <Field
      label={fields ? `${name} as text` : name}
      mono
      value={value}
      problem={fields ? undefined : problem(where)}
      onChange={(text) => edit(set(at, name, text))}
    />
  );
  const unfolded = !of.folds || opened;
  const more = (
    <button
      className="quiet"
      aria-label={of.folds ? `Change ${name}` : `Rename or remove ${name}`}
      aria-expanded={opened}
      onClick={() => open(opened ? null : name)}
    >
      …
    </button>
  );
  const opening = opened && (
    <div className="map-more">
      <Field
        label={`New name of ${name}`}
        value={name}
        wrong={wrong}
        {...(names ? { choices: names } : {})}
        onChange={renameTo}
      />
      {fields && asText}
      <button className="danger" onClick={() => void edit(remove(where))}>
        Remove {name}
      </button>
    </div>
  );
  if (fields)
    return (
      <fieldset className="entry" aria-label={name}>
        <legend>
          <span className="mono">{name}</span> {more}
        </legend>
        {opening}
        {unfolded ? fields(name) : <p className="summary">{yaml.lineText(where)}</p>}
      </fieldset>
    );
  return (
    <div className="map-entry">
      {field?.(name) ?? asText}
      {more}
      {opening}
    </div>
  );
}
