import type { NetModel } from "../model/net/net";
import { type Api, ApiError, message } from "./api";
import { RecordedArrays } from "./arrays";
import type { Draft } from "./draft";
import type { Notes, NotesRequest, Recording, RecordingInfo } from "../model/protocol";
import { Replay } from "./run/replay";
import { Store } from "./store";
import { RecordedWorld } from "./world";

export interface RecordingsState {
  list: readonly RecordingInfo[];
  /** The open recordings, from left to right. */
  open: readonly Replay[];
  problem: string;
}

/** The recordings of runs, and those that are open. */
export class Recordings {
  readonly store = new Store<RecordingsState>({ list: [], open: [], problem: "" });

  constructor(
    private readonly api: Api,
    private readonly draft: Draft,
  ) {}

  async refresh(): Promise<void> {
    try {
      this.store.set({ list: await this.api.recordings(), problem: "" });
    } catch (error) {
      this.store.set({ problem: message(error) });
    }
  }

  /** Keeps what the user says about a recording. Returns why it is not kept; empty: it is. */
  async saveNotes(name: string, notes: NotesRequest): Promise<string> {
    const put = (now: Notes | null) =>
      this.store.set({ list: this.store.get().list.map((one) => (one.name === name ? { ...one, notes: now } : one)) });
    try {
      put((await this.api.saveNotes(name, notes)).notes);
      return "";
    } catch (error) {
      // The text that somebody else has written is the base of the next try.
      if (error instanceof ApiError && error.status === 409) put((error.body.notes ?? null) as Notes | null);
      return message(error);
    }
  }

  /** Opens a recording beside the first `keep` open ones, in place of the others. */
  async open(name: string, keep = 0): Promise<void> {
    const { net } = this.draft.store.get();
    if (!net) return;
    try {
      const recording = await this.part(name, net);
      const source = (from: number) =>
        this.part(name, net, from).catch((error: unknown) => {
          this.store.set({ problem: message(error) });
          return null;
        });
      const replay = new Replay(name, net, recording, source, () => this.store.set({ open: [...this.store.get().open] }));
      if (recording.scene) replay.track.world = new RecordedWorld(recording.scene, (from, to) => this.api.poses(name, from, to));
      replay.track.arrays = new RecordedArrays((from, to) => this.api.arrays(name, from, to));
      this.keep(keep);
      this.store.set({ open: [...this.store.get().open, replay], problem: "" });
      if (replay.track.path.length > 0) replay.track.floor = await this.api.floor(recording.track);
    } catch (error) {
      this.store.set({ problem: message(error) });
    }
  }

  private async part(name: string, net: NetModel, from?: number): Promise<Recording> {
    const part = await this.api.recording(name, from);
    if (!isOf(part, net)) throw new Error("This recording is of another net than the one in the text.");
    return part;
  }

  /** Closes all but the first ones. */
  keep(most: number): void {
    for (const replay of this.store.get().open.slice(most)) this.close(replay);
  }

  close(replay: Replay): void {
    replay.play(false);
    this.store.set({ open: this.store.get().open.filter((one) => one !== replay) });
  }
}

const isOf = (recording: Recording, net: NetModel) =>
  net.isNamed(recording.net_hash) && recording.firings.every(([, transition]) => transition < net.transitions.length);
