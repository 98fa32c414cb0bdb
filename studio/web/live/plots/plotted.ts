import { beginOf, firstOf } from "../../model/plots/plotted_runs";
import { type Api, message } from "../api";
import type { Draft } from "../draft";
import type { Alignment, Plots } from "./plots";
import { Replay } from "../run/replay";
import type { Scene } from "../scene";
import { Store } from "../store";
import type { Track } from "../run/track";

/** A run whose curves are in the plot. */
export interface Source {
  /** "run", or the name of a recording. */
  name: string;
  track: Track;
  /** null: it goes on. */
  replay: Replay | null;
  /** Whether it is also shown in the drawing. */
  open: boolean;
  /** Added to its times, in nanoseconds. */
  shift: number;
  /** Something that the reader does not expect; empty: nothing. */
  remark: string;
}

/** Recordings that are read for the plots only. */
export class PlottedRecordings {
  readonly store = new Store<{ loaded: ReadonlyMap<string, Replay>; problem: string }>({ loaded: new Map(), problem: "" });
  private readonly asked = new Set<string>();

  constructor(
    private readonly api: Api,
    private readonly draft: Draft,
    private readonly scene: Scene,
    private readonly plots: Plots,
  ) {
    for (const told of [plots.store, scene.store, draft.store]) told.subscribe(() => this.look());
  }

  /** Reads what the plot wants and nobody shows; forgets what it does not want any more. */
  private look(): void {
    const { net } = this.draft.store.get();
    if (!net) return;
    const open = this.scene.store.get().panes.flatMap(({ replay }) => (replay ? [replay.name] : []));
    const wanted = this.plots.shown.recordings.filter((name) => !open.includes(name));
    const { loaded } = this.store.get();
    if ([...loaded.keys()].some((name) => !wanted.includes(name)))
      this.store.set({ loaded: new Map([...loaded].filter(([name]) => wanted.includes(name))) });
    // Only while something is shown: a plot that nobody sees reads no files.
    if (!this.scene.store.get().panes.some(({ track }) => track)) return;
    for (const name of wanted) if (!loaded.has(name) && !this.asked.has(name)) void this.load(name);
  }

  private async load(name: string): Promise<void> {
    const { net } = this.draft.store.get();
    this.asked.add(name);
    try {
      const recording = await this.api.recording(name);
      if (!net?.isNamed(recording.net_hash)) throw new Error(`${name} is of another net than the one in the text.`);
      const loaded = new Map(this.store.get().loaded).set(name, new Replay(name, net, recording));
      this.store.set({ loaded, problem: "" });
    } catch (error) {
      this.store.set({ problem: message(error) });
      this.plots.change({ recordings: this.plots.shown.recordings.filter((one) => one !== name) });
    } finally {
      this.asked.delete(name);
    }
  }

  /** The runs of the plot, each once: those that are drawn, and the recordings of the plot. */
  sources(): Source[] {
    const { panes } = this.scene.store.get();
    const { loaded } = this.store.get();
    const all: Source[] = panes.flatMap(({ track, replay }) =>
      track ? [{ name: replay?.name ?? "run", track, replay, open: true, shift: 0, remark: "" }] : [],
    );
    for (const name of this.plots.shown.recordings) {
      const replay = loaded.get(name);
      if (replay && !all.some((one) => one.name === name))
        all.push({ name, track: replay.track, replay, open: false, shift: 0, remark: partOf(replay) });
    }
    return aligned(all, this.plots.shown.alignment);
  }
}

const partOf = ({ track, last }: Replay) =>
  track.known < last ? `only its first ${(track.known / 1e9).toFixed(1)} s: it is too long to be read at once` : "";

/** Shifts all runs but the first, so that a common event is at the same time. */
function aligned(all: readonly Source[], alignment: Alignment): Source[] {
  const moment = ({ track }: Source): number | undefined =>
    alignment.by === "clock"
      ? 0
      : alignment.by === "begin"
        ? firstOf(track)
        : beginOf(track, alignment.path, alignment.behaviour);
  const lead = all[0] && moment(all[0]);
  return all.map((one) => {
    const own = moment(one);
    if (lead === undefined || own === undefined)
      return { ...one, remark: [one.remark, own === undefined ? "it lacks the common event" : ""].filter(Boolean).join("; ") };
    return { ...one, shift: lead - own };
  });
}
