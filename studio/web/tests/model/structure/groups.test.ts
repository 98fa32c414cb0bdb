import { describe, expect, it } from "vitest";
import { agentNote } from "../../../model/structure/cards";
import { exampleOf } from "../../../model/structure/kept_cells";
import { groupTemplates, takenBy } from "../../../model/structure/group_templates";
import { behavioursIn, findThing, leadsFailures, readStructure, targetsIn, thingAt } from "../../../model/structure/structure";
import { chipText } from "../../../model/structure/machine_layout";
import { drawStructure } from "../../../model/structure/structure_graph";
import { estimated } from "../../../model/structure/text_size";
import { elk } from "../line_follower";

const text = `agents:
  robot: { use: carrier, count: 2 }
  desk:
    control:
      on_error: work
      behaviours:
        work: { next: charge }
        charge:
          on_error: ask
          start: dock
          behaviours:
            ask: { next: dock }
            dock:
              behaviours:
                turn: {}
            an_extremely_long_name_of_a_behaviour: {}
        lend: { for: each robot, next: "lend[i]" }
`;

describe("groups of behaviours", () => {
  const structure = readStructure(text);
  const control = structure.agents[1]!.subsystems[0]!;
  const of = (path: string) => control.behaviours.find((one) => one.path === `desk.control.${path}`)!;

  it("are read with what is in them, in the order of the file", () => {
    expect(control.behaviours.map(({ path }) => path.slice("desk.control.".length))).toEqual([
      "work",
      "charge",
      "charge.ask",
      "charge.dock",
      "charge.dock.turn",
      "charge.an_extremely_long_name_of_a_behaviour",
      "lend",
    ]);
    expect(of("charge.dock.turn").function).toBe("charge_dock_turn");
    expect(of("charge.dock").isGroup).toBe(true);
    expect(of("work").group).toBe("");
  });

  it("have the targets of their own behaviours", () => {
    expect(targetsIn(control)).toEqual(["work", "charge", "lend[0]"]);
    expect(targetsIn(control, "desk.control.charge")).toEqual(["ask", "dock", "an_extremely_long_name_of_a_behaviour"]);
    expect(behavioursIn(control, "desk.control.charge.dock").map(({ name }) => name)).toEqual(["turn"]);
  });

  it("are found by their path, also for each member", () => {
    expect(findThing(structure, "desk.control.charge.dock.turn")).toMatchObject({ kind: "behaviour", of: { name: "turn" } });
    expect(findThing(structure, "desk.control.lend[1]")).toMatchObject({ kind: "behaviour", of: { for: "each robot" } });
    expect(findThing(structure, "desk.control.charge.turn")).toBeUndefined();
    expect(thingAt(structure, 15)).toBe("desk.control.charge.dock.turn");
  });

  it("have examples of changes for members", () => {
    expect(exampleOf([{ name: "lent_to", counts: "", values: ["nobody", "each robot"] }])).toBe('{ lent_to: "robot[0]" }');
  });

  it("lead failures themselves", () => {
    expect(leadsFailures(structure, control, of("charge.dock"))).toEqual({ text: "ask", of: "group" });
    expect(leadsFailures(structure, control, of("charge.dock.turn"))).toBeUndefined();
    expect(leadsFailures(structure, control, of("charge"))).toEqual({ text: "work", of: "subsystem" });
  });

  it("have room in the drawing for what is in them, and for their names", async () => {
    expect(chipText(of("lend"))).toBe("lend[i]");
    const { states } = (await drawStructure(structure, elk, estimated)).cards.get("desk.control")!.machine;
    const box = (path: string) => states.get(`desk.control.${path}`)!;
    const long = "charge.an_extremely_long_name_of_a_behaviour";
    expect(box(long).width).toBeGreaterThan(estimated("an_extremely_long_name_of_a_behaviour", "text"));
    for (const [inside, group] of [
      ["charge.ask", "charge"],
      [long, "charge"],
      ["charge.dock.turn", "charge.dock"],
    ] as const) {
      const [one, around] = [box(inside), box(group)];
      expect(one.x).toBeGreaterThan(around.x);
      expect(one.y).toBeGreaterThan(around.y + 20);
      expect(one.x + one.width).toBeLessThan(around.x + around.width);
      expect(one.y + one.height).toBeLessThan(around.y + around.height);
    }
  });
});

describe("templates of groups", () => {
  const structure = readStructure(`tessera: 1
system: s
templates:
  docking: { with: [grant], behaviours: { ask: { receive: [grant] }, again: { use: round } } }
  round: { behaviours: { turn: {}, more: { use: round } } }
  carrier: { control: { behaviours: { run: {} } } }
agents:
  robot: { control: { rate: 1 Hz, behaviours: { charge: { use: docking, with: { grant: left }, next: charge } } } }
`);
  const control = structure.agents[0]!.subsystems[0]!;

  it("give a group its behaviours, and circles end", () => {
    const prefix = "robot.control.".length;
    const paths = control.behaviours.map(({ path }) => path.slice(prefix));
    expect(paths).toEqual(["charge", "charge.ask", "charge.again", "charge.again.turn", "charge.again.more"]);
    expect(control.behaviours[0]).toMatchObject({ isGroup: true, template: "docking", inTemplate: "" });
    expect(control.behaviours[1]).toMatchObject({
      function: "charge_ask",
      inTemplate: "docking",
      yaml: ["templates", "docking", "behaviours", "ask"],
    });
  });

  it("are told from those of agents, with what they take", () => {
    expect(groupTemplates(structure.yaml)).toEqual(["docking", "round"]);
    expect(takenBy(structure.yaml, "docking")).toEqual(["grant"]);
    expect(takenBy(structure.yaml, "round")).toEqual([]);
  });
});

describe("an agent whose template is in an included file", () => {
  const agentsOf = (text: string) => readStructure(text).agents.map(({ name, included }) => [name, included]);
  it("is no agent without subsystems", () => {
    const rest = "templates: { own: { control: {} } }\nagents: { a: { use: carrier }, b: { use: own }, c: { control: {} } }\n";
    expect(agentsOf(`include: carrier.yaml\n${rest}`)).toEqual([
      ["a", true],
      ["b", false],
      ["c", false],
    ]);
    // Without included files, the name of the template is a mistake.
    expect(agentsOf(rest)[0]).toEqual(["a", false]);
    const drawn = readStructure(`include: carrier.yaml\n${rest}`).agents[0]!;
    expect(agentNote(drawn)).toBe(" uses carrier of an included file");
  });
});
