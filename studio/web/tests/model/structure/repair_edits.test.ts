import { describe, expect, it } from "vitest";
import type { Cause } from "../../../model/causes";
import { readStructure } from "../../../model/structure/structure";
import { candidatesFor } from "../../../model/text/repair_edits";

const structure = readStructure(`agents:
  robot: { use: carrier, count: 2 }
  desk:
    control:
      behaviours:
        wait: { next: charge }
        charge:
          start: dock
          behaviours:
            ask: { next: [{ to: dock, when: in.i.fresh }] }
            dock: { next: ask }
        lend: { for: each robot, next: [{ to: wait, when: "in.j[i].fresh" }] }
channels:
  - { from: "robot[i].control.o", to: "desk.control.j[i]", receive: blocking }
`);

const stuck = (behaviour: string): Cause => ({
  title: "",
  verdicts: [],
  dead: [],
  warning: false,
  atEnd: [
    { state: "no_successor", path: "desk.control", behaviour, channel: "", from: [], awaited: "nothing", text: "" },
  ] as unknown as Cause["atEnd"],
});

describe("repairs of a subsystem that is stuck", () => {
  it("lead to behaviours of the same group", () => {
    const found = candidatesFor(stuck("charge.ask"), structure);
    expect(found.map(({ edits }) => edits[0]!.fields!["to"])).toEqual(["dock", "ask"]);
    expect(found[0]!.edits[0]!.at).toEqual(["agents", "desk", "control", "behaviours", "charge", "behaviours", "ask"]);
  });

  it("lead from a behaviour for each member to that of the same member", () => {
    const found = candidatesFor(stuck("lend[1]"), structure);
    expect(found.map(({ edits }) => edits[0]!.fields!["to"])).toEqual(["wait", "lend[i]"]);
    expect(found.map(({ title }) => title)).toEqual(["Otherwise, go on to wait", "Otherwise, repeat lend[i]"]);
  });

  it("change the channel of all members", () => {
    const waits = { state: "waits", path: "desk.control", channel: "robot[1].control.o->desk.control.j[1]", awaited: "value" };
    const found = candidatesFor({ ...stuck(""), atEnd: [{ ...waits, from: [] }] as unknown as Cause["atEnd"] }, structure);
    expect(found.map(({ edits }) => edits[0]!.at)).toEqual([
      ["channels", 0],
      ["channels", 0],
    ]);
  });
});
