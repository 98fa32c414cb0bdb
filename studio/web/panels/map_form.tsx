import { useState } from "react";
import { useStudio } from "../hooks/use";
import { freeName, isName } from "../model/edits";
import type { Structure } from "../model/structure";
import { apply, scalarText, type YamlPath } from "../model/yaml_text";
import { Field } from "./field";

interface MapFormProps {
  structure: Structure;
  /** Where the map is; it is made with its first entry. */
  at: YamlPath;
  title: string;
  /** What one entry is called: "type". */
  one: string;
  /** A new entry, as text of the file. */
  fresh: { name: string; value: string };
  hint?: string;
  choices?: readonly string[];
  /** Names are paths and not plain names. */
  paths?: boolean;
  /** What follows from a new name, besides the key itself: the text with it. */
  renamed?: (text: string, from: string, to: string) => string;
}

/** The entries of a map of the specification: a name and a value each. */
export function MapForm({ structure, at, title, one, fresh, hint, choices, paths, renamed }: MapFormProps) {
  const studio = useStudio();
  const { yaml } = structure;
  const [opened, setOpened] = useState<string | null>(null);
  const names = yaml.keys(at);
  const change = (edits: Parameters<typeof apply>[1]) => studio.draft.edit(apply(yaml.text, edits), "edit");
  const problem = (own: string) => (text: string) =>
    text !== own && names.includes(text)
      ? `The name ${text} is taken here`
      : paths || isName(text)
        ? undefined
        : "Letters, digits and single underscores, beginning with a letter";
  const rename = (from: string, to: string) => {
    const text = renamed ? renamed(yaml.text, from, to) : yaml.text;
    const edits = yaml.renameKey([...at, from], to);
    studio.draft.edit(text === yaml.text ? apply(yaml.text, edits) : text, "edit");
    setOpened(to);
  };
  return (
    <fieldset className="map-form">
      <legend>{title}</legend>
      {names.map((name) => {
        const value = yaml.valueText([...at, name]) ?? "";
        const long = value.includes("\n");
        return (
          <div key={name} className="map-entry">
            {long ? (
              <button className="link" onClick={() => studio.showLine(yaml.line([...at, name]))}>
                {name}: in the text, line {yaml.line([...at, name])}
              </button>
            ) : (
              <Field
                label={name}
                mono
                value={value}
                {...(choices ? { choices } : {})}
                onChange={(text) => change(yaml.set(at, name, text))}
              />
            )}
            <button
              className="quiet"
              aria-label={`Rename or remove ${name}`}
              aria-expanded={opened === name}
              onClick={() => setOpened(opened === name ? null : name)}
            >
              …
            </button>
            {opened === name && (
              <div className="map-more">
                <Field label={`New name of ${name}`} value={name} wrong={problem(name)} onChange={(to) => rename(name, to)} />
                <button className="danger" onClick={() => change(yaml.remove([...at, name]))}>
                  Remove {name}
                </button>
              </div>
            )}
          </div>
        );
      })}
      {hint && <p className="faint">{hint}</p>}
      <button
        onClick={() => {
          const name = freeName(fresh.name, names);
          change(yaml.insert(at, paths ? scalarText(name) : name, fresh.value));
          setOpened(name);
        }}
      >
        Add {one}
      </button>
    </fieldset>
  );
}
