import { type Api, message } from "../api";
import type { Coverage } from "../../model/protocol";
import type { Pane, Scene } from "../scene";
import type { Runner } from "./runner";
import { Store } from "../store";

/** Milliseconds between two requests for a running run. */
const pause = 2000;

const kept = "tessera.coverage";

export interface CoverageState {
  /** Whether the drawings are shaded. */
  on: boolean;
  /** By pane. */
  known: ReadonlyMap<string, Coverage | { problem: string }>;
}

/** Shades on the drawings the elements that the run or the recording of each pane has never reached. */
export class Coverages {
  readonly store: Store<CoverageState>;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private asked = 0;

  constructor(
    private readonly api: Api,
    private readonly scene: Scene,
    private readonly runner: Runner,
  ) {
    this.store = new Store<CoverageState>({ on: sessionStorage.getItem(kept) === "on", known: new Map() });
    let panes = "";
    scene.store.subscribe(() => {
      const now = this.panes.map(({ id, track }) => `${id} ${id === "run" ? track?.id : ""}`).join();
      if (now === panes) return;
      panes = now;
      this.store.set({ known: new Map() });
      void this.look();
    });
    let { state, run } = runner.store.get();
    runner.store.subscribe(() => {
      const now = runner.store.get();
      if (now.state === state && now.run === run) return;
      ({ state, run } = now);
      void this.look();
    });
  }

  toggle(): void {
    const on = !this.store.get().on;
    sessionStorage.setItem(kept, on ? "on" : "off");
    this.store.set({ on });
    if (!on) this.shade();
    void this.look();
  }

  private get panes(): readonly Pane[] {
    return this.scene.store.get().panes.filter(({ track }) => track !== null);
  }

  /** Requests missing data, and again for a running run. */
  private async look(): Promise<void> {
    clearTimeout(this.timer);
    const asked = (this.asked += 1);
    if (!this.store.get().on) return;
    for (const pane of this.panes) {
      if (pane.replay && this.store.get().known.has(pane.id)) continue;
      const found = await this.of(pane);
      if (asked !== this.asked) return;
      if (found) this.store.set({ known: new Map(this.store.get().known).set(pane.id, found) });
    }
    this.shade();
    if (this.runner.active && this.panes.some(({ id }) => id === "run")) this.timer = setTimeout(() => void this.look(), pause);
  }

  private async of({ replay }: Pane): Promise<Coverage | { problem: string } | null> {
    const { run, state } = this.runner.store.get();
    try {
      if (replay) return await this.api.coverage(replay.name);
      return run === null || state === "building" ? null : await this.api.runCoverage(run);
    } catch (error) {
      return { problem: message(error) };
    }
  }

  private shade(): void {
    const { on, known } = this.store.get();
    for (const { id, stage } of this.panes) {
      const found = known.get(id);
      stage.shade(on && found && !("problem" in found) ? found.missing : null);
    }
  }
}
