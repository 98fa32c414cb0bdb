import { expect, it } from "vitest";
import schemaText from "../../../../share/tessera/spec.schema.json";
import { channelEnd, partnersOf } from "../../model/structure/connections";
import { connectEdits } from "../../model/text/connect_edits";
import { parameterParts, setParameter, type ParameterParts } from "../../model/text/parameter_text";
import { driverKinds, fieldsOf, type Schema } from "../../model/text/schema_fields";
import { readStructure } from "../../model/structure/structure";
import { typeParts, typeText } from "../../model/text/type_text";
import { YamlText } from "../../model/text/yaml_text";

const schema = schemaText as unknown as Schema;

it("a type is the same after it was taken apart and put together", () => {
  for (const text of [
    "bool",
    "float64 m/s",
    "float32[32] m",
    "string<=64",
    "Pose[3]",
    "int8[4]",
    "Pose<=16",
    "float64<=8 m",
    "string<=64<=8",
  ])
    expect(typeText(typeParts(text)!)).toBe(text);
  expect(typeParts("float64[8] m / s")).toEqual({ base: "float64", most: "", length: "8", unit: "m / s" });
  expect(typeText({ ...typeParts("float64[2] m")!, base: "bool" })).toBe("bool[2]");
  expect(typeText({ ...typeParts("bool")!, base: "string" })).toBe("string<=64");
  expect(typeParts("{ x: bool }")).toBeNull();
  expect(typeParts("stringy<=4")).toEqual({ base: "stringy", most: "", length: "<=4", unit: "" });
  expect(typeText({ ...typeParts("Pose<=4")!, length: "8" })).toBe("Pose[8]");
});

const parameters = `# all of them
parameters:
  v:     0.2 m/s   # speed
  on:    false
  label: "left wheel"
  tries: { type: int32, default: 3, min: 0, max: 9 }  # how often
  gain:  { default: 2, unit: 1/s }
  gap:
    default: 5 cm
    max: 1 m
  points: { type: "float64[3] m", default: [0.5, 1, 2], min: 0 }
`;
const partsOf = (name: string) => parameterParts(new YamlText(parameters), ["parameters", name]);
const set = (name: string, change: Partial<ParameterParts>) => {
  const { at, key, text, as } = setParameter(new YamlText(parameters), ["parameters", name], change);
  return [at!.slice(1).join("."), key, text, as].join(" ").trim();
};

it("a parameter is read in all its forms", () => {
  expect(partsOf("v")).toEqual({ value: "0.2", unit: "m/s", type: "", min: "", max: "" });
  expect(partsOf("on")).toEqual({ value: "false", unit: "", type: "bool", min: "", max: "" });
  expect(partsOf("label")).toEqual({ value: "left wheel", unit: "", type: "string", min: "", max: "" });
  expect(partsOf("tries")).toEqual({ value: "3", unit: "", type: "int32", min: "0", max: "9" });
  expect(partsOf("gain")).toEqual({ value: "2", unit: "1/s", type: "", min: "", max: "" });
  expect(partsOf("gap")).toEqual({ value: "5", unit: "cm", type: "", min: "", max: "1 m" });
  expect(partsOf("points")).toMatchObject({ value: "[0.5, 1, 2]", type: "float64[3] m" });
});

it("a parameter keeps its form and its comment when a part of it changes", () => {
  expect(set("v", { value: "0.3" })).toBe("v 0.3 m/s scalar");
  expect(set("v", { value: "1e-3" })).toBe("v 1e-3 m/s scalar");
  expect(set("v", { unit: "" })).toBe("v 0.2 scalar");
  expect(set("v", { max: "0.5" })).toBe("v { default: 0.2, max: 0.5, unit: m/s } as_is");
  expect(set("v", { type: "float32" })).toBe("v { type: float32, default: 0.2, unit: m/s } as_is");
  expect(set("v", { type: "float64[3]", value: "[1, 2, 3]" })).toContain('{ type: "float64[3]", default: [1, 2, 3],');
  expect(set("v", { type: "bool" })).toBe("v false scalar");
  expect(set("on", { value: "true" })).toBe("on true scalar");
  expect(set("on", { type: "string", value: "yes" })).toBe("on yes quoted");
  expect(set("label", { value: "" })).toBe("label  quoted");
  expect(set("tries", { max: "12" })).toBe("tries max 12 scalar");
  expect(set("tries", { min: "" })).toBe("tries min  scalar");
  expect(set("gain", { value: "4" })).toBe("gain default 4 scalar");
  expect(set("gain", { unit: "1/min" })).toBe("gain unit 1/min scalar");
  expect(set("gap", { value: "7" })).toBe("gap default 7 cm scalar");
  expect(set("points", { value: "[1, 2, 3]" })).toBe("points default [1, 2, 3] scalar");
});

const system = `system: s
agents:
  a: { control: { outputs: { speed: float64 m/s, shape: Pose }, inputs: { echo: float64 }, behaviours: { run: {} } } }
  b: { use: member, count: 3 }
templates:
  member: { control: { inputs: { go: bool, slow: float64, taken: "float64 m/s", mm: float64 mm }, behaviours: { run: {} } } }
channels:
  - { from: a.control.shape, to: "b[*].control.other" }
  - b[i].control.x -> b[i].control.taken
`;

it("buffers that can be connected come first, and the others say why they cannot", () => {
  const structure = readStructure(system);
  const [speed, ,] = structure.agents[0]!.subsystems[0]!.buffers.filter(({ direction }) => direction === "output");
  expect(partnersOf(structure, speed!)).toEqual([
    { path: "b.control.slow", reason: "" },
    { path: "b.control.go", reason: "its type is bool" },
    { path: "b.control.taken", reason: "it has its source already" },
    { path: "b.control.mm", reason: "its type is float64 mm" },
  ]);
  expect(channelEnd(structure, "b.control.slow")).toBe("b[i].control.slow");
  expect(channelEnd(structure, "a.control.speed")).toBe("a.control.speed");
});

it("an input of a single agent gets a value from each member of a fleet", () => {
  const depot = (type: string, grant: string) =>
    readStructure(`agents:
  carrier: { count: 2, control: { outputs: { ask: bool }, inputs: { grant: bool, go: bool }, behaviours: { run: {} } } }
  dock: { control: { inputs: { ask: "${type}" }, outputs: { grant: "${grant}", all: bool }, behaviours: { run: {} } } }
`);
  const channel = (from: string, to: string) => ({ do: "connect", at: ["channels"], fields: { from, to } });
  const plain = depot("bool", "bool[each carrier]");
  const [ask] = plain.agents[0]!.subsystems[0]!.buffers.filter(({ name }) => name === "ask");
  expect(partnersOf(plain, ask!)).toEqual([{ path: "dock.control.ask", reason: "" }]);
  expect(connectEdits(plain, "carrier.control.ask", "dock.control.ask")).toEqual([
    { do: "set", at: ["agents", "dock", "control", "inputs"], key: "ask", text: "bool[each carrier]", as: "scalar" },
    channel("carrier[i].control.ask", "dock.control.ask[i]"),
  ]);
  expect(connectEdits(plain, "dock.control.grant", "carrier.control.grant")).toEqual([
    channel("dock.control.grant[i]", "carrier[i].control.grant"),
  ]);
  expect(connectEdits(plain, "dock.control.all", "carrier.control.go")).toEqual([
    channel("dock.control.all", "carrier[i].control.go"),
  ]);
  const each = depot("bool[each carrier]", "bool");
  expect(partnersOf(each, ask!)).toEqual([{ path: "dock.control.ask", reason: "" }]);
  expect(connectEdits(each, "carrier.control.ask", "dock.control.ask")).toEqual([
    channel("carrier[i].control.ask", "dock.control.ask[i]"),
  ]);
});

it("the fields of a map are those of the schema, each with its own check", () => {
  const track = fieldsOf({ $ref: "#/$defs/track" }, schema);
  expect(track.map(({ key, required, parts }) => [key, required, parts])).toEqual([
    ["image", true, 0],
    ["metres_per_pixel", false, 0],
    ["start", false, 3],
    ["footprint", false, 0],
  ]);
  const wrong = (key: string, text: string) => track.find((one) => one.key === key)!.wrong(text);
  expect(wrong("metres_per_pixel", "0.005")).toBeUndefined();
  expect(wrong("metres_per_pixel", "small")).toMatch(/metres per pixel/);
  expect(wrong("footprint", "8 mm")).toBeUndefined();
  expect(wrong("footprint", "8 kg")).toMatch(/footprint/);
  expect(wrong("footprint", "")).toBeUndefined();
  const control = fieldsOf({ $ref: "#/$defs/control" }, schema);
  expect(control.find(({ key }) => key === "overrun")!.choices).toEqual(["skip", "catch_up", "fault"]);
});

it("the kinds of drivers are those of the schema, for the side and the place where they may be", () => {
  const kinds = driverKinds(schema);
  const of = (kind: string) => kinds.find((one) => one.kind === kind)!;
  expect([of("scan").side, of("velocity").side, of("panel").side, of("cpp").side]).toEqual([
    "receptor",
    "effector",
    "receptor",
    "both",
  ]);
  expect([of("scan").where, of("ros2").where, of("cpp").where]).toEqual(["world", "robot", "both"]);
  expect(of("scan").options.map(({ key }) => key)).toEqual(["from", "to", "reach", "noise", "groups"]);
  expect(of("ros2").options.find(({ key }) => key === "type")!.required).toBe(true);
});
