/** The three steps of the work: edit, verify, run. Each has a state, one primary button, and possibly something in its way. */

import type { RunKind, RunState, Verdict } from "./protocol";

/** An act of the page that a step offers. */
export type Act =
  | "save"
  | "verify"
  | "stop_verify"
  | "run"
  | "stop_run"
  | "write_functions"
  | "show_form"
  | "show_error"
  | "show_problems"
  | "show_verdicts"
  | "show_run";

export interface Step {
  step: "edit" | "verify" | "run";
  title: string;
  tone: "good" | "warning" | "error" | "busy" | "open";
  /** The state in a few words, also why the step cannot be done now. */
  state: string;
  /** The effect of a click on the state. */
  leads: Act;
  /** `name` is the whole name of the button, for those who do not see the step. */
  primary: { label: string; name: string; act: Act; enabled: boolean };
}

/** The state that the steps depend on. */
export interface Situation {
  /** The specification is empty: a project begins with a choice. */
  blank: boolean;
  errors: number;
  warnings: number;
  checking: boolean;
  unsaved: boolean;
  verifying: boolean;
  /** The verdicts of the last verification; none: there was none. */
  verdicts: readonly Pick<Verdict, "verdict" | "warning">[];
  /** Chains that may take longer than was asked: surely, and perhaps. */
  times?: { late: number; unproved: number };
  /** Whether their times are being computed, or could not be. */
  timing?: "known" | "computing" | "failed";
  /** The verdicts are about the text as it is now. */
  verdictsCurrent: boolean;
  /** Why the last verification failed. */
  verifyProblem: string;
  /** Functions of behaviours that no source has. */
  missing: number;
  run: RunState | "idle";
  runKind: RunKind;
  /** Why the last run could not start. */
  runProblem: string;
}

const counted = (number: number, one: string) => `${number} ${one}${number === 1 ? "" : "s"}`;

/** The state of the three steps, in their order. */
export function stepsOf(now: Situation): [Step, Step, Step] {
  return [edit(now), verify(now), run(now)];
}

function edit({ blank, errors, warnings, checking, unsaved }: Situation): Step {
  const [tone, state, leads] = blank
    ? (["open", "choose a beginning", "show_form"] as const)
    : errors > 0
      ? (["error", counted(errors, "error"), "show_error"] as const)
      : checking
        ? (["busy", "checking…", "show_problems"] as const)
        : warnings > 0
          ? (["warning", counted(warnings, "warning"), "show_problems"] as const)
          : (["good", "no problems", "show_form"] as const);
  return {
    step: "edit",
    title: "Edit",
    tone,
    state,
    leads,
    primary: { label: "Save", name: "Save", act: "save", enabled: unsaved },
  };
}

/** The result of a verification in a few words. */
export function verdictsInWords(verdicts: Situation["verdicts"]): { tone: "good" | "warning" | "error"; text: string } {
  const violated = verdicts.filter((one) => one.verdict === "violated" && !one.warning).length;
  const unknown = verdicts.filter((one) => one.verdict === "unknown").length;
  const warnings = verdicts.filter((one) => one.verdict === "violated" && one.warning).length;
  if (violated > 0) return { tone: "error", text: `${violated} violated` };
  const besides = warnings > 0 ? `, ${counted(warnings, "warning")}` : "";
  return unknown > 0 ? { tone: "warning", text: `${unknown} unknown${besides}` } : { tone: "good", text: `verified${besides}` };
}

function verify(now: Situation): Step {
  const primary = now.verifying
    ? ({ label: "Stop", name: "Stop the verification", act: "stop_verify", enabled: true } as const)
    : ({ label: "Verify", name: "Verify the system", act: "verify", enabled: !now.blank && now.errors === 0 } as const);
  const [tone, state, leads] = ((): [Step["tone"], string, Act] => {
    if (now.verifying) return ["busy", "verifying…", "show_verdicts"];
    if (now.blank) return ["open", "no system yet", "show_form"];
    if (now.errors > 0) return ["open", "needs a specification without errors", "show_error"];
    if (now.verifyProblem) return ["error", "failed", "show_verdicts"];
    if (now.verdicts.length === 0) return ["open", "no verdict yet", "show_verdicts"];
    if (!now.verdictsCurrent) return ["open", "changed since", "show_verdicts"];
    const { tone, text } = verdictsInWords(now.verdicts);
    const { late, unproved } = now.times ?? { late: 0, unproved: 0 };
    const besides = tone === "good" && text === "verified" ? "" : `${text}, `;
    if (now.timing === "computing") return ["busy", `${besides}computing times…`, "show_verdicts"];
    if (now.timing === "failed") return [tone === "good" ? "warning" : tone, `${besides}times not computed`, "show_verdicts"];
    if (late > 0) return ["error", `${besides}${counted(late, "time")} too long`, "show_verdicts"];
    if (unproved > 0)
      return [tone === "good" ? "warning" : tone, `${besides}${counted(unproved, "time")} not proved`, "show_verdicts"];
    return [tone, text, "show_verdicts"];
  })();
  return { step: "verify", title: "Verify", tone, state, leads, primary };
}

const runStates: Record<RunState, [Step["tone"], string]> = {
  building: ["busy", "building…"],
  running: ["busy", "running"],
  paused: ["warning", "paused"],
  ended: ["good", "ended"],
  failed: ["error", "failed"],
};

function run(now: Situation): Step {
  const active = now.run === "building" || now.run === "running" || now.run === "paused";
  const watches = now.runKind === "attach" || now.runKind === "deployment";
  const [state, tone, leads, ready] = ((): [string, Step["tone"], Act, boolean] => {
    if (active) {
      const [tone, state] = runStates[now.run as RunState];
      return [watches && now.run === "running" ? "watching" : state, tone, "show_run", true];
    }
    if (now.blank) return ["no system yet", "open", "show_form", false];
    if (now.errors > 0) return ["needs a specification without errors", "open", "show_error", false];
    if (watches) return ["choose a controller", "open", "show_run", true];
    if (now.verdictsCurrent && verdictsInWords(now.verdicts).tone === "error")
      return ["needs a system that passes Verify", "error", "show_verdicts", false];
    if (now.missing > 0)
      return [
        now.missing === 1 ? "1 function is missing: write it" : `${now.missing} functions are missing: write them`,
        "warning",
        "write_functions",
        // The studio finds functions by reading the sources: the compiler, not the page, knows those of libraries.
        true,
      ];
    if (now.runProblem) return ["did not start", "error", "show_run", true];
    if (now.run === "idle") return ["ready", "open", "show_run", true];
    const [tone, state] = runStates[now.run];
    return [state, tone, "show_run", true];
  })();
  const primary = active
    ? ({ label: "Stop", name: watches ? "Stop watching the run" : "Stop the run", act: "stop_run", enabled: true } as const)
    : ({ label: "Run", name: "Build and run", act: watches ? "show_run" : "run", enabled: ready } as const);
  return { step: "run", title: "Run", tone, state, leads, primary };
}
