import { isMap, isScalar, isSeq } from "yaml";
import { isNumber } from "./type_text";
import { scalarText, type TextEdit, type YamlPath, type YamlText } from "./yaml_text";

/** The parts of a parameter. Its type is empty if its value determines it. */
export interface ParameterParts {
  value: string;
  unit: string;
  type: string;
  min: string;
  max: string;
}
const number = String.raw`[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?`;

/** "0.2 m/s" as ["0.2", "m/s"]; a text that is no number has no unit. */
function withUnit(text: string): [string, string] {
  const found = new RegExp(`^(${number})\\s*(\\S.*)?$`).exec(text.trim());
  return found ? [found[1]!, found[2] ?? ""] : [text, ""];
}

export function parameterParts(yaml: YamlText, at: YamlPath): ParameterParts {
  const node = yaml.node(at);
  const field = (key: string) => yaml.valueText([...at, key]) ?? "";
  const map = isMap(node);
  const held = map ? yaml.node([...at, "default"]) : node;
  const text = map ? field("default") : (yaml.valueText(at) ?? "");
  const isText = isScalar(held) && typeof held.value === "string" && held.type !== "PLAIN";
  const [value, unit] = isText || isSeq(held) ? [text, ""] : withUnit(text);
  const type = map ? field("type") : isText ? "string" : /^(true|false)$/.test(text) ? "bool" : "";
  return {
    value,
    unit: map && field("unit") ? field("unit") : unit,
    type,
    min: map ? field("min") : "",
    max: map ? field("max") : "",
  };
}

/** The value in the form of the file: a text needs its quotes. */
const written = (value: string, type: string) => (type.startsWith("string") ? JSON.stringify(value) : scalarText(value));

/** Changes parts of a parameter. It keeps its short form as long as that can express it. */
export function setParameter(yaml: YamlText, at: YamlPath, change: Partial<ParameterParts>): TextEdit[] {
  const before = parameterParts(yaml, at);
  const after = { ...before, ...change };
  if (after.type && !isNumber(after.type.split("[")[0]!)) Object.assign(after, { unit: "", min: "", max: "" });
  if (after.type === "bool" && !/^(true|false)$/.test(after.value)) after.value = "false";
  if (isMap(yaml.node(at)) && after.type === before.type) {
    const apart = yaml.node([...at, "unit"]) !== undefined;
    const [key] = Object.keys(change) as (keyof ParameterParts)[];
    if (key === "min" || key === "max") return yaml.set(at, key, after[key]);
    if (key === "unit" && (apart || !before.unit)) return yaml.set(at, "unit", after.unit);
    return yaml.set(at, "default", apart || !after.unit ? after.value : `${after.value} ${after.unit}`, (text) =>
      written(text, after.type),
    );
  }
  const short = !after.min && !after.max && (after.type === "" || after.type === "bool" || after.type === "string");
  if (short)
    return yaml.set(
      at.slice(0, -1),
      String(at.at(-1)),
      after.unit ? `${after.value} ${after.unit}` : after.value || '""',
      (text) => written(after.value ? text : "", after.type),
    );
  const parts = [
    ...(after.type ? [`type: ${scalarText(after.type)}`] : []),
    `default: ${written(after.value, after.type)}`,
    ...(after.min ? [`min: ${scalarText(after.min)}`] : []),
    ...(after.max ? [`max: ${scalarText(after.max)}`] : []),
    ...(after.unit ? [`unit: ${scalarText(after.unit)}`] : []),
  ];
  return yaml.set(at.slice(0, -1), String(at.at(-1)), `{ ${parts.join(", ")} }`, (text) => text);
}
