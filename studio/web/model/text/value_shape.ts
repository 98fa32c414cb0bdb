import { accepts, fieldsOf, resolved, type FieldShape, type Schema } from "./schema_fields";
import type { EditValue } from "../protocol";

/** The form of a value of the specification. The schema decides it; among alternatives, the present value does. */
export type ValueShape =
  /**
   * The value has one line. `more`: the schema also allows a map, and the line becomes the value of its field
   * `key` (empty: of none). null: the schema allows no map.
   */
  | { kind: "line"; more: { key: string } | null }
  /** A map whose keys the schema names. */
  | { kind: "record"; fields: readonly FieldShape[] }
  /** A map with names of its own. */
  | { kind: "names"; of: (name: string) => Schema; wrong: (name: string) => string | undefined }
  | { kind: "list"; of: Schema }
  /** A map with exactly one of several keys, which may bring further keys along. */
  | { kind: "cases"; cases: readonly Case[] };

export interface Case {
  key: string;
  /** All fields, also those of every case. */
  fields: readonly FieldShape[];
}

const isMap = (value: unknown): value is Record<string, unknown> =>
  typeof value === "object" && value !== null && !Array.isArray(value);

const kindOf = (value: unknown) =>
  value === null || value === undefined ? "null" : Array.isArray(value) ? "array" : isMap(value) ? "object" : typeof value;

/** Whether a value meets a condition of the schema. It knows only the keywords that conditions use. */
export function meets(schema: Schema, root: Schema, value: unknown): boolean {
  const { type, required = [], properties = {}, anyOf, pattern, const: one } = resolved(schema, root);
  const kinds = typeof type === "string" ? [type] : type;
  if (kinds && !kinds.includes(kindOf(value))) return false;
  if (one !== undefined && one !== value) return false;
  if (pattern !== undefined && !new RegExp(pattern, "u").test(String(value))) return false;
  if (anyOf && !anyOf.some((each) => meets(each, root, value))) return false;
  if (!isMap(value)) return true;
  return (
    required.every((key) => key in value) &&
    Object.entries(properties).every(([key, each]) => !(key in value) || meets(each, root, value[key]))
  );
}

/** A schema for one value: without references, and with its conditions decided for that value. */
export function schemaFor(schema: Schema, root: Schema, value: unknown): Schema {
  const { if: condition, then, else: otherwise, ...rest } = resolved(schema, root);
  if (!condition) return rest;
  const branch = meets(condition, root, value) ? then : otherwise;
  return branch ? { ...rest, ...schemaFor(branch, root, value) } : rest;
}

/** The schemas that the conditions of a schema choose from. */
function branches(schema: Schema, root: Schema): Schema[] {
  const { if: condition, then, else: otherwise, ...rest } = resolved(schema, root);
  if (!condition) return [rest];
  return [then, otherwise].flatMap((one) => (one ? branches(one, root) : []));
}

/** The fields of a map as it is now. A value that would make it another kind of map is accepted, too. */
export function fieldsFor(schema: Schema, root: Schema, value: unknown): FieldShape[] {
  const others = branches(schema, root);
  return fieldsOf(schemaFor(schema, root, value), root).map((field) => ({
    ...field,
    wrong: (text) => {
      const possible = others.map((one) => one.properties?.[field.key]);
      return possible.some((one) => one && accepts(one, root, text)) ? undefined : field.wrong(text);
    },
  }));
}

const isObject = ({ type, properties, additionalProperties }: Schema) =>
  properties !== undefined || typeof additionalProperties === "object" || type === "object";

/** The key that tells an alternative from the others. */
const ownKey = ({ required = [] }: Schema) => required[0] ?? "";

function casesOf(schema: Schema, root: Schema): Case[] | null {
  const { anyOf, oneOf, properties } = schema;
  const alternatives = (anyOf ?? []).map((one) => resolved(one, root));
  if (alternatives.length > 1 && alternatives.every((one) => isObject(one) && ownKey(one)))
    return alternatives.map((one) => ({ key: ownKey(one), fields: fieldsOf(one, root) }));
  if (!properties || !oneOf?.every(ownKey)) return null;
  const keys = oneOf.map(ownKey);
  const fields = fieldsOf(schema, root);
  return keys.map((key) => ({ key, fields: fields.filter((one) => one.key === key || !keys.includes(one.key)) }));
}

function mapShape(schema: Schema, root: Schema, value: unknown): ValueShape {
  const { properties = {}, additionalProperties: others, propertyNames } = schema;
  const open = typeof others === "object" || (Object.keys(properties).length === 0 && others !== false);
  if (!open) return { kind: "record", fields: fieldsFor(schema, root, value) };
  return {
    kind: "names",
    of: (name) => properties[name] ?? (typeof others === "object" ? others : {}),
    wrong: (name) =>
      !propertyNames || accepts({ type: "string", ...propertyNames }, root, name)
        ? undefined
        : `This cannot be a name here${propertyNames.$ref ? ": letters, digits and single underscores" : ""}`,
  };
}

const takes = (schema: Schema, root: Schema, value: unknown) => {
  const { additionalProperties, properties = {} } = resolved(schema, root);
  return isMap(value) && (additionalProperties !== false || Object.keys(value).every((key) => key in properties));
};

const isOpen = ({ additionalProperties }: Schema) => additionalProperties !== false;

/** The alternatives of a schema for a value, in one list, also if an alternative has alternatives itself. */
const alternativesOf = ({ anyOf = [] }: Schema, root: Schema, value: unknown): Schema[] =>
  anyOf.flatMap((each) => {
    const one = schemaFor(each, root, value);
    return one.anyOf ? alternativesOf(one, root, value) : [one];
  });

export function shapeOf(schema: Schema, root: Schema, value: unknown): ValueShape {
  const now = schemaFor(schema, root, value);
  const cases = casesOf(now, root);
  if (cases) return { kind: "cases", cases };
  const alternatives = alternativesOf(now, root, value).filter(isObject);
  if (alternatives.length > 0) {
    const fitting = alternatives.filter((one) => takes(one, root, value));
    // An empty map is one with names of its own, if the schema has that.
    const chosen = (isMap(value) && Object.keys(value).length > 0 ? null : fitting.find(isOpen)) ?? fitting[0];
    return chosen ? mapShape(chosen, root, value) : { kind: "line", more: { key: ownKey(alternatives.at(-1)!) } };
  }
  if (isObject(now)) return mapShape(now, root, value);
  if (now.type === undefined && now.propertyNames) return mapShape(now, root, value);
  const kinds = typeof now.type === "string" ? [now.type] : (now.type ?? []);
  if (kinds.includes("object")) return mapShape(now, root, value);
  if (kinds.includes("array") && now.items && isCollection(now.items, root)) return { kind: "list", of: now.items };
  return { kind: "line", more: null };
}

/** Whether an item is more than one value. */
function isCollection(schema: Schema, root: Schema): boolean {
  const { anyOf = [], ...own } = resolved(schema, root);
  return isObject(own) || anyOf.some((one) => isObject(resolved(one, root)));
}

/** The least value that the schema accepts: what it needs, with texts that are to be replaced. */
export function freshValue(schema: Schema, root: Schema): EditValue {
  const {
    anyOf,
    enum: values,
    const: one,
    type,
    examples,
    minimum,
    properties = {},
    required = [],
    items,
  } = branches(schema, root)[0]!;
  if (one !== undefined) return String(one);
  if (values) return String(values[0]);
  if (examples) return String(examples[0]);
  if (anyOf) return freshValue(anyOf[0]!, root);
  const kinds = typeof type === "string" ? [type] : (type ?? []);
  if (required.length > 0) return Object.fromEntries(required.map((key) => [key, freshValue(properties[key] ?? {}, root)]));
  if (kinds.includes("object")) return {};
  if (kinds.includes("array")) return items ? [freshValue(items, root)] : [];
  if (kinds.includes("number") || kinds.includes("integer")) return String(minimum ?? 0);
  return kinds.includes("boolean") ? "true" : kinds.includes("string") ? "name" : "0";
}
