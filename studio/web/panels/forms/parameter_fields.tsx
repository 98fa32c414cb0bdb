import { parameterParts, setParameter, type ParameterParts } from "../../model/text/parameter_text";
import type { Structure } from "../../model/structure/structure";
import { isNumber, numberTypes } from "../../model/text/type_text";
import type { YamlPath } from "../../model/text/yaml_text";
import { Choice, Field } from "./field";
import { useEdit } from "./form_parts";

/** A parameter: its value, unit, type and range. */
export function ParameterFields({ structure, at }: { structure: Structure; at: YamlPath }) {
  const edit = useEdit();
  const { yaml } = structure;
  const name = String(at.at(-1));
  const parts = parameterParts(yaml, at);
  const set = (change: Partial<ParameterParts>) => edit((now) => setParameter(now.structure.yaml, at, change, now.at(at)));
  const field = (key: keyof ParameterParts, label: string, placeholder = "") => (
    <Field
      label={label}
      of={`of ${name}`}
      value={parts[key]}
      placeholder={placeholder}
      onChange={(text) => set({ [key]: text })}
    />
  );
  const types = ["", ...numberTypes.slice(1), "bool", "string"];
  const known = types.includes(parts.type) ? types : [...types, parts.type];
  const number = parts.type === "" || isNumber(parts.type.split("[")[0]!);
  return (
    <div className="parameter-fields">
      {parts.type === "bool" ? (
        <Choice
          label="Value"
          of={`of ${name}`}
          value={parts.value}
          choices={["true", "false"].map((one) => ({ value: one, title: one }))}
          onChange={(value) => set({ value })}
        />
      ) : (
        <Field
          label="Value"
          of={`of ${name}`}
          value={parts.value}
          onChange={(value) => value.trim() !== "" && set({ value: value.trim() })}
        />
      )}
      {number && field("unit", "Unit", "none")}
      <Choice
        label="Type"
        of={`of ${name}`}
        value={parts.type}
        choices={known.map((one) => ({ value: one, title: one || "float64" }))}
        onChange={(type) => set({ type })}
      />
      {number && field("min", "Least", "any")}
      {number && field("max", "Most", "any")}
    </div>
  );
}
