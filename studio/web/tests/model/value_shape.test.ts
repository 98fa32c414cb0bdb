import { expect, it } from "vitest";
import schemaText from "../../../../share/tessera/spec.schema.json";
import { limitNames, titled } from "../../model/structure/inside_types";
import { findThing, readStructure } from "../../model/structure/structure";
import { listAsTyped } from "../../model/text/list_text";
import { problemAt } from "../../model/text/problem_at";
import type { Schema } from "../../model/text/schema_fields";
import { fieldsFor, freshValue, shapeOf, type ValueShape } from "../../model/text/value_shape";
import { YamlText } from "../../model/text/yaml_text";

const schema = schemaText as unknown as Schema;
const at = (path: string): Schema => ({ $ref: `#/${path}` });
const shape = (path: string, value?: unknown) => shapeOf(at(path), schema, value);
const keysOf = (of: ValueShape) => (of.kind === "record" ? of.fields.map(({ key }) => key) : []);

it("the shape of a value is that of the schema, and of the present value if there are several", () => {
  expect(keysOf(shape("$defs/realtime"))).toEqual(["policy", "priority", "cpu"]);
  expect(shape("properties/simulation/properties/checks").kind).toBe("list");
  expect(shape("properties/simulation/properties/measures").kind).toBe("names");
  const check = shape("$defs/world_check");
  expect(check.kind === "cases" && check.cases.map(({ key, fields }) => [key, fields.length])).toEqual([
    ["never", 2],
    ["always", 2],
    ["at_end", 2],
    ["eventually", 3],
    ["at_most", 2],
  ]);
  const property = shape("$defs/property");
  expect(property.kind === "cases" && property.cases[4]!.fields.map(({ key }) => key)).toEqual(["name", "leads_to"]);
  const limits = shape("$defs/effector/properties/limits");
  expect(limits.kind === "names" && keysOf(shapeOf(limits.of("left"), schema, {}))).toEqual([
    "min",
    "max",
    "per_second",
    "beyond",
    "non_finite",
  ]);
  const process = (value: unknown) => {
    const all = shape("properties/deploy/properties/processes");
    return all.kind === "names" ? shapeOf(all.of("one"), schema, value) : null;
  };
  expect(process("robot")).toEqual({ kind: "line", more: { key: "agents" } });
  expect(keysOf(process({ agents: "robot" })!)).toEqual(["agents", "host", "interface"]);
  const places = shape("$defs/model/properties/send/properties/places");
  expect(places.kind === "names" && keysOf(shapeOf(places.of("first"), schema, null))).toEqual(["write"]);
  expect(places.kind === "names" && shapeOf(places.of("in"), schema, null)).toEqual({ kind: "record", fields: [] });
  expect(shape("$defs/placement/properties/at").kind).toBe("line");
});

it("forms that are made of the schema reach the keys deep inside", () => {
  const seen = new Set<unknown>();
  const lines: string[] = [];
  const visit = (one: Schema, path: string) => {
    if (seen.has(one) || path.split(".").length > 9) return;
    seen.add(one);
    const found = shapeOf(one, schema, undefined);
    if (found.kind === "record") for (const field of found.fields) visit(field.schema, `${path}.${field.key}`);
    else if (found.kind === "cases")
      for (const { fields } of found.cases) for (const { key, schema } of fields) visit(schema, `${path}.${key}`);
    else if (found.kind === "names") visit(found.of("name"), `${path}.*`);
    else if (found.kind === "list") visit(found.of, `${path}[]`);
    else lines.push(path);
  };
  for (const key of ["simulation", "models", "deploy", "properties"]) visit(at(`properties/${key}`), key);
  for (const part of ["simulation.checks[].never", "simulation.measures.*", "models.*.slots", "models.*.send.places.*.write"])
    expect(lines).toContain(part);
  expect(lines).toContain("deploy.processes.*");
});

it("the fields of a driver of ROS 2 are those of what it is, and its type may become another's", () => {
  const fields = (value: unknown) => fieldsFor(at("$defs/ros2_device"), schema, value);
  expect(fields({ ros2: "/a", type: "std_msgs/msg/Bool" }).map(({ key }) => key)).toContain("qos");
  const service = fields({ ros2: "/a", type: "std_srvs/srv/SetBool" });
  expect(service.map(({ key }) => key)).toEqual(expect.arrayContaining(["role", "timeout", "wait"]));
  expect(service.map(({ key }) => key)).not.toContain("qos");
  const action = fields({ ros2: "/a", type: "nav2_msgs/action/NavigateToPose" }).map(({ key }) => key);
  expect(action).toEqual(expect.arrayContaining(["role", "frame_id", "timeout", "wait"]));
  for (const value of [{ ros2: "/tf" }, { ros2: "/tf", type: "tf2_msgs/msg/TFMessage", frame: "base_link" }])
    expect(fields(value).map(({ key }) => key)).toEqual(expect.arrayContaining(["frame", "in", "wait"]));
  expect(fields({ ros2: "/tf", type: "tf2_msgs/msg/TFMessage" }).map(({ key }) => key)).toContain("qos");
  const type = fields({ ros2: "/a" }).find(({ key }) => key === "type")!;
  for (const one of ["std_srvs/srv/SetBool", "std_msgs/msg/Bool", "nav2_msgs/action/NavigateToPose"])
    expect(type.wrong(one)).toBeUndefined();
  expect(type.wrong("no type")).toMatch(/type/);
});

it("a new entry has what the schema needs", () => {
  expect(freshValue(at("$defs/arcs"), schema)).toEqual({ from: "name", to: "name" });
  expect(freshValue(at("$defs/world_check"), schema)).toEqual({ never: "name" });
  expect(freshValue(at("$defs/rate"), schema)).toBe("20 Hz");
});

it("a list is typed with commas", () => {
  expect(listAsTyped("[a, b]")).toBe("a, b");
  expect(listAsTyped("[[0, 1], [2, 3]]")).toBe("[[0, 1], [2, 3]]");
});

it("the kind of a map decides among alternatives inside of each other", () => {
  const panel = (value: unknown) => shape("$defs/panel_device/properties/panel", value);
  expect(panel(true).kind).toBe("line");
  expect(keysOf(panel({ slider: [] }))).toEqual(["slider", "stick_x", "stick_y"]);
  expect([panel({ turn: {} }).kind, panel({}).kind]).toEqual(["names", "names"]);
});

const text = `simulation: # the world
  world: a.xml
  checks:
    - name: one   # first
      never: contact(a)
    - { always: "x" }
  measures: {}
models:
  m: { send: { places: { in, first: { write: 1 }, out } } }
`;
it("a complaint is shown at the value it is about", () => {
  const yaml = new YamlText(text);
  const complaint = (line: number, column: number) => [{ severity: "error" as const, message: "no", line, column }];
  expect(problemAt(yaml, complaint(5, 14), ["simulation", "checks", 0, "never"], false)).toBe("no");
  expect(problemAt(yaml, complaint(5, 24), ["simulation", "checks", 0, "never"], false)).toBe("no");
  expect(problemAt(yaml, complaint(5, 14), ["simulation", "checks", 0, "name"], false)).toBeUndefined();
  expect(problemAt(yaml, complaint(5, 14), ["simulation", "checks", 0], true)).toBeUndefined();
  expect(problemAt(yaml, complaint(6, 7), ["simulation", "checks", 1], true)).toBe("no");
  expect(problemAt(yaml, complaint(3, 4), ["simulation", "checks"], true)).toBe("no");
});

const system = `system: s
types: { Motion: { ahead: float64 m/s, on: bool, arm: Arm }, Arm: { angles: "float64[3]" } }
templates:
  rover:
    control: { behaviours: { run: {} } }
    effectors:
      base:
        real:   { command: Motion, light: bool }
        safe:   { command: { ahead: 0 }, light: true }
        limits: { command.ahead: { max: 1 } }
        behaviours: { run: {} }
  other: { use: rover }
agents:
  a: { use: rover }
  b: { use: other }
channels:
  - a.base.x -> b.base.y
  - { from: a.base.z, to: b.base.y, send: blocking, timeout: 1 s }   # slow
  - { from: a.base.z, to: b.base.y, model: "mine" }
models: { mine: {} }
`;

it("limits and safe commands follow the type and the name of their buffer", () => {
  const structure = readStructure(system);
  expect(limitNames(structure, { name: "command", type: "Motion" })).toEqual(["command.ahead", "command.arm.angles"]);
  expect(limitNames(structure, { name: "wheels", type: "float64[2] rad" })).toEqual(["wheels"]);
  expect(titled("command", "Motion", structure)).toMatchObject({
    title: "command",
    properties: { ahead: { title: "ahead (m/s)" }, on: { type: "boolean" }, arm: { properties: { angles: {} } } },
  });
});

it("a template is found by its name", () => {
  expect(findThing(readStructure(system), "template:rover")?.kind).toBe("template");
});
