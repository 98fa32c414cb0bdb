import type {
  Analysis,
  ControlRequest,
  Project,
  Recording,
  RecordingInfo,
  RunInfo,
  RunRequest,
  SpecAnswer,
  VerifyEvent,
} from "./protocol";

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

/** If another tab is opened with the key of a restarted server, this tab uses the key, too. */
export function shareToken(token: string, taken: (token: string) => void): void {
  const tabs = new BroadcastChannel(key);
  tabs.onmessage = (event: MessageEvent<string>) => {
    if (event.data === sessionStorage.getItem(key)) return;
    sessionStorage.setItem(key, event.data);
    taken(event.data);
  };
  tabs.postMessage(token);
  // Opening the new address in the old tab changes only the part after the #.
  addEventListener("hashchange", () => {
    if (location.hash.includes("token=")) location.reload();
  });
}

export class Api {
  constructor(public token: string) {}

  private async ask<T>(method: string, path: string, body?: unknown): Promise<T> {
    const headers: Record<string, string> = { Authorization: `Bearer ${this.token}` };
    if (body !== undefined) headers["Content-Type"] = "application/json";
    let answer: Response;
    try {
      answer = await fetch(path, { method, headers, ...(body === undefined ? {} : { body: JSON.stringify(body) }) });
    } catch {
      throw new ApiError(0, "The server does not answer.");
    }
    let json: Record<string, unknown>;
    try {
      json = answer.headers.get("Content-Length") === "0" ? {} : ((await answer.json()) as Record<string, unknown>);
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
    return json as T;
  }

  project = () => this.ask<Project>("GET", "/api/project");
  spec = () => this.ask<SpecAnswer>("GET", "/api/spec");
  save = (text: string, revision: string) =>
    this.ask<{ revision: string; analysis: Analysis }>("PUT", "/api/spec", { text, revision });
  check = (text: string) => this.ask<Analysis>("POST", "/api/check", { text });
  verify = (text: string, properties?: string[], timeout = "30s") =>
    this.ask<{ job: string }>("POST", "/api/verify", { text, timeout, ...(properties ? { properties } : {}) });
  verifyState = (job: string) => this.ask<VerifyEvent>("GET", `/api/verify/${encodeURIComponent(job)}`);
  stopVerify = (job: string) => this.ask<object>("DELETE", `/api/verify/${encodeURIComponent(job)}`);
  start = (request: RunRequest) => this.ask<{ run: string }>("POST", "/api/runs", request);
  control = (run: string, request: ControlRequest) =>
    this.ask<object>("POST", `/api/runs/${encodeURIComponent(run)}/control`, request);
  runs = () =>
    this.ask<RunInfo[] | { runs: RunInfo[] }>("GET", "/api/runs").then((answer) =>
      Array.isArray(answer) ? answer : answer.runs,
    );
  /** Sockets where controllers listen. */
  controllers = () => this.ask<string[]>("GET", "/api/controllers");
  run = (run: string) => this.ask<RunInfo>("GET", `/api/runs/${encodeURIComponent(run)}`);
  recordings = () =>
    this.ask<RecordingInfo[] | { recordings: RecordingInfo[] }>("GET", "/api/recordings").then((answer) =>
      Array.isArray(answer) ? answer : answer.recordings,
    );
  /** One part of a recording, as much as is sent at once, from a time on. */
  recording = (name: string, from?: number) =>
    this.ask<Recording>("GET", `/api/recordings/${encodeURIComponent(name)}${from === undefined ? "" : `?from=${from}`}`);
  /** The floor with that name, or that of the specification; null: there is no picture of it. */
  async floor(chosen: string | null | undefined): Promise<Floor | null> {
    try {
      const own = (await this.project()).simulation?.track;
      const name = chosen || own?.image;
      if (!name) return null;
      const answer = await fetch(`/api/tracks/${encodeURIComponent(name)}`, {
        headers: { Authorization: `Bearer ${this.token}` },
      });
      if (!answer.ok) return null;
      return { image: await createImageBitmap(await answer.blob()), metresPerPixel: own?.metres_per_pixel ?? 0.005 };
    } catch {
      // Without the picture, the path is drawn on an empty background.
      return null;
    }
  }
  eventsAddress = () => `/api/events?token=${encodeURIComponent(this.token)}`;
}
