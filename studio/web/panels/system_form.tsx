import { useStudio } from "../hooks/use";
import { renameParameter, renameType, setField } from "../model/edits";
import type { Structure } from "../model/structure";
import { apply } from "../model/yaml_text";
import { Field } from "./field";
import { DriversForm } from "./forms/driver_fields";
import { ParameterFields } from "./forms/parameter_fields";
import { StructureFields } from "./forms/type_fields";
import { WorldForm } from "./forms/world_form";
import { MapForm } from "./map_form";

/** What belongs to no agent: the name, types, parameters, properties, templates, models, drivers and the world. */
export function SystemForm({ structure }: { structure: Structure }) {
  const studio = useStudio();
  const { yaml } = structure;
  const edit = (text: string) => studio.draft.edit(text, "edit");
  const properties = yaml.seq(["properties"])?.items ?? [];
  return (
    <div className="inspect">
      <h2>System</h2>
      <Field label="Name" value={structure.system} onChange={(name) => edit(setField(structure, [], "system", name))} />
      <MapForm
        structure={structure}
        at={["types"]}
        title="Types"
        one="type"
        fresh={{ name: "Value", value: "{ x: float64 }" }}
        fields={(name) => <StructureFields structure={structure} at={["types", name]} />}
        renamed={(text, from, to) => renameType(text, from, to)}
      />
      <MapForm
        structure={structure}
        at={["parameters"]}
        title="Parameters"
        one="parameter"
        fresh={{ name: "speed", value: "1.0" }}
        fields={(name) => <ParameterFields structure={structure} at={["parameters", name]} />}
        renamed={(text, from, to) => renameParameter(text, from, to)}
      />
      <fieldset className="map-form">
        <legend>Properties</legend>
        {properties.map((_, at) => {
          const value = yaml.valueText(["properties", at]) ?? "";
          return (
            <Field
              key={at}
              label={`Property ${at + 1}`}
              mono
              value={value.replace(/\s*\n\s*/g, " ")}
              onChange={(text) =>
                edit(apply(yaml.text, text.trim() ? yaml.replace(["properties", at], text) : yaml.remove(["properties", at])))
              }
            />
          );
        })}
        <p className="faint">{"{ name: it can always rest, always_reachable: robot.control.rest }"}</p>
        <button
          onClick={() => {
            const path = structure.agents.flatMap((one) => one.subsystems).flatMap((one) => one.behaviours)[0]?.path;
            const text = `{ name: property ${properties.length + 1}, always_reachable: ${path ?? "robot.control.run"} }`;
            edit(apply(yaml.text, yaml.append(["properties"], text)));
          }}
        >
          Add property
        </button>
      </fieldset>
      <MapForm
        structure={structure}
        at={["templates"]}
        title="Templates"
        one="template"
        fresh={{ name: "member", value: "{ control: { rate: 10 Hz, behaviours: { run: {} } } }" }}
        hint="An agent that uses a template shares its subsystems"
      />
      <MapForm
        structure={structure}
        at={["models"]}
        title="Communication models"
        one="model"
        fresh={{ name: "own", value: "{}" }}
      />
      <WorldForm structure={structure} />
      <DriversForm structure={structure} where="world" />
      <DriversForm structure={structure} where="robot" />
    </div>
  );
}
