import { expect, test } from "vitest";
import { longestOf, chainOfRun, saidMeasured, type ChainOfRun } from "../../model/ages_of_run";

const measured = (name: string, change: Partial<ChainOfRun> = {}): ChainOfRun => ({
  name,
  members: 1,
  commands: 100,
  over: 0,
  longest_age_s: 0.079,
  proved_age_s: 0.081,
  ...change,
});
const path = ["robot.sensor", "robot.control", "robot.motor"];
const named = (name: string) => ({ name, named: true, path });

test("a chain finds what a run has measured of it, by its name or by its path", () => {
  const all = [measured("joints to motors"), measured("robot.sensor -> robot.control -> robot.motor")];
  expect(chainOfRun(named("joints to motors"), all)).toBe(all[0]);
  expect(chainOfRun({ name: "", named: false, path }, all)).toBe(all[1]);
  expect(chainOfRun(named("another"), all)).toBeUndefined();
});

test("the chains of a fleet are one in both", () => {
  const one = [measured("cart[].eye -> cart[].control -> cart[].wheels", { members: 3 })];
  const members = ["cart[0].eye", "cart[0].control", "cart[0].wheels"];
  expect(chainOfRun({ name: "", named: false, path: members }, one)).toBe(one[0]);
  expect(chainOfRun(named("look[0]"), [measured("look[]")])).toBeDefined();
});

test("a measured time is said with the bound of the run, if that is another one or is exceeded", () => {
  const said = (change: Partial<ChainOfRun>, shown: number | null) => {
    const longest = longestOf(measured("a", change), "age");
    return longest && saidMeasured(longest, shown);
  };
  expect(said({}, 81e6)).toBe("measured: 79 ms");
  expect(said({}, 60e6)).toBe("measured: 79 ms (the run has 81 ms)");
  expect(said({ longest_age_s: 0.095 }, 81e6)).toBe("measured: 95 ms, over 81 ms");
  expect(said({ longest_age_s: 0.095, proved_age_s: undefined }, null)).toBe("measured: 95 ms");
  expect(said({ longest_age_s: undefined }, 81e6)).toBeNull();
  expect(longestOf(measured("a"), "reaction")).toBeNull();
  expect(longestOf(undefined, "age")).toBeNull();
});
