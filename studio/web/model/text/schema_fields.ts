/** The parts of JSON Schema with which the schema of specifications describes values. */
export interface Schema {
  $ref?: string;
  title?: string;
  description?: string;
  type?: string | readonly string[];
  enum?: readonly unknown[];
  const?: unknown;
  pattern?: string;
  properties?: { readonly [key: string]: Schema };
  required?: readonly string[];
  anyOf?: readonly Schema[];
  oneOf?: readonly Schema[];
  if?: Schema;
  then?: Schema;
  else?: Schema;
  examples?: readonly unknown[];
  propertyNames?: Schema;
  prefixItems?: readonly Schema[];
  items?: Schema | false;
  minimum?: number;
  maximum?: number;
  additionalProperties?: Schema | boolean;
  dependentSchemas?: { readonly [key: string]: Schema };
  $defs?: { readonly [key: string]: Schema };
}

/** One key of a map, as a field of a form. */
export interface FieldShape {
  key: string;
  /** Its label, if that is not made from the key. */
  title?: string;
  description: string;
  required: boolean;
  /** The possible values; empty: any text. */
  choices: readonly string[];
  schema: Schema;
  /** The length of a list with a field for each value; 0: it is none. */
  parts: number;
  /** A list of any length: its values are written with commas between them. */
  list: boolean;
  /** Why a text is not accepted; undefined: it is, or only the server can decide. */
  wrong: (text: string) => string | undefined;
}

/** A schema combined with its reference; its own keywords count first. */
export function resolved(schema: Schema, root: Schema): Schema {
  if (!schema.$ref) return schema;
  const { $ref, ...own } = schema;
  const target = $ref
    .replace(/^#\//, "")
    .split("/")
    .reduce<unknown>((at, key) => (at as Record<string, unknown>)[key], root);
  return { ...resolved(target as Schema, root), ...own };
}

const kindsOf = (schema: Schema) => (typeof schema.type === "string" ? [schema.type] : (schema.type ?? []));

/** Whether a text, in the form of the file, is a value of the schema. It judges only what fields need. */
export function accepts(schema: Schema, root: Schema, text: string): boolean {
  const { anyOf, enum: values, const: one, pattern, minimum, maximum, ...rest } = resolved(schema, root);
  if (anyOf) return anyOf.some((each) => accepts(each, root, text));
  if (values) return values.map(String).includes(text);
  if (one !== undefined) return String(one) === text;
  const kinds = kindsOf(rest);
  const number = text.trim() === "" ? NaN : Number(text);
  const isNumber = kinds.includes("integer") ? Number.isInteger(number) : kinds.includes("number") && !Number.isNaN(number);
  if (isNumber && number >= (minimum ?? -Infinity) && number <= (maximum ?? Infinity)) return true;
  if (kinds.includes("boolean") && /^(true|false)$/.test(text)) return true;
  if (kinds.includes("string")) return pattern === undefined || new RegExp(pattern, "u").test(text);
  return kinds.length === 0 || kinds.includes("array") || kinds.includes("object");
}

export function fieldOf(key: string, schema: Schema, root: Schema, required: boolean): FieldShape {
  const { title, description = "", enum: several, const: one, prefixItems, anyOf, type } = resolved(schema, root);
  const values = several ?? (one === undefined ? undefined : [one]);
  const flag = type === "boolean";
  const list = [resolved(schema, root), ...(anyOf ?? []).map((one) => resolved(one, root))].some(
    (one) => one.type === "array" && !one.prefixItems,
  );
  return {
    key,
    ...(title ? { title } : {}),
    description,
    required,
    schema,
    choices: values ? values.map(String) : flag ? ["true", "false"] : [],
    parts: prefixItems?.length ?? 0,
    list,
    wrong: (text) =>
      text.trim() === "" || list || prefixItems || accepts(schema, root, text)
        ? undefined
        : `This cannot be ${key.replaceAll("_", " ")}${description && `: ${description}`}`,
  };
}

/** The keys that a map may have, in the order of the schema. */
export function fieldsOf(schema: Schema, root: Schema): FieldShape[] {
  const { properties = {}, required = [] } = resolved(schema, root);
  return Object.entries(properties).map(([key, one]) => fieldOf(key, one, root, required.includes(key)));
}

/** A possible driver: its kind, which is its first key, and the keys of that kind. */
export interface DriverKind {
  kind: string;
  description: string;
  /** Whether a receptor reads it, or an effector writes it; both: any real buffer can have it. */
  side: "receptor" | "effector" | "both";
  /** In the simulated world only, or behind the devices of the real robot only. */
  where: "world" | "robot" | "both";
  options: readonly FieldShape[];
  /** It may have keys that the schema does not name. */
  open: boolean;
}

const sideOf = (description: string): DriverKind["side"] =>
  /\(effectors\)/.test(description) ? "effector" : /receptor/.test(description) ? "receptor" : "both";

export function driverKinds(root: Schema): DriverKind[] {
  const definition = (name: string) => resolved({ $ref: `#/$defs/${name}` }, root);
  const closed = (kind: string, name: string, where: DriverKind["where"]): DriverKind => {
    const { description = "" } = definition(name);
    const options = fieldsOf(definition(name), root).filter(({ key }) => key !== kind);
    return { kind, description, side: kind === "panel" ? "receptor" : "both", where, options, open: false };
  };
  const world = definition("world_device");
  return [
    ...Object.entries(world.properties ?? {}).map(([kind, one]): DriverKind => {
      const description = resolved(one, root).description ?? "";
      const options = world.dependentSchemas?.[kind] ? fieldsOf(world.dependentSchemas[kind], root) : [];
      const same = /Another name of `(\w+)`/.exec(description)?.[1];
      const side = sideOf(same ? (world.properties?.[same]?.description ?? "") : description);
      return { kind, description, side, where: "world", options, open: true };
    }),
    { kind: "cpp", description: "A C++ class.", side: "both", where: "both", options: [], open: true },
    closed("panel", "panel_device", "both"),
    closed("ros2", "topic", "robot"),
  ];
}
