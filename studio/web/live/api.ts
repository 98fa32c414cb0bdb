import type { Positions } from "../model/structure/moved_boxes";
import type {
  BoxPositions,
  ControlRequest,
  Edit,
  LanguageQuestion,
  NotesRequest,
  Operators,
  OtherTimes,
  Requests,
  RunRequest,
  SweepRequest,
} from "../model/protocol";
import type { WorstQuestion } from "./times/worst";

/** The picture of a floor; its lower left corner is the origin. */
export interface Floor {
  image: ImageBitmap;
  metresPerPixel: number;
}

/** An error answer of the server; status 0: there was no answer. */
export class ApiError extends Error {
  constructor(
    readonly status: number,
    message: string,
    readonly hint = "",
    readonly body: Record<string, unknown> = {},
  ) {
    super(message);
  }
}

/** An error in words, with the hint of the server. */
export function message(error: unknown): string {
  if (error instanceof ApiError) return error.hint ? `${error.message} ${error.hint}` : error.message;
  return error instanceof Error ? error.message : String(error);
}

const key = "tessera.token";

/**
 * The token from the address (`#token=...`) or from this browser tab. It is removed
 * from the address bar at once.
 */
export function takeToken(): string {
  const given = /(?:^#|&)token=([0-9a-f]+)/i.exec(location.hash)?.[1];
  if (given) {
    sessionStorage.setItem(key, given);
    history.replaceState(null, "", location.pathname + location.search);
  }
  return sessionStorage.getItem(key) ?? "";
}

/** Whether an address was opened that has a key. */
export const hasToken = (hash: string) => hash.includes("token=");

/** If another tab is opened with the key of a restarted server, this tab uses the key, too. */
export function shareToken(token: string, taken: (token: string) => void): void {
  const tabs = new BroadcastChannel(key);
  tabs.onmessage = (event: MessageEvent<string>) => {
    if (event.data === sessionStorage.getItem(key)) return;
    sessionStorage.setItem(key, event.data);
    taken(event.data);
  };
  tabs.postMessage(token);
}

type Body<Name extends keyof Requests> = Requests[Name] extends { body: infer Given } ? Given : undefined;
interface Details<Name extends keyof Requests> {
  /** The values of JOB, RUN or NAME in the address. */
  of?: string;
  query?: Requests[Name] extends { query?: infer Given } ? Given : undefined;
  body?: Body<Name>;
  /** The request goes on when the page is closed. */
  keepalive?: boolean;
  /** Gives the request up. */
  signal?: AbortSignal;
}

/** The address of a request: "/api/runs/7/control" for "POST /api/runs/RUN/control". */
function addressOf(name: string, of: string, query: object): string {
  const path = name.replace(/^[A-Z]+ /, "").replace(/(?<=\/)[A-Z]+(?=\/|\.|$)/, encodeURIComponent(of));
  const asked = new URLSearchParams(Object.entries(query)).toString();
  return asked ? `${path}?${asked}` : path;
}

export class Api {
  constructor(public token: string) {}

  private async ask<Name extends keyof Requests>(
    name: Name,
    { of = "", query, body, keepalive = false, signal }: Details<Name> = {},
  ): Promise<Requests[Name]["answer"]> {
    const method = name.split(" ", 1)[0]!;
    const path = addressOf(name, of, query ?? {});
    const headers: Record<string, string> = { Authorization: `Bearer ${this.token}` };
    if (body !== undefined) headers["Content-Type"] = "application/json";
    let answer: Response, text: string;
    try {
      const sent = body === undefined ? {} : { body: JSON.stringify(body) };
      answer = await fetch(path, { method, headers, keepalive, ...sent, ...(signal ? { signal } : {}) });
      // An answer that breaks off is none: the server has gone, or the page is being left.
      text = await answer.text();
    } catch {
      throw new ApiError(0, "The server does not answer.");
    }
    let json: Record<string, unknown>;
    try {
      json = text === "" ? {} : (JSON.parse(text) as Record<string, unknown>);
    } catch {
      throw new ApiError(answer.status || 500, `The server answered ${path} with something that is not JSON.`);
    }
    if (!answer.ok)
      throw new ApiError(
        answer.status,
        String(json.error ?? `The server answered ${answer.status}.`),
        String(json.hint ?? ""),
        json,
      );
    return json as unknown as Requests[Name]["answer"];
  }

  project = () => this.ask("GET /api/project");
  spec = () => this.ask("GET /api/spec");
  save = (text: string, revision: string) => this.ask("PUT /api/spec", { body: { text, revision } });
  check = (text: string) => this.ask("POST /api/check", { body: { text } });
  /** The possible completions at a position of a text, and the meaning of a word there. */
  language = (question: LanguageQuestion) => this.ask("POST /api/language", { body: question });
  /** properties: empty: all. */
  verify = (text: string, timeout = "30s", properties: string[] = []) =>
    this.ask("POST /api/verify", { body: { text, timeout, properties } });
  /** The subsystems that cannot fire in a marking. */
  waits = (text: string, marking: { place: number }[]) => this.ask("POST /api/waits", { body: { text, marking } });
  /** The bounds of all chains; `what_if`: with these times of subsystems instead of those of the text. */
  timing = (text: string, what_if: OtherTimes[] = [], chain = "") =>
    this.ask("POST /api/timing", { body: { text, what_if, chain } });
  /** The run in which a time of a chain comes nearest to its bound. */
  timingWorst = ({ what_if, ...question }: WorstQuestion) =>
    this.ask("POST /api/timing/worst", { body: { ...question, what_if: [...what_if] } });
  timingChanges = (text: string, chain: string) => this.ask("POST /api/timing/changes", { body: { text, chain } });
  timingMeasured = (text: string, recording: string) => this.ask("POST /api/timing/measured", { body: { text, recording } });
  functions = (text: string) => this.ask("POST /api/functions", { body: { text } });
  addFunction = (text: string, subsystem: string, name: string) =>
    this.ask("POST /api/functions/add", { body: { text, subsystem, function: name } });
  renameFunction = (text: string, subsystem: string, from: string, name: string) =>
    this.ask("POST /api/functions/rename", { body: { text, subsystem, from, function: name } });
  /** The names that drivers in the simulated world can use, by their kinds. */
  worldTargets = (text: string) => this.ask("POST /api/world", { body: { text } });
  source = (file: string) => this.ask("GET /api/sources", { query: { file } });
  layout = () => this.ask("GET /api/layout");
  arrangement = () => this.ask("GET /api/arrangement");
  /** It arrives also if the page is closed at once. */
  arrange = (name: string, text: string) => this.ask("PUT /api/arrangement", { body: { name, text }, keepalive: true });
  saveLayout = (boxes: Positions, revision: string) =>
    this.ask("PUT /api/layout", { body: { boxes: boxes as unknown as BoxPositions, revision } });
  saveSource = (file: string, text: string, revision: string) => this.ask("PUT /api/sources", { body: { file, text, revision } });
  /** The edits of the text, and what a rename changes in other files. Nothing is written. */
  edit = (text: string, edit: Edit | Edit[]) => this.ask("POST /api/edit", { body: { text, edit } });
  /** Writes all of the files or none. */
  saveFiles = (files: Requests["POST /api/files"]["body"]["files"]) => this.ask("POST /api/files", { body: { files } });
  examples = () => this.ask("GET /api/examples");
  begin = (example: string) => this.ask("POST /api/begin", { body: { example } });
  verifyState = (job: string) => this.ask("GET /api/verify/JOB", { of: job });
  stopVerify = (job: string) => this.ask("DELETE /api/verify/JOB", { of: job });
  /** The user trusts the authors of the code. */
  trust = () => this.ask("POST /api/trust", { body: {} });
  driving = () => this.ask("GET /api/driving");
  emergencyStop = () => this.ask("POST /api/emergency_stop", { body: {} });
  emergencyReset = (controller: string) => this.ask("POST /api/emergency_reset", { body: { controller } });
  start = (request: RunRequest) => this.ask("POST /api/runs", { body: request });
  control = (run: string, request: ControlRequest) => this.ask("POST /api/runs/RUN/control", { of: run, body: request });
  /** Inputs of an operator. */
  operate = (run: string, request: ControlRequest, signal: AbortSignal) =>
    this.ask("POST /api/runs/RUN/control", { of: run, body: request, signal }) as Promise<Operators>;
  /** An answer that takes too long is not awaited. */
  operators = (run: string, patience_ms: number) =>
    this.ask("GET /api/runs/RUN/operators", { of: run, signal: AbortSignal.timeout(patience_ms) });
  /** The same for a page that may be about to close. */
  lastControl = (run: string, request: ControlRequest) =>
    this.ask("POST /api/runs/RUN/control", { of: run, body: request, keepalive: true });
  runs = () => this.ask("GET /api/runs");
  /** Sockets where controllers listen. */
  controllers = () => this.ask("GET /api/controllers");
  run = (run: string) => this.ask("GET /api/runs/RUN", { of: run });
  recordings = () => this.ask("GET /api/recordings");
  /** A part of a recording from a time on, as much as is sent at once. */
  recording = (name: string, from?: number) =>
    this.ask("GET /api/recordings/NAME", { of: name, query: from === undefined ? {} : { from: String(from) } });
  /** The scans and pictures of a recording between two times. */
  arrays = (name: string, from: number, to: number) =>
    this.ask("GET /api/recordings/NAME/arrays", { of: name, query: { from: String(from), to: String(to) } });
  /** Replaces the name, the text and the marks of a recording. */
  saveNotes = (name: string, notes: NotesRequest) => this.ask("PUT /api/recordings/NAME/notes", { of: name, body: notes });
  sweeps = () => this.ask("GET /api/sweeps");
  sweep = (sweep: string) => this.ask("GET /api/sweeps/JOB", { of: sweep });
  startSweep = (request: SweepRequest) => this.ask("POST /api/sweeps", { body: request });
  stopSweep = (sweep: string) => this.ask("DELETE /api/sweeps/JOB", { of: sweep });
  /** The devices of the simulated world that give scans and pictures. */
  views = () => this.ask("GET /api/views");
  /** The parts of the specification's net that a recording, or a run so far, has reached. */
  coverage = (name: string) => this.ask("GET /api/recordings/NAME/coverage", { of: name });
  runCoverage = (run: string) => this.ask("GET /api/runs/RUN/coverage", { of: run });
  /** The poses of a recording between two times. */
  poses = (name: string, from: number, to: number) =>
    this.ask("GET /api/recordings/NAME/poses", { of: name, query: { from: String(from), to: String(to) } });
  /** The glTF file of a simulated world. */
  async scene(hash: string): Promise<ArrayBuffer> {
    const answer = await fetch(addressOf("GET /api/scenes/HASH.glb" satisfies keyof Requests, hash, {}), {
      headers: { Authorization: `Bearer ${this.token}` },
    });
    if (!answer.ok) throw new ApiError(answer.status, "The file of this world is not there.");
    return answer.arrayBuffer();
  }
  /** The floor with that name, or that of the specification; undefined if there is no picture of it. */
  async floor(chosen: string | null | undefined): Promise<Floor | null> {
    try {
      const own = (await this.project()).simulation?.track;
      const name = chosen || own?.image;
      if (!name) return null;
      const answer = await fetch(addressOf("GET /api/tracks/NAME" satisfies keyof Requests, name, {}), {
        headers: { Authorization: `Bearer ${this.token}` },
      });
      if (!answer.ok) return null;
      return { image: await createImageBitmap(await answer.blob()), metresPerPixel: own?.metres_per_pixel ?? 0.005 };
    } catch {
      // Without the picture, the path is drawn on an empty background.
      return null;
    }
  }
  eventsAddress = () => addressOf("GET /api/events" satisfies keyof Requests, "", { token: this.token });
}
