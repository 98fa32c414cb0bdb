import { expect, it } from "vitest";
import { senderOf } from "../../../model/structure/senders";
import { readStructure } from "../../../model/structure/structure";

it("the sender of an input is that of its channel, also for members of a fleet and elements of an array", () => {
  const structure = readStructure(`agents:
  carrier: { count: 2, control: { rate: 20 Hz, inputs: { wish: Wish }, outputs: { ask: bool }, behaviours: { run: {} } } }
  dock: { control: { inputs: { ask: "bool[each carrier]" }, behaviours: { run: {} } } }
  office: { control: { rate: 5 Hz, outputs: { wish: Wish }, behaviours: { run: {} } } }
channels:
  - office.control.wish -> carrier[*].control.wish
  - carrier[i].control.ask -> dock.control.ask[i]
`);
  const office = { path: "office.control", rate: "5 Hz" };
  expect(senderOf(structure, "carrier[0].control.wish")).toEqual(office);
  expect(senderOf(structure, "carrier[1].control.wish.pause")).toEqual(office);
  expect(senderOf(structure, "dock.control.ask[1]")).toEqual({ path: "carrier.control", rate: "20 Hz" });
  expect(senderOf(structure, "carrier[0].control.wishes")).toBeUndefined();
  expect(senderOf(structure, "office.control.wish")).toBeUndefined();
});
