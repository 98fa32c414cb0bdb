import { type Api, ApiError, message } from "../api";
import { Gamepads } from "./gamepads";
import type { Operators, PanelShown } from "../../model/protocol";
import type { Runner } from "../runner";
import { Store } from "../store";
import { neutralInputs, released, type Inputs } from "../../model/run/panel_inputs";

export interface OperatorState {
  /** By path: the panels that this page operates, and the values that its pointers and keys give the controls. */
  inputs: ReadonlyMap<string, Inputs>;
  /** By path: the values that the gamepad gives instead. */
  padInputs: ReadonlyMap<string, Inputs>;
  /** By path: the reason why the page does not operate the panel any more. */
  problems: ReadonlyMap<string, string>;
  /** By path: the other operators of the same server. */
  others: ReadonlyMap<string, string>;
  /** The panels whose sliders spring back, too. */
  springing: ReadonlySet<string>;
  /** Counts the moments at which everything that was held counts as released. */
  rests: number;
  /** The last answer of the server: when (ms of the page's clock), and the time that it took. */
  heard: { at: number; took: number } | null;
}

/** The period of repeated inputs in milliseconds: several within the life of an input. */
const repetition = (panels: Iterable<PanelShown>) => Math.min(80, ...[...panels].map(({ stale_s }) => stale_s * 250));
/** The period in which a gamepad is read, in milliseconds. */
const padPeriod = 30;
/** The period of questions for the other operators, in milliseconds. */
const lookPeriod = 1000;
/** An answer is awaited for at least so long, in milliseconds; the controller's panel is neutral much earlier. */
const patience = 1500;
const patienceFor = ({ stale_s }: PanelShown) => Math.max(patience, 2000 * stale_s);

/** A request that has not been answered. */
interface Asked {
  giveUp: AbortController;
  /** Repetitions since then: a page that was busy itself has not waited for the server. */
  repetitions: number;
}

/** After so many inputs in a row that came too late, the connection is too slow for the panel. */
const mostLate = 5;
const tooSlow = "The connection is too slow: the inputs came too late and were not used, so this page let go.";

/**
 * Operates panels of the running controller. It repeats the inputs while the page is visible. Once the page
 * is hidden or closed, an input is refused, or the server does not answer, it lets go, and the controller's panel
 * becomes neutral. It does so by itself when no input has come for its time `stale`.
 */
export class Operator {
  readonly store = new Store<OperatorState>({
    inputs: new Map(),
    padInputs: new Map(),
    problems: new Map(),
    others: new Map(),
    springing: new Set(),
    rests: 0,
    heard: null,
  });
  private readonly who = Array.from(crypto.getRandomValues(new Uint8Array(8)), (byte) => byte.toString(16).padStart(2, "0")).join(
    "",
  );
  private readonly panels = new Map<string, PanelShown>();
  /** Panels with a request that has not been answered: there is at most one, so that none comes late. */
  private readonly asking = new Map<string, Asked>();
  /** The newest stamp of the server: it refuses inputs that were held back for long after it. */
  private stamp: number | undefined;
  /** So many inputs in a row came too late to be used. */
  private late = 0;
  private timers: ReturnType<typeof setInterval>[] = [];

  constructor(
    private readonly api: Pick<Api, "operate" | "operators" | "lastControl">,
    private readonly runner: Pick<Runner, "store">,
    readonly gamepads: Gamepads = new Gamepads(),
  ) {
    runner.store.subscribe(() => {
      if (!["running", "paused"].includes(runner.store.get().state)) this.stopAll();
    });
  }

  /** Lets go when the page is hidden or closed; releases held controls when it loses the focus. */
  watch(page: Document, frame: Window): void {
    page.addEventListener("visibilitychange", () => page.visibilityState === "hidden" && this.letGoOfAll());
    // A page that the browser freezes, or keeps for the way back, sends nothing later.
    page.addEventListener("freeze", () => this.letGoOfAll());
    frame.addEventListener("pagehide", () => this.letGoOfAll());
    frame.addEventListener("blur", () => this.release());
  }

  /** Asks for the other operators once a second, until the result is called. */
  lookAtOthers(): () => void {
    const timer = setInterval(() => void this.look(), lookPeriod);
    void this.look();
    return () => clearInterval(timer);
  }

  /** The name of this page as others see it: the beginning of a random number. */
  get name(): string {
    return this.who.slice(0, 4);
  }

  take(panel: PanelShown): void {
    this.panels.set(panel.path, panel);
    this.gamepads.forget(panel.path);
    this.put(panel.path, neutralInputs(panel.controls), "");
    this.pause();
    this.timers = [
      setInterval(() => this.repeat(), repetition(this.panels.values())),
      setInterval(() => this.lookAtPad(), padPeriod),
    ];
    void this.send(panel.path);
  }

  move(path: string, change: Inputs): void {
    const held = this.store.get().inputs.get(path);
    if (!held) return;
    this.put(path, { ...held, ...change }, "");
    void this.send(path);
  }

  letGo(path: string): void {
    const { run } = this.runner.store.get();
    if (!this.stop(path, "") || run === null) return;
    this.api.lastControl(run, { command: "panel", path, operator: this.who }).catch(() => {
      // The controller lets go by itself, soon.
    });
  }

  letGoOfAll(): void {
    for (const path of [...this.store.get().inputs.keys()]) this.letGo(path);
  }

  /** Releases all sticks, keys and buttons; they count again when they are pressed anew. */
  release(): void {
    this.store.set({ rests: this.store.get().rests + 1 });
    this.lookAtPad();
    const { inputs, springing } = this.store.get();
    for (const [path, held] of inputs) this.move(path, released(this.panels.get(path)!.controls, held, springing.has(path)));
  }

  /** Whether the sliders of a panel spring back when they are released, or stay where they are. */
  letSpring(path: string, springs: boolean): void {
    const springing = new Set(this.store.get().springing);
    springing[springs ? "add" : "delete"](path);
    this.store.set({ springing });
  }

  private put(path: string, inputs: Inputs | null, problem: string): void {
    const { inputs: all, problems, padInputs } = this.store.get();
    const changed = new Map(all);
    const byPad = new Map(padInputs);
    if (inputs) changed.set(path, inputs);
    else {
      changed.delete(path);
      byPad.delete(path);
    }
    const said = new Map(problems);
    if (problem) said.set(path, problem);
    else said.delete(path);
    this.store.set({ inputs: changed, padInputs: byPad, problems: said });
  }

  /** false: it was not operated. */
  private stop(path: string, problem: string): boolean {
    if (!this.store.get().inputs.has(path)) return false;
    this.put(path, null, problem);
    if (this.store.get().inputs.size === 0) this.pause();
    return true;
  }

  private pause(): void {
    for (const timer of this.timers.splice(0)) clearInterval(timer);
  }

  private stopAll(): void {
    for (const path of [...this.store.get().inputs.keys()]) this.stop(path, "");
    this.stamp = undefined;
  }

  private repeat(): void {
    const period = repetition(this.panels.values());
    for (const [path, asked] of this.asking) {
      asked.repetitions += 1;
      if (asked.repetitions * period > patienceFor(this.panels.get(path)!)) asked.giveUp.abort();
    }
    for (const path of this.store.get().inputs.keys()) void this.send(path);
  }

  /** A change of the gamepad is sent at once. */
  private lookAtPad(): void {
    const { inputs, padInputs } = this.store.get();
    [...inputs.keys()].forEach((path, number) => {
      const { inputs: given, switched } = this.gamepads.inputsOf(this.panels.get(path)!, number);
      for (const field of switched) this.move(path, { [field]: inputs.get(path)![field] !== true });
      if (JSON.stringify(given) === JSON.stringify(padInputs.get(path) ?? {})) return;
      this.store.set({ padInputs: new Map(this.store.get().padInputs).set(path, given) });
      void this.send(path);
    });
  }

  private given(path: string): Inputs | undefined {
    const { inputs, padInputs } = this.store.get();
    const held = inputs.get(path);
    return held && { ...held, ...padInputs.get(path) };
  }

  private async send(path: string): Promise<void> {
    const given = this.given(path);
    const { run } = this.runner.store.get();
    if (!given || run === null || this.asking.has(path)) return;
    const panel = this.panels.get(path)!;
    const giveUp = new AbortController();
    this.asking.set(path, { giveUp, repetitions: 0 });
    const asked = performance.now();
    try {
      const inputs = { command: "panel" as const, path, operator: this.who, inputs: given, within: panel.stale_s };
      const after = this.stamp === undefined ? {} : { after: this.stamp };
      const answer = await this.api.operate(run, { ...inputs, ...after }, giveUp.signal);
      this.heard(answer, asked);
      this.late = answer.late ? this.late + 1 : 0;
      if (this.late >= mostLate) this.stop(path, tooSlow);
    } catch (error) {
      this.stop(path, this.whyNot(error, panel));
    } finally {
      this.asking.delete(path);
    }
    // A change made meanwhile must not wait for the next repetition.
    const now = this.given(path);
    if (now && JSON.stringify(now) !== JSON.stringify(given)) void this.send(path);
  }

  private whyNot(error: unknown, { stale_s }: PanelShown): string {
    if (error instanceof ApiError && error.status === 0)
      return `The server did not answer, so this page let go. The controller takes the neutral values after ${stale_s} s by itself.`;
    return message(error);
  }

  private async look(): Promise<void> {
    const { run, state } = this.runner.store.get();
    if (run === null || !["running", "paused"].includes(state)) return;
    const asked = performance.now();
    try {
      this.heard(await this.api.operators(run, patience), asked);
    } catch {
      // The age of the last answer says so.
    }
  }

  private heard({ stamp, operators }: Operators, asked: number): void {
    this.stamp = stamp;
    const at = performance.now();
    const others = new Map(operators.filter(({ operator }) => operator !== this.who).map((one) => [one.path, one.operator]));
    this.store.set({ others, heard: { at, took: at - asked } });
  }
}
