import { describe, expect, it } from "vitest";
import { intersects, type Box } from "../../../model/net/geometry";
import { rateText } from "../../../model/structure/cards";
import { bundleAt, bundlesOf, bundleTitle, connected } from "../../../model/structure/bundles";
import { levelOf } from "../../../model/structure/machine";
import { readStructure } from "../../../model/structure/structure";
import { drawStructure } from "../../../model/structure/structure_graph";
import { estimated } from "../../../model/structure/text_size";
import { elk } from "../line_follower";

const structure = readStructure(`agents:
  robot:
    control:
      rate: &fast 100 Hz
      inputs: { i: bool }
      on_error: safe
      start: ask
      behaviours:
        work: { terminal: { low: in.i, tired: elapsed > 2 s }, next: ask }
        ask:
          terminal: true
          error: in.i
          next: [{ to: retry, when: error }, { to: charge, when: in.i.fresh }, work]
        retry: { terminal: elapsed > 1 s }
        charge:
          until: in.i
          start: dock
          next: [{ to: safe, when: until }, work]
          behaviours:
            dock: { terminal: true, next: full }
            full: { terminal: in.i, next: end }
        lend: { for: each robot, terminal: true, next: "lend[i+1]" }
        safe: { next: nowhere }
    effectors:
      wheels: { rate: *fast, behaviours: { drive: {} } }
`);
const control = structure.agents[0]!.subsystems[0]!;
const short = (path: string) => path.replace("robot.control", "").replace(/^\./, "");

describe("the machine of a subsystem", () => {
  const level = levelOf(structure, control);
  const arrows = level.arrows.map(({ from, to, label, kind }) => `${short(from)} > ${short(to)} ${kind} ${label}`.trim());

  it("has an arrow for each entry of next, with its condition", () => {
    expect(arrows).toEqual([
      "#start > ask begin",
      "work > ask next low or tired",
      "ask > retry failure error: in.i",
      "ask > charge next in.i.fresh",
      "ask > work next else",
      "retry > #end next elapsed > 1 s",
      "charge > safe next until in.i",
      "charge > work next else",
      "lend > lend next [i+1]",
      "#failures > safe failure any other failure",
    ]);
    expect(level.arrows.map(({ entry }) => entry)).toEqual([null, 0, 0, 1, 2, null, 0, 1, 0, null]);
  });

  it("has the machines of groups inside", () => {
    const inside = levelOf(structure, control, "robot.control.charge");
    expect(inside.arrows.map(({ from, to, label }) => [short(from), short(to), label])).toEqual([
      ["charge#start", "charge.dock", ""],
      ["charge.dock", "charge.full", ""],
      ["charge.full", "charge#end", "in.i"],
    ]);
  });

  it("is drawn without a text over another", async () => {
    const { machine } = (await drawStructure(structure, elk, estimated)).cards.get(control.path)!;
    const labels = machine.arrows.flatMap(({ place, label }) => (place ? [[label, place] as const] : []));
    expect(labels.length).toBe(level.arrows.filter(({ label }) => label !== "").length + 1);
    const chips = [...machine.states].filter(([path]) => !path.endsWith("charge"));
    const all: (readonly [string, Box])[] = [...labels, ...chips];
    all.forEach(([name, box], at) =>
      all.slice(at + 1).forEach(([other, there]) => expect(intersects(box, there), `${name} over ${other}`).toBe(false)),
    );
    for (const [name, { x, y, width, height }] of all)
      expect(x >= 0 && y >= 0 && x + width <= machine.width && y + height <= machine.height, name).toBe(true);
  });
});

it("a rate is shown as a value, also where the file has an alias", () => {
  expect(structure.agents[0]!.subsystems.map((one) => rateText(structure, one))).toEqual(["100 Hz", "100 Hz"]);
});

describe("bundles", () => {
  const pair = readStructure(`agents:
  b: { control: { inputs: { i: bool, j: bool }, outputs: { o: bool } } }
  a: { control: { inputs: { i: bool }, outputs: { o: bool, p: bool } } }
  c: { control: { inputs: { i: bool } } }
channels:
  - a.control.o -> b.control.i
  - b.control.o -> a.control.i
  - a.control.p -> b.control.j
  - b.control.o -> c.control.i
  - a.control.o -> gone.control.i
`);
  it("hold the channels between two agents, in both directions", () => {
    const bundles = bundlesOf(connected(pair));
    expect(bundles).toEqual([
      { path: "bundle:a|b", agents: ["a", "b"], channels: [0, 1, 2] },
      { path: "bundle:b|c", agents: ["b", "c"], channels: [3] },
    ]);
    expect(bundles.map(bundleTitle)).toEqual(["3 channels between a and b", "1 channel between b and c"]);
    expect(bundleAt(pair, "bundle:b|c")?.channels).toEqual([3]);
    expect(bundleAt(pair, "bundle:a|c")).toBeUndefined();
  });
});
