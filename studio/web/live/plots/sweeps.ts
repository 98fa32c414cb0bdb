import type { ParameterShown, SweepEvent, SweepRequest, SweepRow } from "../../model/protocol";
import { type Api, message } from "../api";
import type { Connection } from "../stream/connection";
import { Store } from "../store";

export interface SweepsState {
  parameters: readonly ParameterShown[];
  /** Runs at a time. */
  processes: number;
  /** The sweep that is shown: the newest one. */
  shown: Omit<SweepEvent, "rows" | "from"> | null;
  rows: readonly SweepRow[];
  problem: string;
}

/** Sweeps: many simulated runs of one controller. The server has one at a time. */
export class Sweeps {
  readonly store = new Store<SweepsState>({ parameters: [], processes: 1, shown: null, rows: [], problem: "" });

  constructor(
    private readonly api: Api,
    connection: Connection,
  ) {
    connection.on("sweep", (event) => void this.take(event));
    connection.on("hello", () => void this.again());
  }

  get active(): boolean {
    const state = this.store.get().shown?.state;
    return state === "building" || state === "running";
  }

  /** Asks for the parameters of the specification on disk, and for the newest sweep. */
  async refresh(): Promise<void> {
    try {
      const { parameters, processes, sweeps } = await this.api.sweeps();
      this.store.set({ parameters, processes, problem: "" });
      const newest = sweeps.at(-1);
      if (newest && !this.store.get().shown) await this.load(newest.sweep);
    } catch (error) {
      this.store.set({ problem: message(error) });
    }
  }

  /** After a lost connection, rows may be missing; after a restart, the server knows no sweep. */
  private async again(): Promise<void> {
    const { shown } = this.store.get();
    if (!shown) return;
    try {
      await this.load(shown.sweep);
    } catch {
      const state = this.active ? ("stopped" as const) : shown.state;
      this.store.set({ shown: { ...shown, state, why: this.active ? "the server was restarted" : shown.why } });
    }
  }

  private async load(sweep: string): Promise<void> {
    const { rows, ...shown } = await this.api.sweep(sweep);
    this.store.set({ rows, shown });
  }

  private async take({ rows, from, ...event }: SweepEvent): Promise<void> {
    const before = this.store.get();
    const isSame = before.shown?.sweep === event.sweep;
    if (isSame && from > before.rows.length) {
      // An event was lost.
      await this.load(event.sweep).catch((error: unknown) => this.store.set({ problem: message(error) }));
      return;
    }
    if (!isSame && from > 0) return void this.load(event.sweep).catch(() => undefined);
    const known = isSame ? before.rows.slice(0, from) : [];
    this.store.set({ shown: event, rows: rows.length === 0 && isSame ? before.rows : [...known, ...rows] });
  }

  /** Returns why the sweep does not start; empty: it does. */
  async start(request: SweepRequest): Promise<string> {
    try {
      await this.api.startSweep(request);
      this.store.set({ problem: "" });
      return "";
    } catch (error) {
      return message(error);
    }
  }

  async stop(): Promise<void> {
    const { shown } = this.store.get();
    if (!shown) return;
    try {
      await this.api.stopSweep(shown.sweep);
    } catch (error) {
      this.store.set({ problem: message(error) });
    }
  }
}
