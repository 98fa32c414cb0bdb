import type { OtherTimes, WorstRun } from "../../model/protocol";
import type { Shown } from "../../model/timed_run";
import { type Api, message } from "../api";
import { Store } from "../store";

/** The question for the slowest run of a chain. */
export interface WorstQuestion {
  text: string;
  chain: string;
  of: Shown;
  what_if: readonly OtherTimes[];
}

export interface WorstState {
  /** The question that `run` answers, as text. */
  asked: string;
  run: WorstRun | null;
  /** Why there is no run. */
  why: string;
  busy: boolean;
}

const none: WorstState = { asked: "", run: null, why: "", busy: false };

/** The run in which a time of a chain comes nearest to its bound. */
export class Worst {
  readonly store = new Store<WorstState>(none);

  constructor(private readonly api: Api) {}

  /** Asks for the run, unless it is known. Only the last question is answered. */
  async look(question: WorstQuestion): Promise<void> {
    const asked = JSON.stringify(question);
    if (this.store.get().asked === asked) return;
    this.store.set({ ...none, asked, busy: true });
    try {
      const { run, why } = await this.api.timingWorst(question);
      if (this.store.get().asked === asked) this.store.set({ run, why, busy: false });
    } catch (error) {
      if (this.store.get().asked === asked) this.store.set({ why: message(error), busy: false });
    }
  }
}
