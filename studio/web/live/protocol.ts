import type { NetJson } from "../model/net";

/** The messages between server and page; docs/studio.md describes them. */

export interface Diagnostic {
  severity: "error" | "warning" | "hint" | "note";
  code: string;
  message: string;
  hint: string;
  line: number;
  column: number;
  end_line: number;
  end_column: number;
}
export interface Analysis {
  diagnostics: Diagnostic[];
  net: NetJson | null;
  /** Identifies the net: runs and recordings name the net to which they belong. */
  net_hash?: string | null;
}
export interface Project {
  name: string;
  folder: string;
  file: string;
  version: string;
  worlds: { name: string; tracks: string[] }[];
  simulation?: { world: string; track: { image: string; metres_per_pixel: number } | null } | null;
}
export interface SpecAnswer {
  text: string;
  revision: string;
  analysis: Analysis;
}
export interface Verdict {
  name: string;
  verdict: "holds" | "violated" | "unknown";
  asks?: string;
  method?: string;
  meaning?: string;
  explanation?: string;
  why?: string;
  warning?: boolean;
  states?: number;
  seconds?: number;
  trace?: { transition: string; line?: number }[] | null;
  steps?: number[] | null;
  waits?: string[];
  narrative?: string;
}
export interface VerifyResult {
  net_hash?: string;
  properties?: Verdict[];
  error?: string;
}
export type VerifyState = "running" | "done" | "stopped" | "failed";
export interface VerifyEvent {
  job: string;
  state: VerifyState;
  property?: string;
  states?: number;
  rate?: number;
  result?: VerifyResult;
  error?: string;
}
export type RunState = "building" | "running" | "paused" | "ended" | "failed";
/** The report of a controller at its end. */
export interface Outcome {
  simulated_s: number;
  wall_s: number;
  real_time_factor: number;
  firings: number;
  lost_events: number;
  warnings: string[];
  subsystems: { path: string; iterations: number; overruns: number; errors: number }[];
}
export interface RunInfo {
  run: string;
  kind?: RunRequest["kind"];
  /** The floor picture, if it differs from that of the specification. */
  track?: string | null;
  state: RunState;
  why?: string;
  outcome?: Outcome | null;
  marking?: number[];
  net_hash?: string;
  t?: number;
  /** All values; the events contain later changes. */
  values?: Record<string, unknown>;
  path?: PathRow[];
}
/** Nanoseconds of the run's clock; metres and radians in the floor picture. */
export type PathRow = [t: number, x: number, y: number, heading: number];
export type FiringRow = [time_ns: number, transition: number];
export interface FiringsEvent {
  run: string;
  t: number;
  dropped: number;
  firings: FiringRow[];
  /** Places that hold a token after the batch. */
  marking?: number[];
}
export interface ValuesEvent {
  run: string;
  t: number;
  /** The buffers that changed since the last event. */
  values: Record<string, unknown>;
}
/** Reports of a controller. They are the only source if its recording cannot be read from here. */
export interface SubsystemsEvent {
  run: string;
  t: number;
  subsystems: { path: string; behaviour: string; firings: number }[];
}
export interface PoseEvent {
  run: string;
  t: number;
  x: number;
  y: number;
  heading: number;
}
export interface RecordingInfo {
  name: string;
  bytes: number;
  modified: number | string;
  system?: string;
  duration?: number;
}
export interface Recording {
  net_hash?: string;
  subsystems?: string[];
  firings: FiringRow[];
  values?: Record<string, [number, unknown][]>;
  /** The end is missing: the controller was killed, or is still running. */
  cut?: boolean;
  /** Number of firings after this part. */
  dropped?: number;
  /** For all firings of the recording: times of the first and the last one, and their number. */
  first?: number | null;
  last?: number | null;
  total?: number;
  /**
   * Places that hold a token before the first firing, if that is not the first firing of the run.
   * null: they are not known.
   */
  marking?: number[] | null;
  path?: PathRow[];
  /** The floor picture, if it differs from that of the specification. */
  track?: string | null;
}
export interface RunRequest {
  kind: "simulate" | "run" | "attach";
  /** Socket of the controller, for a run that is attached to. */
  socket?: string;
  world?: string;
  track?: string;
  for?: string;
  seed?: number;
  speed?: number;
  paused?: boolean;
}
export interface ControlRequest {
  command: "pause" | "resume" | "stop" | "step_firing" | "step_iteration" | "speed" | "breakpoints";
  value?: number;
  subsystem?: string;
  breakpoints?: Breakpoint[];
}
/**
 * A run pauses when a token arrives in the place, the transition has fired, or its condition comes to hold.
 */
export type Breakpoint = { place: number } | { transition: number } | { condition: number };
