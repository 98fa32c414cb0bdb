import { useStore, useStudio } from "../../hooks/use";
import { insert, remove, set } from "../../model/text/edits";
import { fieldsOf } from "../../model/text/schema_fields";
import type { Structure } from "../../model/structure/structure";
import { Field } from "./field";
import { useEdit } from "./form_parts";
import { worldHelp } from "./form_help";
import { ObjectFields } from "./object_fields";
import { schema } from "./schema";
import type { Targets } from "./targets";

const shapes = fieldsOf({ $ref: "#/properties/simulation" }, schema);
const trackShapes = fieldsOf({ $ref: "#/$defs/track" }, schema);

/** The simulated world and its floor. Its drivers have a form of their own. */
export function WorldForm({ structure, targets }: { structure: Structure; targets: Targets }) {
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
          onChange={(text) => edit(set(["simulation"], "world", text))}
        />
        {has && (
          <fieldset className="entry" aria-label="Track">
            <legend>Track</legend>
            <ObjectFields
              structure={structure}
              at={at}
              shapes={trackShapes}
              help={{ image: { choices: tracks }, start: { parts: ["x", "y", "Heading"] } }}
            />
            <button className="danger" onClick={() => void edit(remove(at))}>
              Remove the track
            </button>
          </fieldset>
        )}
        {world && !has && (
          <button onClick={() => void edit(insert(["simulation"], "track", `{ image: ${tracks.at(-1) ?? "floor.png"} }`))}>
            Add a track
          </button>
        )}
      </fieldset>
      <ObjectFields
        structure={structure}
        at={["simulation"]}
        shapes={shapes}
        without={elsewhere}
        always={world ? ["models", "checks", "measures"] : []}
        help={worldHelp(structure, targets)}
      />
    </>
  );
}

/** Entries of `simulation` that have forms of their own. */
const elsewhere = ["world", "track", "drivers"];
