import type { Schema } from "../text/schema_fields";
import { isNumber, typeParts } from "../text/type_text";
import type { Buffer, Structure } from "./structure";

/** The names under which limits of a real buffer are given: its own, or those of the numbers inside a structure. */
export function limitNames({ yaml }: Structure, { name, type }: Pick<Buffer, "name" | "type">): string[] {
  const inside = (path: string, of: string, outer: readonly string[]): string[] => {
    const parts = typeParts(of);
    if (!parts) return [];
    if (isNumber(parts.base)) return parts.length.startsWith("<=") ? [] : [path];
    if (parts.length || outer.includes(parts.base)) return [];
    const at = ["types", parts.base];
    return yaml
      .keys(at)
      .flatMap((field) => inside(`${path}.${field}`, yaml.valueText([...at, field]) ?? "", [...outer, parts.base]));
  };
  return inside(name, type, []);
}

/** The values of a type, as a schema: a structure has a field for each of its own. */
function schemaOfType({ yaml }: Pick<Structure, "yaml">, type: string, outer: readonly string[] = []): Schema {
  const parts = typeParts(type);
  if (!parts || parts.length || outer.includes(parts.base)) return {};
  if (parts.base === "bool") return { type: "boolean" };
  const at = ["types", parts.base];
  const fields = yaml.keys(at);
  if (fields.length === 0) return {};
  const inside = [...outer, parts.base];
  const properties = Object.fromEntries(
    fields.map((field) => [field, titled(field, yaml.valueText([...at, field]) ?? "", { yaml }, inside)]),
  );
  return { type: "object", properties, additionalProperties: false };
}

/** The same with a title: the name, and the unit of a number. */
export function titled(name: string, type: string, structure: Pick<Structure, "yaml">, outer: readonly string[] = []): Schema {
  const unit = typeParts(type)?.unit;
  return { title: unit ? `${name} (${unit})` : name, ...schemaOfType(structure, type, outer) };
}
