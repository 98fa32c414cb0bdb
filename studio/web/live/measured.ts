import type { MeasuredChain } from "../model/protocol";
import type { Shown, TimedRun } from "../model/timed_run";
import { type Api, message } from "./api";
import type { Draft } from "./draft";
import { Store } from "./store";

/** A run of a chain that is marked in the timeline of its recording. */
export interface MarkedRun {
  recording: string;
  run: TimedRun;
  path: readonly string[];
  shown: Shown;
}

export interface MeasuredState {
  /** The recording that is, or will be, measured; null: none. */
  recording: string | null;
  /** The chains as they were measured; null: not yet. */
  chains: readonly MeasuredChain[] | null;
  busy: boolean;
  problem: string;
  marked: MarkedRun | null;
}

/** How old commands were in the recording that is shown. */
export class Measured {
  readonly store = new Store<MeasuredState>({ recording: null, chains: null, busy: false, problem: "", marked: null });
  private asked = "";

  constructor(
    private readonly api: Api,
    private readonly draft: Draft,
  ) {}

  /**
   * Measures a recording, unless that is done. Reading it takes a while, so that it is read again only if there are other
   * chains: `chains` names them.
   */
  async look(recording: string | null, chains: string): Promise<void> {
    const asked = JSON.stringify([recording, chains]);
    if (asked === this.asked) return;
    this.asked = asked;
    const marked = this.store.get().marked;
    this.store.set({
      recording,
      chains: null,
      problem: "",
      busy: recording !== null,
      marked: marked?.recording === recording ? marked : null,
    });
    if (recording === null) return;
    try {
      const { chains: found } = await this.api.timingMeasured(this.draft.text, recording);
      if (asked === this.asked) this.store.set({ chains: found, busy: false });
    } catch (error) {
      if (asked === this.asked) this.store.set({ problem: message(error), busy: false });
    }
  }

  /** Asks again at the next look, because the recording may have changed. */
  forget(): void {
    this.asked = "";
  }

  /** Marks a run in the timeline of its recording. */
  mark(marked: MarkedRun | null): void {
    this.store.set({ marked });
  }
}
