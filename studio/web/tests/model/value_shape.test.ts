import { expect, it } from "vitest";
import schemaText from "../../../../share/tessera/spec.schema.json";
import { limitNames, titled } from "../../model/structure/inside_types";
import { findThing, readStructure } from "../../model/structure/structure";
import { removeBuffer, setModel } from "../../model/text/edits";
import { renameBuffer, renameUsed } from "../../model/text/renames";
import { lineText, listAsTyped, listAsWritten } from "../../model/text/list_text";
import { problemAt } from "../../model/text/problem_at";
import type { Schema } from "../../model/text/schema_fields";
import { fieldsFor, freshValue, shapeOf, type ValueShape } from "../../model/text/value_shape";
import { makeTemplate } from "../../model/text/template_edits";
import { apply, flowText, YamlText, type TextEdit, type YamlPath } from "../../model/text/yaml_text";

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

it("the fields of a driver of ROS 2 are those of its topic or its service, and its type may become the other's", () => {
  const fields = (value: unknown) => fieldsFor(at("$defs/ros2_device"), schema, value);
  expect(fields({ ros2: "/a", type: "std_msgs/msg/Bool" }).map(({ key }) => key)).toContain("qos");
  const service = fields({ ros2: "/a", type: "std_srvs/srv/SetBool" });
  expect(service.map(({ key }) => key)).toEqual(expect.arrayContaining(["role", "timeout", "wait"]));
  expect(service.map(({ key }) => key)).not.toContain("qos");
  const type = fields({ ros2: "/a" }).find(({ key }) => key === "type")!;
  expect([type.wrong("std_srvs/srv/SetBool"), type.wrong("std_msgs/msg/Bool")]).toEqual([undefined, undefined]);
  expect(type.wrong("no type")).toMatch(/type/);
});

it("a new entry has what the schema needs", () => {
  expect(flowText(freshValue(at("$defs/arcs"), schema))).toBe("{ from: name, to: name }");
  expect(flowText(freshValue(at("$defs/world_check"), schema))).toBe("{ never: name }");
  expect(flowText(freshValue(at("$defs/rate"), schema))).toBe("20 Hz");
  expect(flowText(["1", { a: ["x"] }])).toBe("[1, { a: [x] }]");
});

it("a list is typed with commas, and is in the file what it was before", () => {
  for (const text of ["[a, b]", '["robot[0].a", "robot[1].b"]', "[[0, 1], [2, 3]]", "[0.5, -90 deg]"])
    expect(listAsWritten(listAsTyped(text))).toBe(text);
  expect(listAsWritten("robot[0].a, b")).toBe('["robot[0].a", b]');
  expect(listAsWritten("any(f(a, b)) => c")).toBe('"any(f(a, b)) => c"');
  expect(listAsWritten("one")).toBe("one");
  const lines = new YamlText("from: # them\n  - a # first\n  - robot[0].b\nto: x\n");
  expect(lineText(lines, ["from"])).toBe('[a, "robot[0].b"]');
  expect(apply(lines.text, lines.set([], "from", "c, d", listAsWritten))).toBe("from: # them\n  [c, d]\nto: x\n");
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
const after = (edits: (yaml: YamlText) => readonly TextEdit[], before = text) => {
  const lines = (all: string) => all.split("\n");
  const now = apply(before, edits(new YamlText(before)));
  return lines(now).filter((line) => !lines(before).includes(line));
};

it("entries of lists, and of maps without colons, are changed in place", () => {
  const checks: YamlPath = ["simulation", "checks"];
  expect(after((yaml) => yaml.append(checks, "{ never: y }"))).toEqual(["    - { never: y }"]);
  expect(after((yaml) => yaml.set([...checks, 0], "name", ""))).toEqual(["    - never: contact(a)"]);
  expect(after((yaml) => yaml.set([...checks, 0], "within", "1 s"))).toEqual(["      within: 1 s"]);
  expect(after((yaml) => yaml.append(["simulation", "other"], "1"))).toEqual(["  other:", "    - 1"]);
  expect(after((yaml) => yaml.append(["a", "b"], "1"))).toEqual(["a:", "  b:", "    - 1"]);
  expect(after((yaml) => yaml.append(["a"], "1"), "a: []  # none\n")).toEqual(["a:", "  - 1  # none"]);
  const places: YamlPath = ["models", "m", "send", "places"];
  expect(after((yaml) => yaml.insert(places, "more", "{}"))).toEqual([
    "  m: { send: { places: { in, first: { write: 1 }, out, more: {} } } }",
  ]);
  expect(after((yaml) => yaml.set([...places, "in"], "write", "1"))).toEqual([
    "  m: { send: { places: { in: { write: 1 }, first: { write: 1 }, out } } }",
  ]);
  expect(after((yaml) => yaml.remove([...places, "out"]))).toEqual(["  m: { send: { places: { in, first: { write: 1 } } } }"]);
});

it("a complaint is shown at the value it is about", () => {
  const yaml = new YamlText(text);
  const complaint = (line: number, column: number) => [{ severity: "error", message: "no", line, column }];
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
  const thing = findThing(structure, "template:rover.base");
  const base = thing?.kind === "subsystem" ? thing.of : null;
  const command = base!.buffers.find(({ name }) => name === "command")!;
  const renamed = renameBuffer(structure, base!, command, "drive");
  expect(renamed.split("\n").slice(8, 10)).toEqual([
    "        safe:   { drive: { ahead: 0 }, light: true }",
    "        limits: { drive.ahead: { max: 1 } }",
  ]);
  expect(removeBuffer(structure, base!, command, readStructure).split("\n").slice(7, 10)).toEqual([
    "        real:   { light: bool }",
    "        safe:   { light: true }",
    "        limits: {}",
  ]);
});

it("an agent becomes a template of the same name, with its comments, unless its layout forbids it", () => {
  const made = (text: string) => makeTemplate(readStructure(text), readStructure(text).agents[0]!);
  const agent = "  a: # one\n    control: # it\n      rate: 5 Hz\n      behaviours: { run: {} } # last\n";
  const body = "  a: { use: a }\n  b: { use: c }\n";
  const others = "  b: { use: c }\n";
  expect(made(`system: s\nagents:\n${agent}${others}\nchannels: []\n`)).toBe(
    `system: s\nagents:\n${body}\nchannels: []\ntemplates:\n${agent}`,
  );
  expect(made(`templates:\n  c:\n    control: {}\n\nagents:\n${agent}${others}`)).toBe(
    `templates:\n  c:\n    control: {}\n${agent}\nagents:\n${body}`,
  );
  expect(made(`agents:\n  a:\n    control: &x {}\n`)).toBeNull();
  expect(made(`agents:\n    a:\n      control: {}\n`)).toBeNull();
  expect(made(`agents:\n  a: { control: {} }\n`)).toBeNull();
  expect(made(`agents:\n  a:\n    control: { when: "a && *b" } # &c\n`)).toMatch(/use: a/);
});

it("templates and communication models are renamed wherever they are used", () => {
  const changed = (now: string) => now.split("\n").filter((line) => !system.includes(line));
  expect(changed(renameUsed(system, "templates", "rover", "car"))).toEqual([
    "  car:",
    "  other: { use: car }",
    "  a: { use: car }",
  ]);
  expect(changed(renameUsed(system, "models", "mine", "own"))).toEqual([
    '  - { from: a.base.z, to: b.base.y, model: "own" }',
    "models: { own: {} }",
  ]);
  expect(findThing(readStructure(system), "template:rover")?.kind).toBe("template");
  const { channels } = readStructure(system);
  const set = (index: number, model: string) => changed(setModel(readStructure(system), channels[index]!, model));
  expect(set(0, "mine")).toEqual(["  - { from: a.base.x, to: b.base.y, model: mine }"]);
  expect(set(1, "mine")).toEqual(["  - { from: a.base.z, to: b.base.y, timeout: 1 s, model: mine }   # slow"]);
  expect(set(2, "")).toEqual(["  - { from: a.base.z, to: b.base.y }"]);
});
