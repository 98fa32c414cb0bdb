import { useStudio } from "../../hooks/use";
import { renameParameter, renameType, setField } from "../../model/text/edits";
import type { Structure } from "../../model/structure/structure";
import { Field } from "./field";
import { DriversForm } from "./driver_fields";
import { ParameterFields } from "./parameter_fields";
import { PropertiesForm } from "./properties_form";
import { StructureFields } from "./type_fields";
import { WorldForm } from "./world_form";
import { MapForm } from "./map_form";

/**
 * The parts that belong to no agent: the name, types, parameters, properties, templates, models, drivers and
 * the world.
 */
export function SystemForm({ structure }: { structure: Structure }) {
  const studio = useStudio();
  const edit = (text: string) => studio.draft.edit(text, "edit");
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
      <PropertiesForm structure={structure} />
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
