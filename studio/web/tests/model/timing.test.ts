import { readFileSync } from "node:fs";
import { expect, test } from "vitest";
import type { TimedChain, Timing } from "../../model/protocol";
import { readStructure } from "../../model/structure/structure";
import {
  chainName,
  periodsBeside,
  saidStep,
  sharesOf,
  shownBound,
  shownChain,
  shownRate,
  shownTime,
  verdictOf,
  worstFirst,
} from "../../model/timing";
import { editsOf, limitEdits } from "../../model/timing_edits";

const text = `agents:
  robot:
    control: { rate: 20 Hz, inputs: { line: bool }, outputs: { motion: bool }, behaviours: { follow: {} } }
    receptors:
      sensor: { rate: 50 Hz, outputs: { line: bool }, behaviours: { watch: {} } }
    effectors:
      motor: { rate: 50 Hz, inputs: { motion: bool }, behaviours: { drive: {} } }
channels:
  - robot.sensor.line -> robot.control.line
  - robot.control.motion -> robot.motor.motion
`;

const bound = (at_most_ns: number | null, answer: TimedChain["age"]["answer"] = "not_asked") => ({
  at_most_ns,
  asked_ns: answer === "not_asked" ? null : 100e6,
  answer,
});
const chain = (answer?: TimedChain["age"]["answer"], change: Partial<TimedChain> = {}): TimedChain => ({
  name: "robot.sensor -> robot.control -> robot.motor",
  named: false,
  path: ["robot.sensor", "robot.control", "robot.motor"],
  channels: [],
  agents: 1,
  age: bound(82e6),
  reaction: bound(142e6, answer),
  exact: false,
  why: "",
  ...change,
});

/** The list of the C++ test of the same words. */
const timeTexts = readFileSync(new URL("../../../../tests/timing/time_texts.inc", import.meta.url), "utf8");

test("a time has at most four digits, is rounded up, and is written as the commands write it", () => {
  const list = [...timeTexts.matchAll(/^\{(\d+), "(.+)"\},$/gm)].map(([, ns, text]) => ({ ns: Number(ns), text }));
  expect(list.length).toBeGreaterThan(10);
  for (const { ns, text } of list) expect(shownTime(ns)).toBe(text);
  expect(shownBound(null)).toBe("no bound");
  expect([50e6, 33_333_333, 0].map(shownRate)).toEqual(["20 Hz", "30 Hz", "no rate"]);
});

test("a slider has the present rate between the usual ones", () => {
  const periods = periodsBeside(33_333_333);
  expect(periods).toContain(33_333_333);
  expect([...periods].sort((a, b) => b - a)).toEqual(periods);
  expect(new Set(periodsBeside(50e6)).size).toBe(periodsBeside(50e6).length);
});

test("a chain that breaks what was asked is shown first, and one without a bound is unknown", () => {
  const [fine, slow, unbounded] = [
    chain("holds", { name: "a", named: true }),
    chain("violated", { name: "b", named: true }),
    chain(undefined, { name: "c", named: true, why: "nobody knows" }),
  ];
  expect([fine, slow, unbounded, chain()].map(verdictOf)).toEqual(["holds", "violated", "unknown", "none"]);
  expect(worstFirst([fine, slow, unbounded]).map(chainName)).toEqual(["b", "c", "a"]);
  const timing: Timing = { chains: [fine, slow, unbounded], subsystems: [], steps: null };
  expect(shownChain(timing, null)).toBe(slow);
  expect(shownChain(timing, "c")).toBe(unbounded);
  expect(shownChain(timing, "gone")).toBe(slow);
});

test("parts of one subsystem that follow one another are its share", () => {
  const step = (subsystem: string, ns: number) => ({ kind: "takes" as const, subsystem, channel: null, ns });
  const shares = sharesOf([step("a.x", 1), step("a.x", 2), step("a.y", 4), step("a.x", 8)]);
  expect(shares.map(({ subsystem, ns }) => [subsystem, ns])).toEqual([
    ["a.x", 3],
    ["a.y", 4],
    ["a.x", 8],
  ]);
});

test("a message and a foreign node are parts in words", () => {
  const sent = { kind: "network" as const, subsystem: "base.control", channel: "robot.control.x->base.control.x", ns: 1 };
  expect(saidStep(sent, true)).toBe("the value is on the way to control (network)");
  const answered = { kind: "foreign" as const, subsystem: "planner", channel: null, ns: 1 };
  expect(saidStep(answered, false)).toBe("planner answers, which is not of this system");
});

const timing: Timing = {
  chains: [chain()],
  subsystems: [
    { path: "robot.control", period_ns: 50e6, shortest_ns: 1, longest_ns: 2, waits: false, missing: "" },
    { path: "robot.motor", period_ns: 20e6, shortest_ns: 1, longest_ns: 2, waits: false, missing: "" },
  ],
  steps: null,
};

test("a change that helps has its edits", () => {
  const structure = readStructure(text);
  const change = (kind: Parameters<typeof editsOf>[0]["kind"], subsystem: string, channel: string | null = null) =>
    editsOf({ kind, subsystem, channel, age_ns: 1, reaction_ns: 1 }, structure, timing);
  const control = ["agents", "robot", "control"];
  expect(change("twice_the_rate", "robot.control")).toMatchObject([{ do: "set", at: control, key: "rate", text: "40 Hz" }]);
  expect(change("event_driven", "robot.motor", "robot.control.motion->robot.motor.motion")).toMatchObject([
    { do: "set", key: "rate", text: "" },
    { do: "channel", at: ["channels", 1], fields: { receive: "blocking" } },
  ]);
  expect(change("own_processor", "robot.motor")).toBeUndefined();
  expect(change("twice_the_rate", "robot.arm")).toBeUndefined();
});

test("the first limit comes with all chains, so that none is lost; a later one changes its entry", () => {
  const other = chain(undefined, { path: ["robot.eye", "robot.control", "robot.motor"] });
  const [first] = limitEdits(readStructure(text), { ...timing, chains: [timing.chains[0]!, other] }, other, "age", "80 ms");
  expect(first).toMatchObject({
    do: "insert",
    key: "timing",
    value: {
      chains: [
        { name: "robot sensor to motor", path: ["robot.sensor", "robot.control", "robot.motor"] },
        { name: "robot eye to motor", path: ["robot.eye", "robot.control", "robot.motor"], age: "80 ms" },
      ],
    },
  });
  const members = [0, 1].map((at) =>
    chain(undefined, { path: ["sensor", "control", "motor"].map((one) => `rover[${at}].${one}`), agents: 4 }),
  );
  const [ofFleet] = limitEdits(readStructure(text), { ...timing, chains: members }, members[0]!, "age", "80 ms");
  expect(ofFleet!.value).toEqual({
    chains: [{ name: "rover sensor to motor", path: ["rover[i].sensor", "rover[i].control", "rover[i].motor"], age: "80 ms" }],
  });
  const asked = `${text}timing:\n  chains:\n    - { name: quick, path: [robot.sensor, robot.control, robot.motor] }\n`;
  const quick = chain(undefined, { named: true, name: "quick" });
  expect(limitEdits(readStructure(asked), { ...timing, chains: [quick] }, quick, "reaction", "1 s")).toMatchObject([
    { do: "set", at: ["timing", "chains", 0], key: "reaction", text: "1 s" },
  ]);
  expect(limitEdits(readStructure(text), timing, timing.chains[0]!, "age", "")).toEqual([]);
});
