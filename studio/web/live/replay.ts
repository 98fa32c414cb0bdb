import { fire, markingBefore, runningBehaviours } from "../model/game";
import type { NetModel } from "../model/net";
import { count } from "../model/sorted";
import type { FiringRow, Recording } from "./protocol";
import { Stage } from "./stage";
import { Store } from "./store";
import { Track } from "./track";

export interface ReplayState {
  /** Position in nanoseconds of the run's clock. */
  time: number;
  playing: boolean;
  speed: number;
}

/** A marking is kept every so many firings: a jump replays no more than that. */
const stride = 4096;
/** A firing as the recording has it, shown one by one when the way to it is no longer than this. */
const near = 2000;

let made = 0;

/** One recording that is looked at: its own stage, and its own moment. */
export class Replay {
  readonly id = `recording ${(made += 1)}`;
  readonly stage = new Stage();
  readonly track: Track;
  readonly store: Store<ReplayState>;
  /** The ends of the recording. */
  readonly first: number;
  readonly last: number;
  private readonly firings: readonly FiringRow[];
  private readonly checkpoints: Int32Array[] = [];
  private index = 0;
  private frame = 0;

  constructor(
    readonly name: string,
    private readonly net: NetModel,
    recording: Recording,
  ) {
    this.firings = recording.firings;
    this.first = this.firings[0]?.[0] ?? 0;
    this.last = this.firings.at(-1)?.[0] ?? this.first;
    this.stage.reset(net, "recording", recording.marking);
    if (recording.marking?.length === 0)
      this.stage.setMarking(
        markingBefore(
          net,
          this.firings.map(([, transition]) => transition),
        ),
      );
    this.prepare(this.stage.marking.slice());
    this.track = this.trackOf(recording);
    this.store = new Store<ReplayState>({ time: this.first, playing: false, speed: 1 });
    this.seek(this.first);
  }

  private prepare(marking: Int32Array): void {
    this.checkpoints.push(marking.slice());
    this.firings.forEach(([, transition], at) => {
      fire(this.net, marking, transition);
      if ((at + 1) % stride === 0) this.checkpoints.push(marking.slice());
    });
  }

  private trackOf(recording: Recording): Track {
    const track = new Track(this.net, true);
    if (recording.marking) track.timeline.tell(this.first, runningBehaviours(this.net, this.stage.marking));
    for (const [time, transition] of recording.firings) track.timeline.add(time, transition);
    track.firings = recording.firings.length;
    track.known = this.last;
    for (const [path, samples] of Object.entries(recording.values ?? {}))
      for (const [time, value] of samples) track.series.add(time, path, value);
    track.pathUpTo(recording.path ?? []);
    return track;
  }

  /** Shows the marking at a time, as near to it as the recording goes. */
  seek(wanted: number): void {
    const time = Math.min(this.last, Math.max(this.first, wanted));
    const index = count(this.firings, ([t]) => t <= time);
    if (index >= this.index && index - this.index < near)
      for (; this.index < index; this.index += 1) this.stage.fired(this.firings[this.index]![1]);
    else this.jump(index);
    this.track.now = time;
    this.store.set({ time });
  }

  /** The moment of what is shown beside it. */
  follow(time: number): void {
    if (Math.min(this.last, Math.max(this.first, time)) !== this.track.now) this.seek(time);
  }

  private jump(index: number): void {
    const base = Math.floor(index / stride);
    const marking = this.checkpoints[base]!.slice();
    for (let at = base * stride; at < index; at += 1) fire(this.net, marking, this.firings[at]![1]);
    const counts = new Uint32Array(this.net.transitions.length);
    for (let at = 0; at < index; at += 1) counts[this.firings[at]![1]]! += 1;
    this.stage.setMarking(marking);
    this.stage.setCounts(counts);
    this.index = index;
  }

  /** To the next or the last moment at which something fired. */
  step(by: 1 | -1): void {
    const here = this.firings[this.index - 1]?.[0] ?? this.first;
    const at = by === 1 ? this.index : count(this.firings, ([t]) => t < here) - 1;
    this.seek(this.firings[at]?.[0] ?? (by === 1 ? this.last : this.first));
  }

  play(playing: boolean): void {
    cancelAnimationFrame(this.frame);
    this.store.set({ playing });
    if (!playing) return;
    if (this.store.get().time >= this.last) this.seek(this.first);
    let before = performance.now();
    const tick = (now: number) => {
      const { time, speed } = this.store.get();
      this.seek(time + (now - before) * 1e6 * speed);
      before = now;
      if (this.store.get().time >= this.last) this.store.set({ playing: false });
      else this.frame = requestAnimationFrame(tick);
    };
    this.frame = requestAnimationFrame(tick);
  }
}
