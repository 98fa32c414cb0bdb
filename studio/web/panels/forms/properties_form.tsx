import { fieldsOf } from "../../model/text/schema_fields";
import type { Structure } from "../../model/structure/structure";
import { apply } from "../../model/text/yaml_text";
import { Choice, Field } from "./field";
import { useEdit } from "./form_parts";
import { listAsTyped, listAsWritten } from "./object_fields";
import { schema } from "./schema";

const kinds = fieldsOf({ $ref: "#/$defs/property" }, schema).filter(({ key }) => key !== "name");

/** The properties to verify besides the default ones. */
export function PropertiesForm({ structure }: { structure: Structure }) {
  const edit = useEdit();
  const { yaml } = structure;
  const all = yaml.seq(["properties"])?.items ?? [];
  const change = (edits: Parameters<typeof apply>[1]) => edit(apply(yaml.text, edits));
  return (
    <fieldset className="map-form">
      <legend>Properties</legend>
      {all.map((_, index) => {
        const at = ["properties", index];
        const is = kinds.find(({ key }) => yaml.pair([...at, key]));
        const text = is ? (yaml.valueText([...at, is.key]) ?? "") : "";
        const label = `Property ${index + 1}`;
        return (
          <fieldset key={index} className="entry" aria-label={label}>
            <legend>{label}</legend>
            <Field
              label="Name"
              value={yaml.valueText([...at, "name"]) ?? ""}
              onChange={(name) => change(yaml.set(at, "name", name))}
            />
            <Choice
              label="Kind"
              value={is?.key ?? ""}
              choices={[
                ...(is ? [] : [{ value: "", title: "…" }]),
                ...kinds.map(({ key }) => ({ value: key, title: key.replaceAll("_", " ") })),
              ]}
              onChange={(kind) => change(is ? yaml.renameKey([...at, is.key], kind) : yaml.set(at, kind, "robot.control.run"))}
            />
            {is && (
              <Field
                label="Markings"
                mono
                value={is.list ? listAsTyped(text) : text}
                hint={is.description}
                onChange={(to) => to.trim() && change(yaml.set(at, is.key, to, is.list ? listAsWritten : undefined))}
              />
            )}
            <button className="danger" onClick={() => change(yaml.remove(at))}>
              Remove the property
            </button>
          </fieldset>
        );
      })}
      <button
        onClick={() => {
          const path = structure.agents.flatMap((one) => one.subsystems).flatMap((one) => one.behaviours)[0]?.path;
          const text = `{ name: property ${all.length + 1}, always_reachable: ${path ?? "robot.control.run"} }`;
          change(yaml.append(["properties"], text));
        }}
      >
        Add property
      </button>
    </fieldset>
  );
}
