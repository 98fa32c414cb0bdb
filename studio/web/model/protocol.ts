// Made by scripts/protocol.mjs of share/tessera/studio.schema.json: change that, and run `npm run protocol`.
import type { FoldedNet } from "./net/net_json";

export type VerifyAnswer = VerifyRunning | VerifyEnd;
export type VerdictName = "holds" | "violated" | "unknown";
/** Keys of maps, and numbers of items of lists. */
export type EditPath = (string | number)[];
/** A scalar or a flow, or a list or map of values. */
export type EditValue = string | EditValue[] | { [k: string]: EditValue };
export type RunRequest = StartRequest | AttachRequest | DeploymentRequest;
export type RunState = "building" | "running" | "paused" | "ended" | "failed";
export type RunKind = "simulate" | "run" | "attach" | "deployment";
/** t, x, y, heading: nanoseconds of the run's clock; metres and radians in the floor picture. */
export type PathRow = [number, number, number, number];
/** A run pauses when a token comes to the place, the transition has fired, or its condition comes to hold. */
export type Breakpoint = { place: number } | { transition: number } | { condition: number };
/** Nanoseconds of the run's clock, and the transition. */
export type FiringRow = [number, number];
/** Nanoseconds of the run's clock, and the value. */
export type Sample = [number, unknown];
/** When an input got a value, when its sender wrote it (nanoseconds of the run's clock), and whether it is valid. */
export type Arrival = [number, number, boolean];
/** Nanoseconds of the run's clock, and a frame (tessera/poses.hpp), base64. */
export type PoseFrameRow = [number, string];
/** Nanoseconds of the run's clock, and what has changed since the row before. */
export type ArraysRow = [number, Arrays];
export type VerifyEvent = VerifyStarted | VerifyProgress | VerifyEnd;

/**
 * The messages between the server of `tessera studio` and its page (docs/reference/studio.md).
 * studio/web/scripts/protocol.mjs makes the types of the page from it; the tests of the server validate every
 * answer and event.
 */
export interface StudioProtocol {
  requests: Requests;
  events: Events;
}
/**
 * The requests of the page: by method and path, with JOB, RUN and NAME for one of them. A refusal (status 400
 * and above) is a Refusal.
 */
export interface Requests {
  "GET /api/project": { status: 200; answer: Project };
  "GET /api/spec": { status: 200; answer: SpecAnswer };
  /** 409: Conflict. */
  "PUT /api/spec": {
    body: {
      text: string;
      /** The revision of the text that was changed. */
      revision: string;
    };
    status: 200;
    answer: Saved;
  };
  /** Saves nothing. */
  "POST /api/check": { body: { text: string }; status: 200; answer: Analysis };
  /** About a text as it is typed; saves nothing. */
  "POST /api/language": { body: LanguageQuestion; status: 200; answer: LanguageAnswer };
  "POST /api/verify": {
    body: VerifyRequest;
    status: 202;
    answer: {
      /** Names the job. */
      job: string;
    };
  };
  "GET /api/verify/JOB": { status: 200; answer: VerifyAnswer };
  "DELETE /api/verify/JOB": { status: 200; answer: Nothing };
  "GET /api/controllers": {
    status: 200;
    /** Sockets on which a controller listens. */
    answer: string[];
  };
  /**
   * How old a command can be: the bounds of all chains, for the times of the text or others. 422: the text has
   * errors, or there is no such subsystem.
   */
  "POST /api/timing": {
    body: {
      text: string;
      what_if?: OtherTimes[];
      /** The name of the chain whose parts are told. */
      chain?: string;
    };
    status: 200;
    answer: Timing;
  };
  /**
   * The single changes of rates, modes and processors that make a time of a chain smaller. 422: there is no such
   * chain.
   */
  "POST /api/timing/changes": {
    body: {
      text: string;
      /** Its name. */
      chain: string;
    };
    status: 200;
    answer: {
      /** The one that helps most comes first. */
      changes: TimedChange[];
    };
  };
  /**
   * The run in which the age or the reaction of a chain comes nearest to its bound. 422: the text has errors, or
   * there is no such chain or subsystem.
   */
  "POST /api/timing/worst": {
    body: {
      text: string;
      /** Its name. */
      chain: string;
      of: "age" | "reaction";
      what_if?: OtherTimes[];
    };
    status: 200;
    answer: {
      run: WorstRun | null;
      /** There is no run, because of this. Empty: there is one. */
      why: string;
    };
  };
  /** The subsystems that cannot fire in a marking. */
  "POST /api/waits": { body: { text: string; marking: { place: number }[] }; status: 200; answer: { at_end: SubsystemAtEnd[] } };
  /** The C++ functions of the behaviours. */
  "POST /api/functions": { body: { text: string }; status: 200; answer: FunctionShown[] };
  /** Adds a function that is missing to its file. */
  "POST /api/functions/add": {
    body: { text: string; subsystem: string; function: string };
    status: 200;
    answer: { file: string };
  };
  /** Gives a function the name that its behaviour has now. */
  "POST /api/functions/rename": {
    body: { text: string; subsystem: string; from: string; function: string };
    status: 200;
    answer: { files: string[] };
  };
  /** The names that drivers in the simulated world of a text can use. */
  "POST /api/world": {
    body: { text: string };
    status: 200;
    answer: {
      /** By the kind of driver: "actuator": ["wheel_left"]. */
      targets: { [k: string]: string[] };
    };
  };
  "GET /api/sources": {
    query: {
      /** src/control.cpp */
      file: string;
    };
    status: 200;
    answer: { text: string; revision: string };
  };
  /** The text edits that an edit of the specification needs; writes nothing. 422: it cannot be done. */
  "POST /api/edit": { body: { text: string; edit: Edit | Edit[] }; status: 200; answer: EditAnswer };
  /** Writes all of the files or none. 409: one of them has another revision, or cannot be written. */
  "POST /api/files": {
    body: {
      files: {
        /** The specification, params.yaml, or C++ in src/ or test/. */
        file: string;
        text: string;
        /** The revision of the text that was changed. */
        revision: string;
      }[];
    };
    status: 200;
    answer: { files: { file: string; revision: string }[] };
  };
  /** 409: Conflict. */
  "PUT /api/sources": {
    body: {
      file: string;
      text: string;
      /** The revision of the text that was changed. */
      revision: string;
    };
    status: 200;
    answer: { revision: string };
  };
  "GET /api/layout": { status: 200; answer: LayoutAnswer };
  /** 409: Conflict. */
  "PUT /api/layout": {
    body: {
      boxes: BoxPositions;
      /** The revision of the file that was changed. */
      revision: string;
    };
    status: 200;
    answer: { revision: string };
  };
  "GET /api/arrangement": {
    status: 200;
    answer: {
      /** Texts that the page has kept for the user, by name. */
      entries: { [k: string]: string };
    };
  };
  "PUT /api/arrangement": {
    body: { name: string; text: string };
    status: 200;
    answer: {
      /** False: there is no folder for it, or no room. */
      kept: boolean;
    };
  };
  "GET /api/examples": { status: 200; answer: { name: string; title: string }[] };
  /** Copies an example into a project that has no specification yet. */
  "POST /api/begin": {
    body: { example: string };
    status: 200;
    answer: {
      files: string[];
      /** Files that were there already and stay as they are. */
      kept: string[];
    };
  };
  /** The user trusts the authors of the project's code: it may be compiled and run. */
  "POST /api/trust": {
    body: Nothing;
    status: 200;
    answer: {
      /** False: only until the server ends. */
      kept: boolean;
    };
  };
  "GET /api/driving": { status: 200; answer: Driving };
  /** Does as `tessera emergency-stop`: all controllers of this user in real time. */
  "POST /api/emergency_stop": { body: Nothing; status: 200; answer: CommandDone };
  /** Does as `tessera reset`. */
  "POST /api/emergency_reset": {
    body: {
      /** The name of one: of a deployed system, all processes are reset. */
      controller: string;
    };
    status: 200;
    answer: CommandDone;
  };
  /** 403: the project is not trusted. */
  "POST /api/runs": {
    body: RunRequest;
    status: 202;
    answer: {
      /** Names the run. */
      run: string;
    };
  };
  "GET /api/runs": { status: 200; answer: RunListed[] };
  "GET /api/runs/RUN": { status: 200; answer: RunInfo };
  "GET /api/runs/RUN/coverage": { status: 200; answer: Coverage };
  "GET /api/runs/RUN/operators": { status: 200; answer: Operators };
  "POST /api/runs/RUN/control": {
    body: ControlRequest;
    status: 200;
    /** Operators: to `panel`. */
    answer: Operators | Nothing;
  };
  "GET /api/recordings": {
    status: 200;
    /** The newest first. */
    answer: RecordingInfo[];
  };
  "GET /api/recordings/NAME": {
    query?: {
      /** Nanoseconds of the run's clock. */
      from?: string;
      /** Nanoseconds of the run's clock. */
      to?: string;
    };
    status: 200;
    answer: Recording;
  };
  "GET /api/recordings/NAME/coverage": { status: 200; answer: Coverage };
  "GET /api/recordings/NAME/poses": {
    query?: {
      /** Nanoseconds of the run's clock. */
      from?: string;
      /** Nanoseconds of the run's clock. */
      to?: string;
    };
    status: 200;
    answer: RecordedPoses;
  };
  "GET /api/recordings/NAME/arrays": {
    query: {
      /** Nanoseconds of the run's clock. */
      from?: string;
      /** Nanoseconds of the run's clock. */
      to?: string;
    };
    status: 200;
    answer: RecordedArrays;
  };
  /** 409: somebody else has changed the notes, or they are not the studio's; the answer has `notes` as they are. */
  "PUT /api/recordings/NAME/notes": { body: NotesRequest; status: 200; answer: { notes: Notes | null } };
  "POST /api/sweeps": {
    body: SweepRequest;
    status: 202;
    answer: {
      /** Names the sweep. */
      sweep: string;
    };
  };
  "GET /api/sweeps": {
    status: 200;
    answer: {
      /** Those of the file on disk. */
      parameters: ParameterShown[];
      /** Runs at a time. */
      processes: number;
      sweeps: SweepListed[];
    };
  };
  "GET /api/sweeps/JOB": { status: 200; answer: SweepEvent };
  "DELETE /api/sweeps/JOB": { status: 200; answer: Nothing };
  "GET /api/views": { status: 200; answer: Views };
  "GET /api/scenes/HASH.glb": {
    status: 200;
    /** The scene of a simulated world: a glTF file. */
    answer: string;
  };
  "GET /api/tracks/NAME": {
    status: 200;
    /** The PNG of a floor. */
    answer: string;
  };
  "GET /api/events": {
    query: { token: string };
    status: 200;
    /** Server-sent events: Events. */
    answer: string;
  };
}
export interface Project {
  /** The system; the folder's name while the text has errors. */
  name: string;
  folder: string;
  file: string;
  version: string;
  /** Another one after each start of the server. */
  server_start: string;
  examples_hint: string;
  /** Whether its code may be compiled and run. */
  trusted: boolean;
  worlds: { name: string; tracks: string[] }[];
  /** The processes of `deploy:`; empty: all agents run in one. */
  processes: string[];
  /** Null: the specification names no world. */
  simulation: { world: string; track: { image: string; metres_per_pixel: number } | null } | null;
}
export interface SpecAnswer {
  text: string;
  revision: string;
  /** Why the file cannot be read. */
  error: string | null;
  analysis: Analysis;
}
export interface Analysis {
  diagnostics: Diagnostic[];
  /** Names the net: runs and recordings say which they are of. */
  net_hash: string | null;
  net: FoldedNet | null;
}
export interface Diagnostic {
  severity: "error" | "warning" | "hint";
  code: string;
  message: string;
  hint: string;
  /** From 1. */
  line: number;
  /** In UTF-16 units, from 1. */
  column: number;
  end_line: number;
  end_column: number;
}
export interface Saved {
  revision: string;
  analysis: Analysis;
}
export interface LanguageQuestion {
  text: string;
  line: number;
  character: number;
  ask: "completion" | "meaning" | "definition";
}
/** Parts that were not requested are empty or null. */
export interface LanguageAnswer {
  proposals: Proposal[];
  meaning: Meaning | null;
  definition: TextPosition | null;
}
/** The possible texts at the cursor. */
export interface Proposal {
  kind: "key" | "word" | "type" | "name" | "example";
  label: string;
  detail: string;
  documentation: string;
  insert: string;
  from: TextPosition;
  to: TextPosition;
}
/** From 0; characters in UTF-16 units. */
export interface TextPosition {
  line: number;
  character: number;
}
/** The meaning of the word at the cursor, in Markdown. */
export interface Meaning {
  text: string;
  from: TextPosition;
  to: TextPosition;
}
export interface VerifyRequest {
  text: string;
  /** Absent: all. */
  properties?: string[];
  /** 60s, 500ms or 2min; absent: 60s. */
  timeout?: string;
}
export interface VerifyRunning {
  /** Names the job. */
  job: string;
  state: "running";
  result: null;
}
export interface VerifyEnd {
  /** Names the job. */
  job: string;
  state: "done" | "stopped";
  result: VerifyReport | VerifyProblem;
}
/** The output of `tessera verify --json`, with `steps` and `narrative`. */
export interface VerifyReport {
  net_hash: string;
  verification_hash: string;
  properties: Verdict[];
}
export interface Verdict {
  name: string;
  asks: string;
  verdict: VerdictName;
  method: string;
  why: string;
  meaning: string;
  explanation: string;
  seconds: number;
  /** Markings that were visited. */
  states: number;
  warning: boolean;
  /** The waits at the end of the run. */
  waits: string[];
  behaviours: {
    path: string;
    line: number;
    /** A line of an included file, such as parts/docking.yaml:3; line is 0 then. */
    included?: string;
  }[];
  /** The run that shows the verdict. */
  trace: TracedFiring[] | null;
  /** Violated: what would help. */
  hint?: string;
  /** The part that is not shown because a limit of time was reached. */
  cut_off?: string;
  /** The same as waits, as data. */
  at_end: SubsystemAtEnd[];
  /** Transitions of the run; one beyond the net's says that no initial condition holds. */
  steps: number[] | null;
  /** The run in plain words; empty: the property is violated from the start. */
  narrative: null | Act[];
}
export interface TracedFiring {
  transition: string;
  takes: string[];
  gives: string[];
  subsystem?: string;
  page?: string;
  line?: number;
  /** A line of an included file, such as parts/docking.yaml:3; line is 0 then. */
  included?: string;
}
/** The state of a subsystem where a run has stopped or no longer goes on as it should. */
export interface SubsystemAtEnd {
  path: string;
  state: "waits" | "no_successor" | "ended" | "gives_no_more" | "takes_no_more";
  /** The token that it waits for, or no longer gives. */
  awaited: "nothing" | "value" | "acknowledgement" | "memory";
  /** no_successor: the one that was left. */
  behaviour: string;
  /** FROM->TO; empty: none. */
  channel: string;
  /** waits: the subsystems that could give it. */
  from: string[];
  /** All of it in words. */
  text: string;
}
/** A stretch of a run in which one subsystem acts on its own. */
export interface Act {
  /** The number of a firing of the run, counted from 1. */
  first: number;
  last: number;
  /** The path of the subsystem; empty: the system and its agents. */
  who: string;
  text: string;
  line: number;
  /** A line of an included file, such as parts/docking.yaml:3; line is 0 then. */
  included?: string;
}
/** The verification itself failed. */
export interface VerifyProblem {
  error: string;
}
export interface Nothing {}
/** Other times of a subsystem than the text says, for all that share its description. */
export interface OtherTimes {
  /** robot.control */
  path: string;
  /** 0: no rate. */
  period_ns?: number;
  shortest_ns?: number;
  longest_ns?: number;
}
export interface Timing {
  chains: TimedChain[];
  subsystems: TimedSubsystem[];
  /** The parts of the times of the chain that was named; null: none was, or it has no bound. */
  steps: { age: TimedStep[]; reaction: TimedStep[] } | null;
}
/** A chain of subsystems from a device to another one. */
export interface TimedChain {
  /** As the specification names it, or robot.sensor -> robot.control -> robot.motor. */
  name: string;
  /** The specification names it. */
  named: boolean;
  /** Its subsystems in order. */
  path: string[];
  /** FROM->TO, those of all its ways. */
  channels: string[];
  /** So many members of a fleet have this verdict; the names are those of the first one. */
  agents: number;
  age: TimedBound;
  reaction: TimedBound;
  /** Some run reaches both bounds. */
  exact: boolean;
  /** Why there is no bound; empty: there is one. */
  why: string;
}
export interface TimedBound {
  /** Null: there is no bound. */
  at_most_ns: number | null;
  /** Null: nothing is asked. */
  asked_ns: number | null;
  /** unknown: more is proved than is asked, but no run is known that takes longer. none: there is no bound. */
  answer: "not_asked" | "holds" | "violated" | "unknown" | "none";
}
/** A subsystem of some chain, with the times that the bounds are for. */
export interface TimedSubsystem {
  path: string;
  /** 0: no rate. */
  period_ns: number;
  /** The shortest time of a call. Null: nothing bounds it. */
  shortest_ns: number | null;
  longest_ns: number | null;
  /** Some receive of it waits for a value. */
  waits: boolean;
  /** Why nothing bounds its calls; empty: they are bounded. */
  missing: string;
}
/** A part of an age or a reaction. The parts follow one another, and add up to the bound. */
export interface TimedStep {
  /**
   * next_reading: an event comes just after a reading. until_read: the value stands in the channel. until_begin:
   * until the next iteration begins. latency: the thread goes on later than it may. processor: others go first on
   * it. takes: the transition function. until_sent: other sends come first.
   */
  kind: "next_reading" | "until_read" | "until_begin" | "latency" | "processor" | "takes" | "until_sent";
  subsystem: string;
  /** until_read: FROM->TO; else null. */
  channel: string | null;
  ns: number;
}
/** A change of the specification, and the bounds of the chain with it. Other chains may get worse. */
export interface TimedChange {
  /** event_driven: no rate, and a receive over the channel that waits. */
  kind:
    | "twice_the_rate"
    | "event_driven"
    | "receive_blocking"
    | "receive_non_blocking"
    | "send_blocking"
    | "send_non_blocking"
    | "own_processor";
  subsystem: string;
  /** FROM->TO; null: it changes none. */
  channel: string | null;
  /** Null: no bound. */
  age_ns: number | null;
  reaction_ns: number | null;
}
/**
 * A run from the start of the system, in which a command is as old as it can be, or nearly. Times are those of
 * the run.
 */
export interface WorstRun {
  /** The reading of the device; for a reaction, an event just after it. */
  from_ns: number;
  /** The end of the command. */
  to_ns: number;
  /** The bound. */
  at_most_ns: number;
  /** The run takes as long as the bound, which is then exact. */
  reaches: boolean;
  /** The calls between the two times, of all subsystems that matter, by their begin. */
  calls: {
    subsystem: string;
    /** Empty: the subsystem has several. */
    behaviour: string;
    begin_ns: number;
    end_ns: number;
  }[];
  /** The way of the value that the command is based on, channel by channel. */
  hops: {
    /** FROM->TO */
    channel: string;
    /** The subsystem that writes. */
    from: string;
    /** The subsystem that reads. */
    to: string;
    written_ns: number;
    /** For the last time before it is used. */
    read_ns: number;
  }[];
}
export interface FunctionShown {
  /** The path of an agent or a template: "walker.control". */
  subsystem: string;
  function: string;
  /** unclear: only the linker can tell. */
  state: "defined" | "unclear" | "missing";
  /** The existing or proposed file: src/control.cpp */
  file: string;
  line: number | null;
  /** The function to begin with. */
  stub: string;
  /** Functions of the same namespace that no behaviour has. */
  leftovers: string[];
}
/** Does something with one part of a specification (src/language/edits/edits.hpp). */
export interface Edit {
  do:
    | "set"
    | "insert"
    | "append"
    | "replace"
    | "remove"
    | "rename"
    | "connect"
    | "channel"
    | "next"
    | "make_template"
    | "move"
    | "copy"
    | "paste";
  at?: EditPath;
  key?: string;
  text?: string;
  as?: "scalar" | "list" | "quoted" | "as_is";
  value?: EditValue;
  fields?: { [k: string]: string };
}
export interface EditAnswer {
  edits: PlacedText[];
  files: FileRenamed[];
}
export interface PlacedText {
  from: TextPosition;
  to: TextPosition;
  text: string;
}
/** The change of a file by a rename, and the lines where only a compiler can tell whether it is the same name. */
export interface FileRenamed {
  file: string;
  lines: number[];
  unsure: number[];
  before: string;
  after: string;
  /** The revision of the text before. */
  revision: string;
}
export interface LayoutAnswer {
  boxes: BoxPositions;
  /** Empty: the file cannot be read. */
  revision: string;
  /** Why the file is not understood; null: it is, or there is none. */
  error: string | null;
}
/** The boxes that a user has moved, by path: the upper left corner, of a subsystem from that of its agent. */
export interface BoxPositions {
  [k: string]: [number, number];
}
/**
 * The controllers that drive devices now: those of this user in real time, on real devices or in a simulated
 * world.
 */
export interface Driving {
  controllers: {
    name: string;
    system: string;
    /** Its number; -1: not known. */
    process: number;
    /** One of several processes of its system. */
    deployed: boolean;
    /** False: it hangs, or is stopped. */
    answers: boolean;
    /** The reason of its emergency stop; null: it has none. */
    emergency: string | null;
  }[];
}
/** The result of a command of the command line. */
export interface CommandDone {
  /** Whether all that were meant have obeyed. */
  done: boolean;
  /** The lines that it prints. */
  lines: string[];
}
export interface StartRequest {
  kind: "simulate" | "run";
  world?: string;
  track?: string;
  /** A duration: 60s. */
  for?: string;
  seed?: number;
  /** Simulated seconds a second; 0: as fast as possible. */
  speed?: number;
  paused?: boolean;
  /** For simulate: as fast as possible up to this second of the run; `speed` and `paused` apply from then on. */
  skip_to?: number;
  /** The recorded values; all: also values of more than 4 KiB, such as pictures. */
  values?: "small" | "all";
}
export interface AttachRequest {
  kind: "attach";
  /** The socket of the controller to watch: one of `/api/controllers`. */
  socket: string;
}
/** Watches all processes of the deployed system that run on this machine. */
export interface DeploymentRequest {
  kind: "deployment";
}
export interface RunListed {
  /** Names the run. */
  run: string;
  state: RunState;
  kind: RunKind;
  /** Why it is in this state; may be empty. */
  why: string;
  net_hash: string;
  /** Nanoseconds of the run's clock. */
  t: number;
}
export interface RunInfo {
  /** Names the run. */
  run: string;
  state: RunState;
  kind: RunKind;
  /** Why it is in this state; may be empty. */
  why: string;
  net_hash: string;
  /** Nanoseconds of the run's clock. */
  t: number;
  /** Places that hold a token. */
  marking: number[];
  /** The number of all firings so far. */
  firings: number;
  values: Values;
  parameters: ParameterShown[];
  notices: Notices;
  panels: PanelShown[];
  pose: Pose | null;
  /** Null: nothing is simulated, or the run has not begun. */
  scene: SceneShown | null;
  /** A whole frame; null: none yet. */
  poses: PoseFrame | null;
  /** At most 5000 rows. */
  path: PathRow[];
  subsystems: SubsystemsSeen | null;
  /** Null unless all processes of a deployed system are watched. */
  deployment: DeploymentSeen | null;
  /** By property; null: the controller was made elsewhere, or it is not made yet. */
  verdicts: { [k: string]: VerdictName } | null;
  outcome: Outcome | null;
  /** The floor picture that the run was started with; null: that of the specification. */
  track: string | null;
}
/** Values of buffers, and of fields of memory, by path. */
export interface Values {
  /** A number, bool, text, list or object; null: its device gives none any more. */
  [k: string]: unknown;
}
export interface ParameterShown {
  /** `v`: of the system. `robot.control.gain`: of a subsystem. */
  path: string;
  /** As recordings describe it: `float64`. */
  type: string;
  /** Empty: it has none. */
  unit: string;
  minimum: number | null;
  maximum: number | null;
  /** The value of the specification. */
  initial: string;
  /** Null: not known, since the beginning of the recording is gone. */
  value: string | null;
  /** Not every subsystem holds the same value. */
  differs: boolean;
}
/** In the order of time. */
export interface Notices {
  notices: Notice[];
  /** Older ones that are left out: there were too many of their kind. */
  dropped: number;
}
/** Something that the recording of a run says in words. */
export interface Notice {
  /** Nanoseconds of the run's clock. */
  t: number;
  /** safe: of the safe command of a device. parameter: a subsystem has taken a value. end: why the run ended. */
  kind: "message" | "fault" | "overrun" | "safe" | "parameter" | "end";
  /** The path of the subsystem; empty: the system. */
  who: string;
  text: string;
  level: "info" | "warning" | "error";
}
/** Controls that an operator moves, behind a real buffer of the controller. */
export interface PanelShown {
  /** The path of the real buffer: `robot.console.drive`. */
  path: string;
  /** An input counts for so long. */
  stale_s: number;
  controls: PanelControl[];
}
export interface PanelControl {
  /** `value` if the buffer is no structure. */
  field: string;
  control: "button" | "switch" | "slider" | "stick_x" | "stick_y";
  /** Empty: it has none. */
  unit: string;
  /** Null: it is a bool. */
  minimum: number | null;
  /** Null: it is a bool. */
  maximum: number | null;
  /** It takes whole numbers only. */
  whole: boolean;
}
/** Metres and radians in the floor picture. */
export interface Pose {
  /** Nanoseconds of the run's clock. */
  t: number;
  x: number;
  y: number;
  heading: number;
}
/** The bodies that move in a simulated world, and the file of the world: GET /api/scenes/HASH.glb. */
export interface SceneShown {
  hash: string;
  /** Name, and agent that owns it; empty: none, or unknown. */
  bodies: [string, string][];
}
export interface PoseFrame {
  /** Nanoseconds of the run's clock. */
  t: number;
  /** As tessera/poses.hpp describes, base64. */
  frame: string;
}
export interface SubsystemsSeen {
  /** Nanoseconds of the run's clock. */
  t: number;
  subsystems: Subsystem[];
  channels: Channel[];
}
/** The present state of a subsystem, and its counts so far. */
export interface Subsystem {
  path: string;
  /** The one that runs, or ran last; null: no transition function was called yet. */
  behaviour: string | null;
  /** A transition function is being executed. */
  calling: boolean;
  ended: boolean;
  iterations: number;
  firings: number;
  overruns: number;
  errors: number;
  /** 0: it has none. */
  period_s: number;
  /** When the last transition function was called; negative: not yet. */
  called_at_s: number;
  /** Duration of the last call. */
  call_s: number;
  longest_call_s: number;
  /**
   * The fields of its memory as they were at the end of the last iteration. Absent: it has none. The studio leaves
   * it out, since its `values` have it.
   */
  memory?: MemoryField[];
}
export interface MemoryField {
  name: string;
  /** As `tessera replay --values` prints it. */
  value: string;
}
export interface Channel {
  name: string;
  /** Its places that hold a token; none: one side writes or reads its memory. */
  marked: string[];
  /** Since when a value is on the way to another process without an answer; absent: none is. */
  sending_since_s?: number;
}
export interface DeploymentSeen {
  /** Nanoseconds of the run's clock. */
  t: number;
  /** Other machines are watched, too. */
  network: boolean;
  /** Why the network is not heard, or what was dropped there; empty: nothing. */
  remark: string;
  processes: ProcessSeen[];
  links: LinkSeen[];
  waits: WaitingChain[];
}
export interface ProcessSeen {
  name: string;
  agents: string[];
  /**
   * silent: it sends nothing any more; gone: it has died; absent: it was not found on this machine, and not heard
   * on the network.
   */
  state: "running" | "silent" | "ended" | "gone" | "absent";
  /** It has been in this state for so long. */
  since_s: number | null;
  /** Its machine; empty: not known. */
  host: string;
  pid: number | null;
  /** By its own clock. */
  time_s: number | null;
  /** Why an emergency stop stands. */
  emergency: string | null;
  overruns: number;
  errors: number;
  /** Its recording is read, so its tokens are shown. */
  followed: boolean;
  /** It tells this over the network, where nobody is authenticated. */
  by_network: boolean;
  /** So many of its subsystems, waits and links had no room in its message. */
  left_out: number;
  subsystems: {
    path: string;
    /** Null: none yet. */
    behaviour: string | null;
    ended: boolean;
  }[];
}
/** The knowledge that `process` has of `peer` (control_socket.schema.json); times are ages in seconds. */
export interface LinkSeen {
  process: string;
  peer: string;
  reachable: boolean;
  /** It has been so for so long. */
  for_s: number;
  /** Age of the newest sign; null: none yet. */
  heard_s: number | null;
  signs: number;
  signs_lost: number;
  sent: number;
  repeated: number;
  received: number;
  duplicates: number;
  /** Null: not known yet. */
  clock_ahead_s: number | null;
  clock_uncertainty_s: number;
}
export interface WaitingChain {
  steps: { subsystem: string; process: string; waits_for: string; other_process: string; channel: string; text: string }[];
  /** Why the last one that is waited for does not act; may be empty. */
  end: string;
}
/** The result of a controller at its end: its summary.json. */
export interface Outcome {
  simulated_s: number;
  wall_s: number;
  real_time_factor: number;
  firings: number;
  /** Why. */
  ended: string;
  failed: boolean;
  signal: number;
  recording: string;
  /** Missing from the recording. */
  lost_events: number;
  lines_not_printed: number;
  warnings: string[];
  /** The recording begins there: its limit has dropped what was before. Absent: it has its beginning. */
  recorded_from_s?: number;
  /** The faults of `--inject`; absent: there are none. */
  injected?: { fault: string; happened: boolean }[];
  world_s?: number;
  track?: string;
  /** Those of the simulated world. */
  checks?: CheckOutcome[];
  /** By name; null: never taken. */
  measures?: { [k: string]: MeasureOutcome | null };
  subsystems: { path: string; iterations: number; overruns: number; errors: number }[];
}
export interface CheckOutcome {
  name: string;
  /** The demand of the check. */
  text: string;
  verdict: "held" | "failed" | "open";
  /** When it failed first, or when it came. */
  time_s?: number;
  /** The facts. */
  detail?: string;
}
export interface MeasureOutcome {
  least: number;
  least_at_s: number;
  greatest: number;
  greatest_at_s: number;
  mean: number;
  last: number;
  /** `m/s`. Missing: it has none, or it is not known. */
  unit?: string;
}
/** The part of the net that a run has reached, as counted by `tessera simulate --coverage`. */
export interface Coverage {
  behaviours: Share;
  places: Share;
  transitions: Share;
  conditions: Share;
  /** Places and transitions that no run can reach. They are left out. */
  unreachable: number;
  /** Events are missing, so parts listed as not reached may have been reached. */
  lacks_events: boolean;
  /** The parts that were not reached: behaviours by path, places and transitions by index. */
  missing: {
    behaviours: string[];
    places: number[];
    transitions: number[];
    /** Transitions whose condition never held. */
    never_held: number[];
    /** Transitions whose condition always held. */
    never_false: number[];
  };
}
export interface Share {
  reached: number;
  all: number;
}
/** Those whose inputs pass through this server. */
export interface Operators {
  /** The time of the answer, in seconds of a clock of the server. */
  stamp: number;
  /** The network held the inputs back for too long: they are not used. */
  late?: true;
  operators: {
    /** The panel. */
    path: string;
    /** As its page names it. */
    operator: string;
  }[];
}
export interface ControlRequest {
  command: "pause" | "resume" | "stop" | "step_firing" | "step_iteration" | "speed" | "set" | "panel" | "breakpoints";
  /** For `speed`. */
  value?: number;
  /** For `step_iteration`: its path; absent: any. */
  subsystem?: string;
  /** For `set`: a parameter, as `tessera set` names it. For `panel`: a real buffer. */
  path?: string;
  /** For `set`: its new value, in the unit of the parameter. */
  text?: string;
  /** For `panel`: tells operators apart. */
  operator?: string;
  /** For `panel`: values by field; missing fields are neutral. Absent: the operator lets go of the panel. */
  inputs?: { [k: string]: number | boolean };
  /** For `panel`: the newest stamp that the page has seen; absent: none. */
  after?: number;
  /** For `panel`: inputs that arrive more seconds after this stamp are not used. */
  within?: number;
  /** Instead of those before. */
  breakpoints?: Breakpoint[];
}
export interface RecordingInfo {
  name: string;
  bytes: number;
  /** Milliseconds since 1970. */
  modified: number;
  system: string;
  net_hash: string;
  clock: string;
  /** Seconds. */
  duration: number;
  /** Null: there are none. */
  notes: Notes | null;
}
/** The name and the notes that a user has given to a recording. */
export interface Notes {
  /** Empty: the recording has no name of its own. */
  title: string;
  text: string;
  marks: Mark[];
  revision: string;
  /** Why the file cannot be read; then it is not replaced. Empty: it was read. */
  problem: string;
}
export interface Mark {
  /** Nanoseconds of the run's clock. */
  t: number;
  text: string;
}
export interface Recording {
  net_hash: string;
  system: string;
  subsystems: string[];
  /** Places that hold a token before the first firing; null: those of the net; none: unknown. */
  marking: number[] | null;
  firings: FiringRow[];
  /** Firings that are not in this part, but after it. */
  dropped: number;
  /** By path of the scalar. */
  values: { [k: string]: Sample[] };
  arrivals: Arrivals;
  path: PathRow[];
  notices: Notices;
  /** The floor picture; null: none, or unknown. */
  track: string | null;
  /** Null: it was recorded without poses. */
  scene: SceneShown | null;
  /** Its limit (--record-limit) has dropped what was before `first`. */
  lacks_beginning: boolean;
  /** Its end is missing: the controller was killed, or still runs. */
  cut: boolean;
  /** Something of it is not in this answer. */
  truncated: boolean;
  /** Time of the first firing of the whole recording. */
  first: number | null;
  last: number | null;
  /** Firings of the whole recording. */
  total: number;
}
/** The new values that came through channels, by path of the input. */
export interface Arrivals {
  [k: string]: Arrival[];
}
export interface RecordedPoses {
  /** The first is whole. */
  frames: PoseFrameRow[];
  /** All frames up to this time are there. */
  until: number;
}
export interface RecordedArrays {
  arrays: ArraysRow[];
  /** All rows up to this time are there. */
  until: number;
}
/** By path of a real receptor's buffer: its numbers as in a recording, base64; null: not recorded, or too large. */
export interface Arrays {
  [k: string]: string | null;
}
export interface NotesRequest {
  /** One line of up to 200 bytes. */
  title: string;
  /** Up to 10,000 bytes. */
  text: string;
  /** Up to 500, each of up to 500 bytes. */
  marks: Mark[];
  /** That of the notes that are replaced; empty: there are none. */
  revision: string;
}
/** Many simulated runs: each value of a parameter with each seed. */
export interface SweepRequest {
  /** Its path; `robot[*].control.v` is that of all members of a fleet. Absent: only the seeds differ. */
  parameter?: string;
  /** Values of the parameter, with their units: "0.3 m/s". */
  values?: string[];
  /** For each value, with the next seeds; 1 if it is absent. */
  runs?: number;
  /** The first one; 1 if it is absent. */
  seed?: number;
  /** The length of a run; 10s if it is absent. */
  for?: string;
  /** The seed decides the order of the subsystems, too, as in `tessera schedules`. */
  interleave?: boolean;
}
export interface SweepListed {
  /** Names the sweep. */
  sweep: string;
  state: "building" | "running" | "done" | "stopped" | "failed";
  /** Why it failed. */
  why: string;
  /** The progress of the build. */
  line: string;
  /** Empty: only the seeds differ. */
  parameter: string;
  values: string[];
  /** For each value. */
  runs: number;
  seed: number;
  for: string;
  interleave: boolean;
  /** Runs that have ended. */
  done: number;
  of: number;
  /** Results of an earlier sweep. */
  reused: number;
}
/** A sweep, and rows of its results from number `from` on. */
export interface SweepEvent {
  /** Names the sweep. */
  sweep: string;
  state: "building" | "running" | "done" | "stopped" | "failed";
  /** Why it failed. */
  why: string;
  /** The progress of the build. */
  line: string;
  /** Empty: only the seeds differ. */
  parameter: string;
  values: string[];
  /** For each value. */
  runs: number;
  seed: number;
  for: string;
  interleave: boolean;
  /** Runs that have ended. */
  done: number;
  of: number;
  /** Results of an earlier sweep. */
  reused: number;
  from: number;
  rows: SweepRow[];
}
/** The result of one run. */
export interface SweepRow {
  /** Value of the parameter; empty: there is none. */
  value: string;
  seed: number;
  failed: boolean;
  /** Why it ended; what has failed. */
  ended: string;
  /** By measure; null: it was never taken. */
  numbers: { [k: string]: number | null };
  /** Units of the measures that have one. */
  units: { [k: string]: string };
}
export interface Views {
  views: WorldView[];
}
/** A device of the simulated world whose values can be looked at. */
export interface WorldView {
  /** The path of the real buffer. */
  path: string;
  /** The type of the buffer: float64[32]. */
  type: string;
  kind: "scan" | "camera" | "depth" | "labels";
  /** That carries a scan; empty: it does not move. */
  body?: string;
  /** On that body, in m. */
  position?: number[];
  /** w, x, y, z: x ahead, turned about z. */
  quaternion?: number[];
  /** The first ray, in rad. */
  from?: number;
  to?: number;
  /** In m. */
  reach?: number;
  /** For a picture. */
  width?: number;
  height?: number;
}
/** The events of the server, by name. */
export interface Events {
  hello: Hello;
  spec: SpecEvent;
  layout: LayoutEvent;
  verify: VerifyEvent;
  build: LineEvent;
  log: LineEvent;
  run: RunEvent;
  firings: FiringsEvent;
  subsystems: SubsystemsEvent;
  deployment: DeploymentEvent;
  values: ValuesEvent;
  parameters: ParametersEvent;
  notices: NoticesEvent;
  arrays: ArraysEvent;
  pose: PoseEvent;
  scene: SceneEvent;
  poses: PosesEvent;
  sweep: SweepEvent;
  driving: Driving;
}
export interface Hello {
  /** Another one: the server was restarted. */
  server_start: string;
  /**
   * The revision of the file now. If `GET /api/spec` gave another one, the file has changed since then. Empty: it
   * cannot be read.
   */
  revision: string;
}
/** The file changed on disk, or, with the same revision, a file that it includes. */
export interface SpecEvent {
  revision: string;
}
/** The file with the positions of boxes changed on disk. */
export interface LayoutEvent {
  revision: string;
}
export interface VerifyStarted {
  /** Names the job. */
  job: string;
  state: "running";
}
export interface VerifyProgress {
  /** Names the job. */
  job: string;
  state: "running";
  property: string;
  /** Markings visited so far. */
  states: number;
  /** Markings a second. */
  rate: number;
}
/** Output of the build, or of the controller. */
export interface LineEvent {
  /** Names the run. */
  run: string;
  line: string;
}
export interface RunEvent {
  /** Names the run. */
  run: string;
  state: RunState;
  why: string;
  outcome: Outcome | null;
  /** Places that hold a token. */
  marking: number[];
  /** Firings of the run so far: those that led to the marking. */
  firings: number;
}
export interface FiringsEvent {
  /** Names the run. */
  run: string;
  /** Nanoseconds of the run's clock. */
  t: number;
  /** The number of firings before the listed ones. */
  dropped: number;
  /** All firings of the run so far, those of this event included. */
  total: number;
  firings: FiringRow[];
  /** Places that hold a token after the batch. */
  marking?: number[];
}
/** The report of a controller about itself. */
export interface SubsystemsEvent {
  /** Names the run. */
  run: string;
  /** Nanoseconds of the run's clock. */
  t: number;
  subsystems: Subsystem[];
  channels: Channel[];
}
/** The state of all processes of a deployed system, and their knowledge of each other. */
export interface DeploymentEvent {
  /** Names the run. */
  run: string;
  /** Nanoseconds of the run's clock. */
  t: number;
  /** Other machines are watched, too. */
  network: boolean;
  /** Why the network is not heard, or what was dropped there; empty: nothing. */
  remark: string;
  processes: ProcessSeen[];
  links: LinkSeen[];
  /** The chains of waits that have lasted for a second or more, the longest first. */
  waits: WaitingChain[];
}
/** Values of the buffers that changed since the last such event. */
export interface ValuesEvent {
  /** Names the run. */
  run: string;
  /** Nanoseconds of the run's clock. */
  t: number;
  values: Values;
  arrivals?: Arrivals;
  /** Arrivals that are not listed, because there were too many. */
  arrivals_dropped?: number;
}
/** All parameters: when the run begins, and when one has taken a value. */
export interface ParametersEvent {
  /** Names the run. */
  run: string;
  /** Nanoseconds of the run's clock. */
  t: number;
  parameters: ParameterShown[];
}
/** The notices since the last such event. */
export interface NoticesEvent {
  /** Names the run. */
  run: string;
  notices: Notice[];
  /** Older ones that are left out: there were too many of their kind. */
  dropped: number;
}
export interface ArraysEvent {
  /** Names the run. */
  run: string;
  /** Nanoseconds of the run's clock. */
  t: number;
  arrays: Arrays;
}
export interface PoseEvent {
  /** Names the run. */
  run: string;
  /** Nanoseconds of the run's clock. */
  t: number;
  x: number;
  y: number;
  heading: number;
}
export interface SceneEvent {
  /** Names the run. */
  run: string;
  hash: string;
  /** As in SceneShown. */
  bodies: [string, string][];
}
export interface PosesEvent {
  /** Names the run. */
  run: string;
  /** Nanoseconds of the run's clock. */
  t: number;
  /** As tessera/poses.hpp describes, base64. */
  frame: string;
}
/** The answer of any request that is refused: status 400 and above. */
export interface Refusal {
  error: string;
  /** A proposed remedy; may be empty. */
  hint: string;
}
/** 409 of `PUT /api/spec`, `PUT /api/sources` and `PUT /api/layout`: another program has changed the file. */
export interface Conflict {
  /** The file on disk. */
  text: string;
  revision: string;
  error: string;
  hint: string;
}
/** 409 of `PUT /api/recordings/NAME/notes`: somebody else has changed the notes, or they cannot be read. */
export interface NotesConflict {
  error: string;
  hint: string;
  /** As they are on disk. */
  notes: Notes | null;
}
