import { useStore, useStudio } from "../../hooks/use";
import { setField } from "../../model/text/edits";
import { fieldsOf } from "../../model/text/schema_fields";
import type { Structure } from "../../model/structure/structure";
import { apply } from "../../model/text/yaml_text";
import { Field } from "./field";
import { useEdit } from "./form_parts";
import { MapForm } from "./map_form";
import { ObjectFields } from "./object_fields";
import { schema } from "./schema";

const trackShapes = fieldsOf({ $ref: "#/$defs/track" }, schema);

/** The simulated world and its floor. Its drivers have a form of their own. */
export function WorldForm({ structure }: { structure: Structure }) {
  const edit = useEdit();
  const studio = useStudio();
  const worlds = useStore(studio.project, (all) => all.project?.worlds ?? []);
  const { yaml } = structure;
  const world = yaml.valueText(["simulation", "world"]) ?? "";
  const tracks = worlds.find(({ name }) => name === world.split("/").at(-1))?.tracks ?? worlds[0]?.tracks ?? [];
  const at = ["simulation", "track"];
  const has = yaml.pair(at) !== undefined;
  return (
    <>
      <fieldset className="map-form">
        <legend>Simulated world</legend>
        <Field
          label="World"
          value={world}
          placeholder="none"
          choices={worlds.map(({ name }) => name)}
          hint="MuJoCo model (XML), beside the specification or one that comes with Tessera"
          onChange={(text) => edit(setField(structure, ["simulation"], "world", text))}
        />
        {has && (
          <fieldset className="entry" aria-label="Track">
            <legend>Track</legend>
            <ObjectFields
              structure={structure}
              at={at}
              shapes={trackShapes}
              choices={{ image: tracks }}
              parts={{ start: ["x", "y", "Heading"] }}
            />
            <button className="danger" onClick={() => edit(apply(yaml.text, yaml.remove(at)))}>
              Remove the track
            </button>
          </fieldset>
        )}
        {world && !has && (
          <button
            onClick={() =>
              edit(apply(yaml.text, yaml.insert(["simulation"], "track", `{ image: ${tracks.at(-1) ?? "floor.png"} }`)))
            }
          >
            Add a track
          </button>
        )}
      </fieldset>
      {yaml.keys(["simulation"]).some((key) => !elsewhere.includes(key)) && (
        <MapForm structure={structure} at={["simulation"]} title="More of the simulation" one="entry" without={elsewhere} />
      )}
    </>
  );
}

/** Entries of `simulation` that have forms of their own. */
const elsewhere = ["world", "track", "drivers"];
