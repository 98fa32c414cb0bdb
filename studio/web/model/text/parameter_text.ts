import { isMap, isScalar, isSeq } from "yaml";
import type { Edit } from "../protocol";
import { set } from "./edits";
import { isNumber } from "./type_text";
import type { YamlPath, YamlText } from "./yaml_text";

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

/** A part of a map in one line. */
const inMap = (text: string) => (/^[\w./+-][^,[\]{}#:"']*$/.test(text) || text.startsWith("[") ? text : JSON.stringify(text));

/** Changes parts of a parameter; present: its path in `yaml`, if it is another one. It keeps its short form as long as that can express it. */
export function setParameter(yaml: YamlText, at: YamlPath, change: Partial<ParameterParts>, present = at): Edit {
  const before = parameterParts(yaml, present);
  const after = { ...before, ...change };
  if (after.type && !isNumber(after.type.split("[")[0]!)) Object.assign(after, { unit: "", min: "", max: "" });
  if (after.type === "bool" && !/^(true|false)$/.test(after.value)) after.value = "false";
  // A text needs its quotes.
  const as = after.type.startsWith("string") ? "quoted" : "scalar";
  if (isMap(yaml.node(present)) && after.type === before.type) {
    const apart = yaml.node([...present, "unit"]) !== undefined;
    const [key] = Object.keys(change) as (keyof ParameterParts)[];
    if (key === "min" || key === "max") return set(at, key, after[key]);
    if (key === "unit" && (apart || !before.unit)) return set(at, "unit", after.unit);
    return set(at, "default", apart || !after.unit ? after.value : `${after.value} ${after.unit}`, as);
  }
  const [above, name] = [at.slice(0, -1), String(at.at(-1))];
  const short = !after.min && !after.max && (after.type === "" || after.type === "bool" || after.type === "string");
  if (short) return set(above, name, after.unit ? `${after.value} ${after.unit}` : after.value, after.value ? as : "quoted");
  const held = as === "quoted" ? JSON.stringify(after.value) : inMap(after.value);
  const parts = Object.entries({ ...after, default: held }).flatMap(([key, text]) =>
    key === "value" || text === "" ? [] : [[key, key === "default" ? held : inMap(text)]],
  );
  const order = ["type", "default", "min", "max", "unit"];
  parts.sort(([a], [b]) => order.indexOf(a!) - order.indexOf(b!));
  return set(above, name, `{ ${parts.map(([key, text]) => `${key}: ${text}`).join(", ")} }`, "as_is");
}
