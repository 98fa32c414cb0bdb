import type { NetModel } from "../model/net";
import { Series } from "../model/series";
import { Timeline } from "../model/timeline";
import type { Api } from "./api";
import type { Connection } from "./connection";
import { message, type Draft } from "./draft";
import type {
  Breakpoint,
  ControlRequest,
  FiringsEvent,
  Outcome,
  PoseEvent,
  RunInfo,
  RunRequest,
  RunState,
  SubsystemsEvent,
  ValuesEvent,
} from "./protocol";
import type { Stage } from "./stage";
import { Store } from "./store";

/** The next run as its form has it. */
export interface Wishes {
  kind: RunRequest["kind"];
  /** Empty: that of the specification. */
  track: string;
  time: string;
  seed: string;
  speed: string;
}

export interface RunnerState {
  run: string | null;
  state: RunState | "idle";
  kind: RunRequest["kind"];
  why: string;
  outcome: Outcome | null;
  build: readonly string[];
  speed: number;
  problem: string;
  /** Behaviour by path of subsystem, as the controller says. */
  behaviours: ReadonlyMap<string, string>;
  /** Where the run pauses. */
  breakpoints: readonly Breakpoint[];
}

export function sameBreakpoint(one: Breakpoint, other: Breakpoint): boolean {
  return JSON.stringify(one) === JSON.stringify(other);
}

const idle: RunnerState = {
  run: null,
  state: "idle",
  kind: "simulate",
  why: "",
  outcome: null,
  build: [],
  speed: 1,
  problem: "",
  behaviours: new Map(),
  breakpoints: [],
};

/** What a run left behind so far; read by what draws it, once per frame. */
export class Track {
  readonly timeline: Timeline;
  readonly series = new Series();
  readonly path: { t: number; x: number; y: number; heading: number }[] = [];
  firings = 0;
  dropped = 0;
  /** The moment that is shown, and up to when it is known what happened: the same while it happens. */
  now = 0;
  private known = 0;
  get end(): number {
    return Math.max(this.now, this.known);
  }
  knownUntil(time: number): void {
    this.known = time;
  }

  /** The floor, when there is a picture of it. */
  floor: { image: ImageBitmap; metresPerPixel: number } | null = null;

  constructor(readonly net: NetModel) {
    this.timeline = new Timeline(net);
  }
}

/** A run of the controller: started from here or found running, watched through the event stream. */
export class Runner {
  readonly store = new Store<RunnerState>(idle);
  readonly wishes = new Store<Wishes>({ kind: "simulate", track: "", time: "60s", seed: "1", speed: "1" });
  track: Track | null = null;
  private asking = false;

  constructor(
    private readonly api: Api,
    private readonly draft: Draft,
    private readonly stage: Stage,
    connection: Connection,
  ) {
    for (const name of ["build", "log"] as const)
      connection.on<{ run: string; line: string }>(
        name,
        (event) => this.mine(event) && this.store.set({ build: [...this.store.get().build.slice(-400), event.line] }),
      );
    connection.on<RunInfo>("run", (event) => this.mine(event) && this.told(event));
    connection.on<FiringsEvent>("firings", (event) => this.mine(event) && this.fired(event));
    connection.on<ValuesEvent>("values", (event) => this.mine(event) && this.valued(event));
    connection.on<PoseEvent>("pose", (event) => this.mine(event) && this.posed(event));
    connection.on<SubsystemsEvent>("subsystems", (event) => this.mine(event) && this.reported(event));
    connection.on("hello", () => void this.attach());
  }

  get active(): boolean {
    return ["building", "running", "paused"].includes(this.store.get().state);
  }

  private mine = (event: { run: string }): boolean => event.run === this.store.get().run;

  async start(request: RunRequest): Promise<void> {
    const { net } = this.draft.store.get();
    if (!net) return;
    this.store.set({
      ...idle,
      breakpoints: this.store.get().breakpoints,
      state: "building",
      kind: request.kind,
      speed: request.speed ?? 1,
    });
    this.watch(net);
    void this.showFloor(request.track);
    try {
      const { run } = await this.api.start(request);
      this.store.set({ run });
      // What happened before the answer came is asked for.
      this.told(await this.api.run(run));
    } catch (error) {
      this.store.set({ state: "failed", problem: message(error) });
      this.leave();
    }
  }

  /** After a reload or a lost connection: a run that goes on is watched again. */
  private async attach(): Promise<void> {
    const { net } = this.draft.store.get();
    try {
      const going = (await this.api.runs()).find((run) => ["building", "running", "paused"].includes(run.state));
      if (!going) {
        if (this.active) this.store.set({ state: "ended", why: "the server was restarted" });
        return;
      }
      if (going.run !== this.store.get().run && net) {
        if (!net.isNamed(going.net_hash)) {
          this.store.set({ problem: "A run of another version of the specification goes on; this drawing cannot show it." });
          return;
        }
        this.store.set({ ...idle, run: going.run, state: going.state, kind: going.kind ?? "simulate" });
        this.watch(net);
        void this.showFloor(going.track ?? undefined);
      }
      this.told({ ...(await this.api.run(going.run)), run: going.run });
    } catch (error) {
      this.store.set({ problem: message(error) });
    }
  }

  private watch(net: NetModel): void {
    this.track = new Track(net);
    this.stage.reset(net, "live");
  }

  private async showFloor(chosen: string | undefined): Promise<void> {
    const { track } = this;
    try {
      const own = (await this.api.project()).simulation?.track;
      const image = chosen || own?.image;
      if (track && image) track.floor = { image: await this.api.track(image), metresPerPixel: own?.metres_per_pixel ?? 0.005 };
    } catch {
      // Without the picture the path is drawn on nothing.
    }
  }

  private told(info: Partial<RunInfo>): void {
    if (!info.state) return;
    this.store.set({
      state: info.state,
      why: info.why ?? "",
      outcome: info.outcome ?? null,
    });
    if (info.marking && this.stage.mode === "live") this.stage.setMarked(info.marking);
    const { breakpoints } = this.store.get();
    if (info.state === "running" && breakpoints.length > 0)
      void this.control({ command: "breakpoints", breakpoints: [...breakpoints] });
  }

  private fired({ t, firings, dropped, marking }: FiringsEvent): void {
    const { track, stage } = this;
    if (!track) return;
    track.now = Math.max(track.now, t);
    track.firings += firings.length + dropped;
    track.dropped += dropped;
    const watching = stage.mode === "live";
    for (const [time, transition] of firings) {
      track.timeline.add(time, transition);
      if (watching) stage.fired(transition, marking === undefined);
    }
    if (watching && marking) stage.setMarked(marking);
  }

  private valued({ t, values }: ValuesEvent): void {
    const { track } = this;
    if (!track) return;
    track.now = Math.max(track.now, t);
    for (const [path, value] of Object.entries(values)) track.series.add(t, path, value);
  }

  private reported({ t, subsystems }: SubsystemsEvent): void {
    if (this.track) this.track.now = Math.max(this.track.now, t);
    const behaviours = new Map(subsystems.map(({ path, behaviour }) => [path, behaviour]));
    const known = this.store.get().behaviours;
    if (behaviours.size !== known.size || [...behaviours].some(([path, name]) => known.get(path) !== name))
      this.store.set({ behaviours });
  }

  private posed({ t, x, y, heading }: PoseEvent): void {
    const path = this.track?.path;
    if (!path) return;
    if (path.length > 40_000) path.splice(0, 10_000);
    path.push({ t, x, y, heading });
  }

  async control(request: ControlRequest): Promise<void> {
    const { run } = this.store.get();
    if (run === null) return;
    try {
      await this.api.control(run, request);
      this.store.set({ problem: "" });
    } catch (error) {
      this.store.set({ problem: message(error) });
    }
  }

  /** Shows the speed at once and asks for it; of many in a row, as a slider gives them, only the latest is asked for. */
  async setSpeed(speed: number): Promise<void> {
    this.store.set({ speed });
    if (this.asking) return;
    this.asking = true;
    for (let asked = NaN; asked !== this.store.get().speed;) {
      asked = this.store.get().speed;
      await this.control({ command: "speed", value: asked });
    }
    this.asking = false;
  }

  toggleBreakpoint(wanted: Breakpoint): void {
    const { breakpoints, state } = this.store.get();
    const others = breakpoints.filter((one) => !sameBreakpoint(one, wanted));
    const next = others.length < breakpoints.length ? others : [...breakpoints, wanted];
    this.store.set({ breakpoints: next });
    if (state === "running" || state === "paused") void this.control({ command: "breakpoints", breakpoints: next });
  }

  /** Puts the run away: the drawing is that of the text again. */
  close(): void {
    this.track = null;
    this.store.set({ ...idle, breakpoints: this.store.get().breakpoints });
    this.leave();
  }

  private leave(): void {
    const { net } = this.draft.store.get();
    if (net && this.stage.mode === "live") this.stage.reset(net, "edit");
  }
}
