import { type Api, message } from "./api";
import type { PanelShown } from "../model/protocol";
import type { Runner } from "./runner";
import { Store } from "./store";
import { neutralInputs, padInputs, released, type Inputs, type Pad } from "../model/run/panel_inputs";

export interface OperatorState {
  /** By path: the panels that this page operates, and the values of their controls. */
  inputs: ReadonlyMap<string, Inputs>;
  /** By path: the reason of the controller's refusal. */
  problems: ReadonlyMap<string, string>;
}

/** The period of repeated inputs in milliseconds: several within the life of an input. */
const repetition = (panels: Iterable<PanelShown>) => Math.min(80, ...[...panels].map(({ stale_s }) => stale_s * 250));

/**
 * Operates panels of the running controller. It repeats the inputs while the page is visible. Once the page
 * is hidden or closed, or an input is refused, it lets go, and the controller's panel becomes neutral.
 */
export class Operator {
  readonly store = new Store<OperatorState>({ inputs: new Map(), problems: new Map() });
  private readonly who = Array.from(crypto.getRandomValues(new Uint8Array(8)), (byte) => byte.toString(16)).join("");
  private readonly panels = new Map<string, PanelShown>();
  /** Panels with a request that has not been answered: there is at most one, so that none comes late. */
  private readonly asking = new Set<string>();
  private timer: ReturnType<typeof setInterval> | undefined;

  constructor(
    private readonly api: Pick<Api, "control" | "lastControl">,
    private readonly runner: Pick<Runner, "store">,
    private readonly pads: () => readonly (Pad | null)[] = () => (document.hasFocus() ? (navigator.getGamepads?.() ?? []) : []),
  ) {
    runner.store.subscribe(() => {
      if (!["running", "paused"].includes(runner.store.get().state)) this.stopAll();
    });
  }

  /** Lets go when the page is hidden or closed; releases held controls when it loses the focus. */
  watch(page: Document, frame: Window): void {
    page.addEventListener("visibilitychange", () => page.visibilityState === "hidden" && this.letGoOfAll());
    frame.addEventListener("pagehide", () => this.letGoOfAll());
    frame.addEventListener("blur", () => this.release());
  }

  take(panel: PanelShown): void {
    this.panels.set(panel.path, panel);
    this.put(panel.path, neutralInputs(panel.controls), "");
    clearInterval(this.timer);
    this.timer = setInterval(() => this.repeat(), repetition(this.panels.values()));
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

  /** Releases all keys and buttons. */
  release(): void {
    for (const [path, held] of this.store.get().inputs) this.move(path, released(this.panels.get(path)!.controls, held));
  }

  private put(path: string, inputs: Inputs | null, problem: string): void {
    const { inputs: all, problems } = this.store.get();
    const changed = new Map(all);
    if (inputs) changed.set(path, inputs);
    else changed.delete(path);
    const said = new Map(problems);
    if (problem) said.set(path, problem);
    else said.delete(path);
    this.store.set({ inputs: changed, problems: said });
  }

  /** false: it was not operated. */
  private stop(path: string, problem: string): boolean {
    if (!this.store.get().inputs.has(path)) return false;
    this.put(path, null, problem);
    if (this.store.get().inputs.size === 0) {
      clearInterval(this.timer);
      this.timer = undefined;
    }
    return true;
  }

  private stopAll(): void {
    for (const path of [...this.store.get().inputs.keys()]) this.stop(path, "");
  }

  private repeat(): void {
    for (const path of this.store.get().inputs.keys()) void this.send(path);
  }

  private async send(path: string): Promise<void> {
    const held = this.store.get().inputs.get(path);
    const { run } = this.runner.store.get();
    if (!held || run === null || this.asking.has(path)) return;
    this.asking.add(path);
    try {
      await this.api.control(run, { command: "panel", path, operator: this.who, inputs: { ...held, ...this.ofPad(path) } });
    } catch (error) {
      this.stop(path, message(error));
    } finally {
      this.asking.delete(path);
    }
    // A change made meanwhile must not wait for the next repetition.
    if (this.store.get().inputs.get(path) !== held) void this.send(path);
  }

  private ofPad(path: string): Inputs {
    const pad = this.pads().find((one) => one !== null);
    const number = [...this.store.get().inputs.keys()].indexOf(path);
    return pad ? padInputs(this.panels.get(path)!.controls, pad, number) : {};
  }
}
