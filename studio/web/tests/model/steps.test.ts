import { describe, expect, it } from "vitest";
import { stepsOf, verdictsInWords, type Situation } from "../../model/steps";

const calm: Situation = {
  blank: false,
  errors: 0,
  warnings: 0,
  checking: false,
  unsaved: false,
  verifying: false,
  verdicts: [],
  verdictsCurrent: false,
  verifyProblem: "",
  missing: 0,
  run: "idle",
  runKind: "simulate",
  runProblem: "",
};
const states = (change: Partial<Situation>) => stepsOf({ ...calm, ...change }).map(({ state }) => state);
const primaries = (change: Partial<Situation>) =>
  stepsOf({ ...calm, ...change }).map(({ primary }) => `${primary.label}${primary.enabled ? "" : " (not now)"}`);
const holds = { verdict: "holds", warning: false } as const;
const violated = { verdict: "violated", warning: false } as const;
const warned = { verdict: "violated", warning: true } as const;
const unknown = { verdict: "unknown", warning: false } as const;

describe("the three steps", () => {
  it("are open in a project without problems", () => {
    expect(states({})).toEqual(["no problems", "no verdict yet", "ready"]);
    expect(primaries({})).toEqual(["Save (not now)", "Verify", "Run"]);
    expect(primaries({ unsaved: true })[0]).toBe("Save");
  });

  it("begin with a choice in an empty folder", () => {
    expect(states({ blank: true })).toEqual(["choose a beginning", "no system yet", "no system yet"]);
    expect(primaries({ blank: true })).toEqual(["Save (not now)", "Verify (not now)", "Run (not now)"]);
  });

  it("say what stands in the way, and a click leads there", () => {
    const broken = stepsOf({ ...calm, errors: 3 });
    expect(broken.map(({ state }) => state)).toEqual([
      "3 errors",
      "needs a specification without errors",
      "needs a specification without errors",
    ]);
    expect(broken.every(({ leads }) => leads === "show_error")).toBe(true);
    expect(primaries({ errors: 3, unsaved: true })).toEqual(["Save", "Verify (not now)", "Run (not now)"]);
    const lacking = stepsOf({ ...calm, missing: 4 })[2];
    expect(lacking).toMatchObject({ state: "4 functions are missing: write them", leads: "write_functions" });
    expect(states({ missing: 1 })[2]).toBe("1 function is missing: write it");
    expect(states({ warnings: 1 })[0]).toBe("1 warning");
  });

  it("say that a time is too long, or not proved; such a system runs", () => {
    const times = { late: 2, unproved: 1 };
    expect(states({ verdicts: [holds], verdictsCurrent: true, times }).slice(1)).toEqual(["2 times too long", "ready"]);
    const unproved = stepsOf({ ...calm, verdicts: [holds], verdictsCurrent: true, times: { ...times, late: 0 } })[1];
    expect(unproved).toMatchObject({ state: "1 time not proved", tone: "warning" });
    const both = stepsOf({ ...calm, verdicts: [holds, violated], verdictsCurrent: true, times })[1];
    expect(both).toMatchObject({ state: "1 violated, 2 times too long", tone: "error" });
  });

  it("do not say that a system is verified before its times are known", () => {
    const step = (timing: Situation["timing"], verdicts: Situation["verdicts"]) =>
      stepsOf({ ...calm, verdicts, verdictsCurrent: true, ...(timing ? { timing } : {}) })[1];
    expect(step("computing", [holds])).toMatchObject({ state: "computing times…", tone: "busy" });
    expect(step("computing", [holds, warned]).state).toBe("verified, 1 warning, computing times…");
    expect(step("failed", [holds])).toMatchObject({ state: "times not computed", tone: "warning" });
    expect(step("known", [holds]).state).toBe("verified");
  });

  it("do not let a violated system run, as the server would not, until the text has changed", () => {
    const verdicts = [holds, violated];
    expect(states({ verdicts, verdictsCurrent: true }).slice(1)).toEqual(["1 violated", "needs a system that passes Verify"]);
    expect(primaries({ verdicts, verdictsCurrent: true })[2]).toBe("Run (not now)");
    expect(states({ verdicts, verdictsCurrent: false }).slice(1)).toEqual(["changed since", "ready"]);
    expect(states({ verdicts: [holds, warned], verdictsCurrent: true }).slice(1)).toEqual(["verified, 1 warning", "ready"]);
  });

  it("end what goes on", () => {
    expect(primaries({ verifying: true })[1]).toBe("Stop");
    for (const run of ["building", "running", "paused"] as const) {
      const last = stepsOf({ ...calm, run, errors: 2, missing: 1 })[2];
      expect(last.primary).toMatchObject({ act: "stop_run", enabled: true });
    }
    expect(states({ run: "running", runKind: "attach" })[2]).toBe("watching");
    expect(stepsOf({ ...calm, runKind: "attach" })[2].primary.act).toBe("show_run");
    expect(states({ run: "failed" })[2]).toBe("failed");
  });

  it("sum up verdicts", () => {
    expect(verdictsInWords([holds, unknown])).toEqual({ tone: "warning", text: "1 unknown" });
    expect(verdictsInWords([holds, unknown, violated]).text).toBe("1 violated");
    expect(verdictsInWords([holds])).toEqual({ tone: "good", text: "verified" });
  });
});
