import { expect, test } from "vitest";
import { readStructure } from "../../model/structure/structure";
import { longestBeside, readTakes, saidTried, takesEdits, takesText, whatIf } from "../../model/tried_times";

const ms = 1e6;
const structure = readStructure(`agents:
  robot:
    control:
      rate: 20 Hz
      behaviours: { follow: { takes: 2..8 ms }, search: { takes: 500 us }, ask: { takes: 1 ms..4 ms } }
    receptors:
      sensor: { rate: 50 Hz, behaviours: { watch: { takes: { normal: [2 ms, 0.3 ms], within: 1..3 ms } } } }
`);

test("a range of times is read and written in one unit", () => {
  expect(readTakes("1..3 ms")).toEqual({ shortest_ns: ms, longest_ns: 3 * ms });
  expect(readTakes("500 us..1.5 ms")).toEqual({ shortest_ns: 0.5 * ms, longest_ns: 1.5 * ms });
  expect(readTakes("2 ms")).toEqual({ shortest_ns: 2 * ms, longest_ns: 2 * ms });
  for (const other of ["", "3", "1..3", "fast", "1..3 ms or so"]) expect(readTakes(other)).toBeUndefined();
  for (const text of ["1..3 ms", "2 ms", "0.5..1.5 ms", "0..250 us", "1.5 s"]) expect(takesText(readTakes(text)!)).toBe(text);
});

test("a slider offers times around the present one, in their order", () => {
  for (const present of [1, 8 * ms, 1_234_567]) {
    const found = longestBeside(present);
    expect(found).toContain(present);
    expect(found).toEqual([...new Set(found)].sort((a, b) => a - b));
    expect(found[0]).toBeGreaterThanOrEqual(present / 10);
    expect(found.at(-1)).toBeLessThanOrEqual(present * 10);
  }
});

test("what is tried is told, and asked with a shortest time that is not above the longest", () => {
  expect(saidTried("robot.control", { period_ns: 25 * ms, longest_ns: 3 * ms })).toBe(
    "robot.control at 40 Hz, with calls of 3 ms at most",
  );
  expect(saidTried("robot.control", { longest_ns: 3 * ms })).toBe("robot.control with calls of 3 ms at most");
  expect(saidTried("robot.control", { period_ns: 0 })).toBe("robot.control without a rate");
  const timed = { path: "robot[0].control", period_ns: 1, shortest_ns: 2 * ms, longest_ns: 8 * ms, waits: false, missing: "" };
  expect(whatIf(new Map([["robot.control", { longest_ns: ms }]]), [timed])).toEqual([
    { path: "robot.control", longest_ns: ms, shortest_ns: ms },
  ]);
  expect(whatIf(new Map([["robot.control", { period_ns: 0 }]]), [timed])).toEqual([{ path: "robot.control", period_ns: 0 }]);
});

test("a shorter time cuts all ranges that are longer, a longer one extends the longest", () => {
  const subsystem = structure.agents[0]!.subsystems.find(({ name }) => name === "control")!;
  const texts = (longest_ns: number) => takesEdits(structure, subsystem, longest_ns)?.map((edit) => JSON.stringify(edit));
  const shorter = texts(3 * ms)!;
  expect(shorter).toHaveLength(2);
  expect(shorter[0]).toContain("2..3 ms");
  expect(shorter[1]).toContain("1..3 ms");
  const longer = texts(10 * ms)!;
  expect(longer).toHaveLength(1);
  expect(longer[0]).toContain("2..10 ms");
  const sensor = structure.agents[0]!.subsystems.find(({ name }) => name === "sensor")!;
  expect(takesEdits(structure, sensor, ms)).toBeUndefined();
});
