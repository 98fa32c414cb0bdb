import { set } from "../../model/text/edits";
import { targetsIn, type Structure } from "../../model/structure/structure";
import { Field } from "./field";
import { useEdit } from "./form_parts";
import { DriversForm } from "./driver_fields";
import { ParameterFields } from "./parameter_fields";
import { PropertiesForm } from "./properties_form";
import { StructureFields } from "./type_fields";
import { WorldForm } from "./world_form";
import { deployHelp, modelHelp } from "./form_help";
import { MapForm } from "./map_form";
import { ObjectFields } from "./object_fields";
import { OnErrorField } from "./on_error_field";
import { schema } from "./schema";
import { useTargets } from "./targets";
import { TemplatesForm } from "./templates_form";
import { fieldsOf } from "../../model/text/schema_fields";

const keyOf = (key: string) => fieldsOf(schema, schema).filter((one) => one.key === key);
const models = keyOf("models");
const deploy = keyOf("deploy");

/**
 * The parts that belong to no agent: the name, types, parameters, properties, templates, models, drivers,
 * the world and the processes.
 */
export function SystemForm({ structure }: { structure: Structure }) {
  const targets = useTargets();
  const edit = useEdit();
  return (
    <div className="inspect">
      <h2>System</h2>
      <Field label="Name" value={structure.system} onChange={(name) => edit(set([], "system", name))} />
      <OnErrorField
        structure={structure}
        at={[]}
        behaviours={structure.agents.flatMap(({ subsystems }) => subsystems.flatMap((one) => targetsIn(one)))}
      />
      <MapForm
        structure={structure}
        at={["types"]}
        title="Types"
        one="type"
        fresh={{ name: "Value", value: "{ x: float64 }" }}
        folds
        fields={(name) => <StructureFields structure={structure} at={["types", name]} />}
      />
      <MapForm
        structure={structure}
        at={["parameters"]}
        title="Parameters"
        one="parameter"
        fresh={{ name: "speed", value: "1.0" }}
        folds
        fields={(name) => <ParameterFields structure={structure} at={["parameters", name]} />}
      />
      <PropertiesForm structure={structure} />
      <TemplatesForm structure={structure} />
      <ObjectFields structure={structure} at={[]} shapes={models} always="all" help={modelHelp} />
      <WorldForm structure={structure} targets={targets} />
      <DriversForm structure={structure} where="world" targets={targets} />
      <DriversForm structure={structure} where="robot" targets={targets} />
      <ObjectFields structure={structure} at={[]} shapes={deploy} help={deployHelp(structure)} />
    </div>
  );
}
