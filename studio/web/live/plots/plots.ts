import { isSame, signalOf, type Signal } from "../../model/plots/signals";
import { Store } from "../store";

/** The time at which several runs lie above each other. */
export type Alignment =
  /** Zero of their clocks. */
  | { by: "clock" }
  /** Their first firings. */
  | { by: "begin" }
  /** The first time that a subsystem begins a behaviour. */
  | { by: "behaviour"; path: string; behaviour: string };

/** One plot of the user. */
export interface PlotKept {
  title: string;
  signals: readonly Signal[];
  /** Names of signals and runs that the legend has switched off. */
  hidden: readonly string[];
  /** Recordings beside those that are open. */
  recordings: readonly string[];
  alignment: Alignment;
}

export interface PlotsState {
  plots: readonly PlotKept[];
  /** The one that is shown. */
  active: number;
  /** The browser refuses to keep more; empty: it keeps all. */
  problem: string;
}

const empty = (title: string): PlotKept => ({ title, signals: [], hidden: [], recordings: [], alignment: { by: "clock" } });
const fresh: PlotsState = { plots: [empty("Plot 1")], active: 0, problem: "" };

const texts = (given: unknown): string[] => (Array.isArray(given) ? given.filter((one) => typeof one === "string") : []);

function alignmentOf(given: unknown): Alignment {
  const { by, path, behaviour } = (given ?? {}) as Record<string, unknown>;
  if (by === "behaviour" && typeof path === "string" && typeof behaviour === "string") return { by, path, behaviour };
  return by === "begin" ? { by } : { by: "clock" };
}

/** The plots that were kept, as far as they can be read. */
export function plotsOf(text: string | null): PlotsState {
  let given: unknown;
  try {
    given = JSON.parse(text ?? "null");
  } catch {
    return fresh;
  }
  const { plots, active } = (given ?? {}) as { plots?: unknown; active?: unknown };
  if (!Array.isArray(plots) || plots.length === 0) return fresh;
  const read = plots.map((one: unknown, at): PlotKept => {
    const { title, signals, hidden, recordings, alignment } = (one ?? {}) as Record<string, unknown>;
    return {
      title: typeof title === "string" && title !== "" ? title : `Plot ${at + 1}`,
      signals: Array.isArray(signals) ? signals.flatMap((each) => signalOf(each) ?? []) : [],
      hidden: texts(hidden),
      recordings: texts(recordings),
      alignment: alignmentOf(alignment),
    };
  });
  return { plots: read, active: typeof active === "number" && read[active] ? active : 0, problem: "" };
}

/** The plots of the project. They are kept for the user. */
export class Plots {
  readonly store = new Store<PlotsState>(fresh);
  private key = "";

  constructor(private readonly storage: Pick<Storage, "getItem" | "setItem"> = localStorage) {}

  /** project: its folder and file. */
  restore(project: string): void {
    this.key = `tessera.plots:${project}`;
    this.store.set(plotsOf(this.storage.getItem(this.key)));
  }

  get shown(): PlotKept {
    const { plots, active } = this.store.get();
    return plots[active]!;
  }

  has(signal: Signal): boolean {
    return this.shown.signals.some((one) => isSame(one, signal));
  }

  add(signal: Signal): void {
    if (!this.has(signal)) this.change({ signals: [...this.shown.signals, signal] });
  }

  remove(signal: Signal): void {
    this.change({ signals: this.shown.signals.filter((one) => !isSame(one, signal)) });
  }

  toggle(signal: Signal): void {
    if (this.has(signal)) this.remove(signal);
    else this.add(signal);
  }

  /** Shows or hides a curve by the name that the legend gives it. */
  toggleHidden(name: string): void {
    const { hidden } = this.shown;
    this.change({ hidden: hidden.includes(name) ? hidden.filter((one) => one !== name) : [...hidden, name] });
  }

  change(change: Partial<PlotKept>): void {
    const { plots, active } = this.store.get();
    this.keep({ plots: plots.map((one, at) => (at === active ? { ...one, ...change } : one)), active });
  }

  show(active: number): void {
    this.keep({ plots: this.store.get().plots, active });
  }

  /** A further, empty plot. */
  open(): void {
    const { plots } = this.store.get();
    let number = plots.length + 1;
    while (plots.some(({ title }) => title === `Plot ${number}`)) number += 1;
    this.keep({ plots: [...plots, empty(`Plot ${number}`)], active: plots.length });
  }

  /** Removes the shown plot; the last one becomes empty. */
  close(): void {
    const { plots, active } = this.store.get();
    const rest = plots.filter((_, at) => at !== active);
    this.keep(rest.length === 0 ? { plots: fresh.plots, active: 0 } : { plots: rest, active: Math.max(0, active - 1) });
  }

  private keep(next: Pick<PlotsState, "plots" | "active">): void {
    let problem = "";
    try {
      if (this.key) this.storage.setItem(this.key, JSON.stringify(next));
    } catch {
      problem = "This browser does not keep the plots: its storage is full or switched off.";
    }
    this.store.set({ ...next, problem });
  }
}
