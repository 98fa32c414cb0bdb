import type { NamedBreakpoint } from "./breakpoints";
import type { Outcome, PanelShown, ParameterShown, RunKind, RunListed, RunState, StartRequest } from "../../model/protocol";
import type { ChainOfRun } from "../../model/ages_of_run";

/** The settings of the form for the next run. */
export interface Wishes {
  kind: RunKind;
  /** Empty: that of the specification. */
  track: string;
  time: string;
  seed: string;
  speed: string;
  /** Record values of more than 4 KiB, too. */
  all: boolean;
}

export interface RunnerState {
  run: string | null;
  state: RunState | "idle";
  kind: RunKind;
  why: string;
  outcome: Outcome | null;
  build: readonly string[];
  speed: number;
  problem: string;
  /** Behaviour by path of subsystem, as reported by the controller. */
  behaviours: ReadonlyMap<string, string>;
  /** How old commands are, as the run tells. */
  measured: readonly ChainOfRun[];
  /** The parameters of the run, with their values. */
  parameters: readonly ParameterShown[];
  panels: readonly PanelShown[];
  /** The points at which the run pauses. */
  breakpoints: readonly NamedBreakpoint[];
  /** The request with which this page started it; null: it was started elsewhere. */
  request: StartRequest | null;
  /** Whether it has a pane of the drawing; a run continues without one, too. */
  shown: boolean;
  /** The hash of its net; empty: not known yet. */
  netHash: string;
  /** The other runs of the server that go on. */
  others: readonly RunListed[];
}

export const goesOn = (state: RunnerState["state"]): boolean => state === "building" || state === "running" || state === "paused";

export const idle: RunnerState = {
  run: null,
  state: "idle",
  kind: "simulate",
  why: "",
  outcome: null,
  build: [],
  speed: 1,
  problem: "",
  behaviours: new Map(),
  measured: [],
  parameters: [],
  panels: [],
  breakpoints: [],
  request: null,
  shown: false,
  netHash: "",
  others: [],
};
