import { set } from "../../model/text/edits";
import { onError, type Structure } from "../../model/structure/structure";
import type { YamlPath } from "../../model/text/yaml_text";
import { Field } from "./field";
import { useEdit } from "./form_parts";

/** The behaviour to which failures lead that no entry of `next` names. The default of the agent or system shows as the placeholder. */
export function OnErrorField({ structure, at, behaviours }: { structure: Structure; at: YamlPath; behaviours: string[] }) {
  const edit = useEdit();
  const around = onError(structure, at, true);
  return (
    <Field
      label="After a failure"
      value={structure.yaml.valueText([...at, "on_error"]) ?? ""}
      placeholder={around ? `${around.text}, as the ${around.of}` : "stop: the run fails"}
      hint="The behaviour to which a failure leads that no entry of a behaviour names"
      choices={[...new Set(behaviours), "stop"]}
      onChange={(text) => edit(set(at, "on_error", text))}
    />
  );
}
