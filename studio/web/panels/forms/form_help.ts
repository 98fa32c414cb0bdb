import type { EditValue } from "../../model/protocol";
import { limitNames } from "../../model/structure/inside_types";
import type { Structure, Subsystem } from "../../model/structure/structure";
import type { HelpByKey } from "./object_fields";
import type { Targets } from "./targets";

/** The forms know this beyond the schema: words, new entries and proposals. */

/** A channel that holds one value: the sender waits until it is empty, the receiver until it is full. */
const oneValue = {
  shared: { empty: "1", full: "0" },
  send: {
    places: "{ in, write: { write: 1 }, out }",
    transitions: { begin: "{ from: [in, empty], to: [write] }", end: "{ from: [write], to: [out, full] }" },
  },
  receive: {
    places: "{ in, read: { read: 1 }, out }",
    transitions: { begin: "{ from: [in, full], to: [read] }", end: "{ from: [read], to: [out, empty] }" },
  },
};

export const modelHelp: HelpByKey = {
  models: {
    title: "Communication models",
    one: "model",
    hint: "A channel chooses one of them instead of the built-in ones",
    fresh: { name: "own", value: oneValue },
    folds: true,
  },
  shared: {
    one: "shared place",
    hint: "The places that both sides see, with their tokens at the start",
    fresh: { name: "place", value: "0" },
  },
  places: {
    hint: "A side begins in 'in' and ends in 'out'. Between, a place may write or read a slot",
    fresh: { name: "place", value: "{}" },
  },
  transitions: {
    hint: "Each takes a token from some places and gives one to others",
    compact: true,
    fresh: { name: "step", value: "{ from: [in], to: [out] }" },
  },
};

export const safeHelp = ({ buffers }: Subsystem): HelpByKey => ({
  ...Object.fromEntries(buffers.map(({ name }) => [name, { compact: true }])),
  safe: { title: "Safe command", hint: "The devices get it when the subsystem stops or fails. It is zero by default" },
});

export const limitHelp: HelpByKey = {
  min: { title: "Least" },
  max: { title: "Most" },
  per_second: { title: "Change per second" },
  beyond: { title: "Beyond them" },
};

export function limitsHelp(structure: Structure, subsystem: Subsystem): HelpByKey {
  const names = subsystem.buffers.filter(({ direction }) => direction === "real").flatMap((one) => limitNames(structure, one));
  const taken = structure.yaml.keys([...subsystem.yaml, "limits"]);
  const name = names.find((one) => !taken.includes(one)) ?? names[0];
  return {
    ...limitHelp,
    limits: {
      title: "Limits of real outputs",
      hint: "Each entry is a real buffer, or a number inside it",
      compact: true,
      one: "limits",
      names,
      fresh: { ...(name ? { name } : {}), value: "{ min: -1, max: 1 }" },
    },
  };
}

/** Conditions and numbers that a run in the world can be asked for. */
export function worldHelp({ yaml }: Structure, targets: Targets): HelpByKey {
  const placed = yaml.keys(["simulation", "models"]);
  const things = [...placed, ...(targets.pose ?? []).filter((one) => !placed.includes(one))];
  // Several things need a word that says whether one or all of them are meant.
  const each = (thing: string, text: string) => (thing.includes("[*]") ? `any(${text})` : text);
  const first = things[0] ?? "robot";
  const numbers = things.flatMap((one) => (one.includes("[*]") ? [] : [`height(${one})`, `speed(${one})`]));
  const pairs = placed.filter((one) => one.includes("[*]")).map((one) => `distance(${one}, ${one})`);
  const conditions = [
    ...things.map((one) => each(one, `contact(${one})`)),
    ...things.map((one) => each(one, `height(${one}) > 10 cm`)),
    ...things.map((one) => each(one, `speed(${one}) > 1 m/s`)),
    ...pairs.map((one) => `${one} > 20 cm`),
  ];
  const count = yaml.seq(["simulation", "checks"])?.items.length ?? 0;
  // Without a world, only what a run uses can be checked.
  const demand: Record<string, EditValue> = yaml.pair(["simulation", "world"])
    ? { never: each(first, `contact(${first})`) }
    : { at_most: { energy: "200 J" } };
  const asked = Object.fromEntries(
    ["never", "always", "at_end", "eventually"].map((key) => [key, { choices: conditions, mono: true }]),
  );
  return {
    ...asked,
    checks: {
      hint: "Conditions of a simulated run",
      fresh: { value: { name: `check ${count + 1}`, ...demand } },
    },
    at_most: {
      title: "At most",
      one: "resource",
      hint: "What all agents may use together in a run; behaviours say what they use",
      fresh: { name: "energy", value: "200 J" },
    },
    measures: {
      hint: "Numbers that a simulated run reports at its end",
      choices: [...numbers, ...pairs],
      fresh: { name: "measure", value: numbers[0] ?? pairs[0] ?? `speed(${first})` },
    },
    models: {
      title: "Placed models",
      one: "model",
      hint: "Models in the world: of an agent, of each member of a fleet (robot[*]), or of things",
      names: yaml
        .keys(["agents"])
        .map((name) => (yaml.pair(["agents", name, "count"]) ? `${name}[*]` : name))
        .filter((name) => !placed.includes(name)),
      fresh: { name: "thing", value: "{ model: thing.xml, at: [0, 0] }" },
    },
    vary: { one: "range", fresh: { name: "body.mass", value: "[1, 2]" } },
    grid: { fresh: { value: "{ columns: 2, spacing: 1 m }" } },
  };
}

export function deployHelp({ yaml }: Structure): HelpByKey {
  const agents = yaml.keys(["agents"]).map((name) => (yaml.pair(["agents", name, "count"]) ? `${name}[*]` : name));
  return {
    deploy: { title: "Deployment", hint: "The processes of the system, and the agents in each" },
    processes: {
      hint: "A process NAME[*] stands for one per member of a fleet",
      choices: agents,
      fresh: { name: "process", value: agents[0] ?? "robot" },
    },
    agents: { choices: agents },
  };
}

export const driverHelp: HelpByKey = {
  panel: {
    one: "control",
    choices: ["button", "switch", "slider", "stick_x", "stick_y"],
    fresh: { name: "field", value: "slider" },
  },
  fields: {
    hint: "A field of the message, and the field of the buffer; equal names need no entry",
    one: "field",
    fresh: { name: "data", value: "field" },
  },
};
