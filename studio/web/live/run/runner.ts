import { LiveArrays } from "../arrays";
import { numbered, sameBreakpoint, titleOf, type NamedBreakpoint } from "./breakpoints";
import { runningBehaviours } from "../../model/net/game";
import type { NetModel } from "../../model/net/net";
import { bounded } from "../../model/sorted";
import { type Api, message } from "../api";
import type { Connection } from "../stream/connection";
import type { Draft } from "../draft";
import type {
  ControlRequest,
  Events,
  FiringsEvent,
  PoseEvent,
  PoseFrame,
  RunEvent,
  RunInfo,
  RunListed,
  RunRequest,
  SceneShown,
  StartRequest,
  SubsystemsEvent,
  ValuesEvent,
} from "../../model/protocol";
import { noteCommand } from "./run_log";
import { goesOn, idle, type RunnerState, type Wishes } from "./runner_state";
import { Stage } from "../stage";
import { Store } from "../store";
import { Track } from "./track";
import { LiveWorld } from "../world";

/** The events of a run that this class handles. */
type RunEventName =
  "build" | "log" | "run" | "firings" | "values" | "parameters" | "pose" | "arrays" | "scene" | "poses" | "subsystems";

/** Whether it was started elsewhere. */
const isWatched = (request: RunRequest) => request.kind === "attach" || request.kind === "deployment";
const isStarted = (request: RunRequest): request is StartRequest => !isWatched(request);

/** The number of output lines of build and controller that are kept. */
const kept = 400;

/** A run of the controller: started from here or found running, and followed through the event stream. */
export class Runner {
  readonly store = new Store<RunnerState>(idle);
  readonly stage = new Stage();
  readonly wishes = new Store<Wishes>({ kind: "simulate", track: "", time: "60s", seed: "1", speed: "1", all: false });
  track: Track | null = null;
  /** Further receivers of the state of a run. */
  private readonly informed: ((info: RunInfo) => void)[] = [];
  private asking = false;
  /** Questions whose answers have not arrived; events wait for them. */
  private asked = 0;
  private readonly held: (() => void)[] = [];
  /** The number of firings that led to the marking shown. */
  private marked = 0;
  /** Lines that have not been passed to the page yet. */
  private lines: string[] = [];

  constructor(
    private readonly api: Api,
    private readonly draft: Draft,
    connection: Connection,
  ) {
    const on = <Name extends RunEventName>(name: Name, take: (event: Events[Name]) => void, other: () => void = () => {}) =>
      connection.on(name, (event) => {
        const handle = () => (event.run === this.store.get().run ? take(event) : other());
        if (this.asked > 0) this.held.push(handle);
        else handle();
      });
    for (const name of ["build", "log"] as const) on(name, (event) => this.said(event.line));
    on(
      "run",
      (event) => this.told(event),
      () => void this.attach(),
    );
    on("firings", (event) => this.fired(event));
    on("values", (event) => this.valued(event));
    on("parameters", ({ parameters }) => this.store.set({ parameters }));
    on("pose", (event) => this.posed(event));
    on("arrays", (event) => this.track?.arrays instanceof LiveArrays && this.track.arrays.take(event));
    on("scene", (event) => this.sawScene(event));
    on("poses", (event) => this.sawPoses(event));
    on("subsystems", (event) => this.reported(event));
    connection.on("hello", () => void this.attach());
  }

  /**
   * The events that come while `ask` waits for answers are handled after them: they are of a run whose name
   * is not known yet, or newer than the answers.
   */
  private async beforeEvents(ask: () => Promise<void>): Promise<void> {
    this.asked += 1;
    try {
      await ask();
    } finally {
      this.asked -= 1;
      if (this.asked === 0) for (const take of this.held.splice(0)) take();
    }
  }

  onInfo(take: (info: RunInfo) => void): void {
    this.informed.push(take);
  }

  get active(): boolean {
    return goesOn(this.store.get().state);
  }

  async start(request: RunRequest): Promise<void> {
    const { net } = this.draft.store.get();
    if (!net) return;
    this.store.set({
      ...this.fresh(),
      state: "building",
      kind: request.kind,
      speed: isStarted(request) ? (request.speed ?? 1) : 1,
      request: isStarted(request) ? request : null,
    });
    this.watch(net, isStarted(request) ? request.track : null);
    await this.beforeEvents(async () => {
      try {
        const { run } = await this.api.start(request);
        this.store.set({ run });
        // Asks for everything that happened before the answer arrived.
        this.told(await this.api.run(run));
      } catch (error) {
        this.store.set({ state: "failed", problem: message(error), shown: false });
      }
    });
    await this.attach();
  }

  /** The state for a run that is not known yet. */
  private fresh(): RunnerState {
    const { breakpoints, others } = this.store.get();
    return { ...idle, breakpoints, others };
  }

  /** After a reload, a lost connection or news of another run: follows a running controller, and lists the others. */
  private attach(): Promise<void> {
    return this.beforeEvents(async () => {
      const { run } = this.store.get();
      try {
        const runs = await this.api.runs();
        // A run that is started meanwhile is followed instead.
        if (this.store.get().run === run && (run !== null || !this.active)) await this.followOneOf(runs);
        const mine = this.store.get().run;
        this.store.set({ others: runs.filter((one) => goesOn(one.state) && one.run !== mine) });
      } catch (error) {
        this.store.set({ problem: message(error) });
      }
    });
  }

  private async followOneOf(runs: readonly RunListed[]): Promise<void> {
    const { run, state } = this.store.get();
    const own = this.active ? runs.find((one) => one.run === run) : undefined;
    if (own) return this.told(await this.api.run(own.run));
    if (this.active) return this.store.set({ state: "ended", why: "the server was restarted" });
    const going = runs.find((one) => goesOn(one.state));
    if (state === "idle" && going) this.take(await this.api.run(going.run));
  }

  /** Follows another run of the server instead. */
  async follow(run: string): Promise<void> {
    await this.beforeEvents(async () => {
      try {
        this.take(await this.api.run(run));
      } catch (error) {
        this.store.set({ problem: message(error) });
      }
    });
    await this.attach();
  }

  /** A run can be stopped and controlled although its net is not that of the text, so that it is not drawn. */
  private take(info: RunInfo): void {
    const { net } = this.draft.store.get();
    this.store.set({ ...this.fresh(), run: info.run, state: info.state, kind: info.kind, netHash: info.net_hash });
    if (net?.isNamed(info.net_hash)) this.watch(net, info.track);
    else this.track = null;
    this.told(info);
  }

  /** Stops a run of the server that this page does not follow. */
  async stopOther(run: string): Promise<void> {
    try {
      await this.api.control(run, { command: "stop" });
    } catch (error) {
      this.store.set({ problem: message(error) });
    }
    await this.attach();
  }

  private watch(net: NetModel, floor: string | null | undefined): void {
    const track = (this.track = new Track(net));
    this.lines = [];
    this.marked = 0;
    this.stage.reset(net, "live");
    this.show(true);
    void this.api.floor(floor).then((found) => (track.floor = found));
  }

  /** Gives the run a pane of the drawing, or removes it. The run itself continues. */
  show(shown: boolean): void {
    const { run } = this.store.get();
    if (shown && this.track === null && run !== null) void this.follow(run);
    else this.store.set({ shown: shown && this.track !== null });
  }

  /** Called by an event, or with the whole state of the run. */
  private told(info: RunEvent | RunInfo): void {
    const { state, why, outcome, marking, firings } = info;
    this.store.set({ state, why, outcome, ...(outcome?.chains && { measured: outcome.chains }) });
    this.setMarked(marking, firings);
    if ("values" in info) {
      this.store.set({ netHash: info.net_hash });
      for (const take of this.informed) take(info);
      this.store.set({ parameters: info.parameters, panels: info.panels });
      this.counted(firings);
      this.valued(info);
      this.track?.pathUpTo(info.path);
      if (info.scene) this.sawScene(info.scene);
      if (info.poses) this.sawPoses(info.poses);
    } else if (state === "ended" || state === "paused") void this.seePath();
    // A paused run has reported all its firings.
    if (this.track && (state === "ended" || state === "paused")) this.track.known = this.track.end;
    if (state === "running" && this.store.get().breakpoints.length > 0) void this.setBreakpoints();
  }

  /**
   * In a fast run, poses are too rare for a line. When the run stands still, there is time
   * to load all that are kept.
   */
  private async seePath(): Promise<void> {
    const { track } = this;
    const { run } = this.store.get();
    if (!track || run === null || track.path.length === 0) return;
    try {
      track.pathUpTo((await this.api.run(run)).path);
    } catch {
      // The display stays as it is.
    }
  }

  /** Shows a marking, unless it is older than the one shown: fewer firings have led to it. */
  private setMarked(marking: readonly number[], firings: number): boolean {
    if (!this.track || firings < this.marked) return false;
    this.marked = firings;
    this.stage.setMarked(marking);
    return true;
  }

  /** total: firings of the run so far. Events may have been lost since the last total. */
  private counted(total: number): void {
    const { track, stage } = this;
    if (!track) return;
    track.firings = Math.max(track.firings, total);
    stage.sampled = track.dropped > 0;
  }

  private fired({ t, firings, total, marking }: FiringsEvent): void {
    const { track, stage } = this;
    if (!track) return;
    track.reached(t);
    track.known = Math.max(track.known, t);
    track.listed += firings.length;
    this.counted(total);
    for (const row of firings) {
      track.fired(row);
      stage.fired(row[1], marking === undefined && total > this.marked);
    }
    this.marked = Math.max(this.marked, total);
    if (!marking || !this.setMarked(marking, total)) return;
    track.tell(t, runningBehaviours(track.net, stage.marking));
  }

  private valued(event: ValuesEvent | RunInfo): void {
    const { t, values } = event;
    const { track } = this;
    track?.reached(t);
    // The requested values may be older than values received since.
    track?.values(track.now, values);
    if ("arrivals" in event && event.arrivals) track?.arrived(event.arrivals, event.arrivals_dropped);
  }

  /**
   * A controller may print thousands of lines a second, so the page receives them
   * together, ten times a second.
   */
  private said(line: string): void {
    if (bounded(this.lines, kept).push(line) > 1) return;
    setTimeout(() => {
      const build = [...this.store.get().build, ...this.lines].slice(-kept);
      this.lines = [];
      this.store.set({ build });
    }, 100);
  }

  private reported({ t, subsystems, chains }: SubsystemsEvent): void {
    this.track?.reached(t);
    const behaviours = new Map(subsystems.flatMap(({ path, behaviour }) => (behaviour === null ? [] : [[path, behaviour]])));
    const known = this.store.get().behaviours;
    if (behaviours.size !== known.size || [...behaviours].some(([path, name]) => known.get(path) !== name))
      this.store.set({ behaviours });
    if (chains) this.store.set({ measured: chains });
  }

  /** The event is repeated when the file has come through a tunnel. */
  private sawScene({ hash, bodies }: SceneShown): void {
    if (this.track && this.track.world?.scene.hash !== hash) this.track.world = new LiveWorld({ hash, bodies });
  }

  private sawPoses(frame: PoseFrame): void {
    this.track?.reached(frame.t);
    if (this.track?.world instanceof LiveWorld) this.track.world.take(frame);
  }

  private posed(pose: PoseEvent): void {
    this.track?.reached(pose.t);
    this.track?.pose(pose);
  }

  async control(request: ControlRequest): Promise<void> {
    const { run } = this.store.get();
    if (run === null) return;
    try {
      await this.api.control(run, request);
      noteCommand(this.track, request);
      this.store.set({ problem: "" });
    } catch (error) {
      this.store.set({ problem: message(error) });
    }
  }

  /** Stops the run, and waits until it has ended. */
  async stop(): Promise<void> {
    if (!this.active) return;
    const ended = new Promise<void>((done) => {
      const leave = this.store.subscribe(() => {
        if (this.active) return;
        leave();
        done();
      });
    });
    await this.control({ command: "stop" });
    await ended;
  }

  /** Returns why the controller refuses the value; empty: it accepts it. */
  async setParameter(path: string, text: string): Promise<string> {
    const { run } = this.store.get();
    if (run === null) return "There is no run.";
    try {
      const request: ControlRequest = { command: "set", path, text };
      await this.api.control(run, request);
      noteCommand(this.track, request);
      return "";
    } catch (error) {
      return message(error);
    }
  }

  /**
   * Shows the speed at once and sends it. Among many changes in a row, as from a slider, only the latest is
   * sent.
   */
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

  toggleBreakpoint(wanted: NamedBreakpoint): void {
    const { breakpoints, state } = this.store.get();
    const others = breakpoints.filter((one) => !sameBreakpoint(one, wanted));
    this.store.set({ breakpoints: others.length < breakpoints.length ? others : [...breakpoints, wanted] });
    if (state === "running" || state === "paused") void this.setBreakpoints();
  }

  /** In the numbers of the net that runs, which may not be that of the text. */
  private async setBreakpoints(): Promise<void> {
    if (!this.track) return;
    const { found, lost } = numbered(this.track.net, this.store.get().breakpoints);
    await this.control({ command: "breakpoints", breakpoints: found });
    if (lost.length > 0 && this.store.get().problem === "")
      this.store.set({ problem: `This run does not pause at ${lost.map(titleOf).join(", ")}: its net has no such element.` });
  }

  /** Closes the run. */
  close(): void {
    this.track = null;
    this.store.set(this.fresh());
  }
}
