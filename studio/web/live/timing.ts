import type { TimedChange, Timing as Bounds } from "../model/protocol";
import { shownChain } from "../model/timing";
import { whatIf, type Tried } from "../model/tried_times";
import { type Api, ApiError, message } from "./api";
import type { Draft } from "./draft";
import { Store } from "./store";

export interface TimingState {
  /** The bounds of the specification. */
  found: Bounds | null;
  /** The text that they are of. */
  text: string;
  /** Other times that the user tries, by subsystem ("robot.control"). */
  tried: ReadonlyMap<string, Tried>;
  /** The bounds with these; null: nothing is tried, or they are not known yet. */
  other: Bounds | null;
  /** The key of the chain that is shown; null: the user has chosen none. */
  chosen: string | null;
  /** An answer is on its way. */
  busy: boolean;
  problem: string;
  /** The bounds of the text that was verified last. */
  verified: Bounds | null;
  /** Those are being computed. */
  judging: boolean;
  /** Why they are not known; empty: they are, or nothing was verified. */
  unjudged: string;
  /** The changes that help, and the chain and the text that they are for. */
  changes: { chain: string; text: string; found: readonly TimedChange[] } | null;
  seeking: boolean;
}

/** How old commands can be: the bounds of all chains of the text, and those with other rates. */
export class Timing {
  readonly store = new Store<TimingState>({
    found: null,
    text: "",
    tried: new Map(),
    other: null,
    chosen: null,
    busy: false,
    problem: "",
    verified: null,
    judging: false,
    unjudged: "",
    changes: null,
    seeking: false,
  });
  private asking = false;
  private stale = false;
  /** The text that was verified last. */
  private judged = "";
  /** The chain whose parts `found` tells. */
  private told = "";

  constructor(
    private readonly api: Api,
    private readonly draft: Draft,
  ) {}

  /** Asks for the bounds of the text as it is now, unless they are known. */
  look(): void {
    const { text } = this.draft;
    if (this.store.get().found && this.store.get().text === text && this.store.get().problem === "") return;
    this.update();
  }

  choose(chain: string | null): void {
    this.store.set({ chosen: chain });
    if (this.store.get().found) this.update();
  }

  /** Asks which single change helps a chain most. */
  async seek(chain: string): Promise<void> {
    const { text } = this.draft;
    this.store.set({ seeking: true, changes: null });
    try {
      const { changes } = await this.api.timingChanges(text, chain);
      this.store.set({ changes: { chain, text, found: changes } });
    } catch (error) {
      this.store.set({ problem: message(error) });
    }
    this.store.set({ seeking: false });
  }

  /** Asks for the bounds with other times of a subsystem; undefined: with its own one. Those that are absent stay. */
  try(subsystem: string, times: { [time in keyof Tried]: number | undefined }): void {
    const tried = new Map(this.store.get().tried);
    const { period_ns, longest_ns } = { ...tried.get(subsystem), ...times };
    if (period_ns === undefined && longest_ns === undefined) tried.delete(subsystem);
    else
      tried.set(subsystem, {
        ...(period_ns === undefined ? {} : { period_ns }),
        ...(longest_ns === undefined ? {} : { longest_ns }),
      });
    this.store.set(tried.size === 0 ? { tried, other: null } : { tried });
    this.update();
  }

  forget(): void {
    this.store.set({ tried: new Map(), other: null, problem: "" });
  }

  /** Asks for the bounds of a text that was verified. */
  async verify(text: string): Promise<void> {
    this.judged = text;
    this.store.set({ verified: null, judging: true, unjudged: "" });
    const is = (found: Partial<TimingState>) => {
      // Another text may have been verified meanwhile.
      if (this.judged === text) this.store.set({ judging: false, ...found });
    };
    try {
      is({ verified: await this.api.timing(text) });
    } catch (error) {
      is({ unjudged: message(error) });
    }
  }

  /** One question at a time; of those that come meanwhile, only the last one is asked. */
  private update(): void {
    this.stale = true;
    if (!this.asking) void this.ask();
  }

  /** The name of the chain whose parts are shown. */
  private explained(): string {
    const { found, chosen } = this.store.get();
    return shownChain(found, chosen)?.name ?? "";
  }

  private async ask(): Promise<void> {
    this.asking = true;
    this.store.set({ busy: true });
    while (this.stale) {
      this.stale = false;
      const { text } = this.draft;
      try {
        const asked = this.explained();
        if (this.store.get().text !== text || !this.store.get().found || asked !== this.told) {
          let found = await this.api.timing(text, [], asked);
          const named = shownChain(found, this.store.get().chosen)?.name ?? "";
          // The first answer tells which chains there are.
          if (named !== asked) found = await this.api.timing(text, [], named);
          this.told = named;
          this.store.set({ found, text, problem: "" });
        }
        const { tried } = this.store.get();
        if (tried.size > 0) {
          const known = this.store.get().found?.subsystems ?? [];
          const other = await this.api.timing(text, whatIf(tried, known), this.explained());
          // A slider that was put back meanwhile asks for nothing.
          if (this.store.get().tried.size > 0) this.store.set({ other, problem: "" });
        } else this.store.set({ other: null, problem: "" });
      } catch (error) {
        this.refused(error);
      }
    }
    this.asking = false;
    this.store.set({ busy: false });
  }

  /** A text with errors keeps the bounds of the one before. A rate that is tried may be gone with its subsystem. */
  private refused(error: unknown): void {
    const gone = error instanceof ApiError && error.status === 422 && this.store.get().text === this.draft.text;
    this.store.set({ problem: message(error), ...(gone ? { tried: new Map(), other: null } : {}) });
  }
}
