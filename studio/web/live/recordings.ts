import { fire, initialMarking } from "../model/game";
import type { NetModel } from "../model/net";
import type { Api } from "./api";
import { message, type Draft } from "./draft";
import type { FiringRow, RecordingInfo } from "./protocol";
import { Track } from "./runner";
import type { Stage } from "./stage";
import { Store } from "./store";

export interface RecordingsState {
  list: readonly RecordingInfo[];
  open: string | null;
  problem: string;
  /** Position in nanoseconds, and the ends of the recording. */
  time: number;
  first: number;
  last: number;
  playing: boolean;
  speed: number;
}

/** A marking is kept every so many firings: a jump replays no more than that. */
const stride = 4096;

/** Recordings, played on the same drawing as live runs. */
export class Recordings {
  readonly store = new Store<RecordingsState>({
    list: [],
    open: null,
    problem: "",
    time: 0,
    first: 0,
    last: 0,
    playing: false,
    speed: 1,
  });
  track: Track | null = null;
  private net: NetModel | null = null;
  private firings: readonly FiringRow[] = [];
  private checkpoints: Int32Array[] = [];
  private index = 0;
  private frame = 0;

  constructor(
    private readonly api: Api,
    private readonly draft: Draft,
    private readonly stage: Stage,
  ) {}

  async refresh(): Promise<void> {
    try {
      this.store.set({ list: await this.api.recordings(), problem: "" });
    } catch (error) {
      this.store.set({ problem: message(error) });
    }
  }

  async open(name: string): Promise<void> {
    const { net } = this.draft.store.get();
    if (!net) return;
    try {
      const recording = await this.api.recording(name);
      const known = net.transitions.length;
      if (recording.firings.some(([, transition]) => transition >= known))
        throw new Error("This recording is of another net than the one in the text.");
      this.net = net;
      this.firings = recording.firings;
      this.track = new Track(net);
      for (const [time, transition] of recording.firings) this.track.timeline.add(time, transition);
      this.track.firings = recording.firings.length;
      this.track.knownUntil(recording.firings.at(-1)?.[0] ?? 0);
      for (const [path, samples] of Object.entries(recording.values ?? {}))
        for (const [time, value] of samples) this.track.series.add(time, path, value);
      this.prepare(net);
      const first = recording.firings[0]?.[0] ?? 0;
      this.stage.reset(net, "recording");
      this.store.set({
        open: name,
        problem: recording.truncated ? `Only the first ${recording.firings.length.toLocaleString("en")} firings are shown.` : "",
        first,
        last: recording.firings.at(-1)?.[0] ?? first,
        playing: false,
      });
      this.seek(first);
    } catch (error) {
      this.store.set({ problem: message(error) });
    }
  }

  private prepare(net: NetModel): void {
    const marking = initialMarking(net);
    this.checkpoints = [marking.slice()];
    this.firings.forEach(([, transition], at) => {
      fire(net, marking, transition);
      if ((at + 1) % stride === 0) this.checkpoints.push(marking.slice());
    });
  }

  /** Shows the marking at a time. */
  seek(time: number): void {
    const { net, firings } = this;
    if (!net) return;
    const index = upTo(firings, time);
    const near = index >= this.index && index - this.index < 2000;
    if (near) for (; this.index < index; this.index += 1) this.stage.fired(firings[this.index]![1]);
    else {
      const base = Math.floor(index / stride);
      const marking = this.checkpoints[base]!.slice();
      for (let at = base * stride; at < index; at += 1) fire(net, marking, firings[at]![1]);
      this.stage.setMarking(marking);
      this.index = index;
    }
    if (this.track) this.track.now = time;
    this.store.set({ time });
  }

  /** To the next or the last firing. */
  step(by: 1 | -1): void {
    const at = by === 1 ? this.index : this.index - 2;
    this.seek(this.firings[at]?.[0] ?? this.store.get().first);
  }

  play(playing: boolean): void {
    cancelAnimationFrame(this.frame);
    this.store.set({ playing });
    if (!playing) return;
    let before = performance.now();
    const tick = (now: number) => {
      const { time, last, speed } = this.store.get();
      const next = Math.min(last, time + (now - before) * 1e6 * speed);
      before = now;
      this.seek(next);
      if (next >= last) this.store.set({ playing: false });
      else this.frame = requestAnimationFrame(tick);
    };
    this.frame = requestAnimationFrame(tick);
  }

  setSpeed(speed: number): void {
    this.store.set({ speed });
  }

  close(): void {
    this.play(false);
    this.track = this.net = null;
    this.store.set({ open: null });
    const { net } = this.draft.store.get();
    if (net) this.stage.reset(net, "edit");
  }
}

/** How many firings happened up to a time. */
function upTo(firings: readonly FiringRow[], time: number): number {
  let [low, high] = [0, firings.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (firings[middle]![0] <= time) low = middle + 1;
    else high = middle;
  }
  return low;
}
