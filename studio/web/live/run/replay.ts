import { fire, markingBefore, runningBehaviours } from "../../model/net/game";
import type { Scenes } from "../../model/run/film";
import type { NetModel } from "../../model/net/net";
import { count } from "../../model/sorted";
import type { FiringRow, PathRow, Recording } from "../../model/protocol";
import { noteNotices } from "./run_log";
import { Stage } from "../stage";
import { Store } from "../store";
import { Track } from "./track";

export interface ReplayState {
  /** Position in nanoseconds of the run's clock. */
  time: number;
  playing: boolean;
  speed: number;
  /** Whether the requested part of a long recording is on its way. */
  loading: boolean;
}

/** Loads a part of a recording from a time on, as much as is sent at once; null: it could not be loaded. */
export type Source = (from: number) => Promise<Recording | null>;

/** The number of firings between two stored markings; a jump replays at most that many. */
const stride = 4096;
/** Up to this number of firings, the way to a time is shown firing by firing. */
const near = 2000;

let made = 0;

/**
 * An open recording with its own stage and its own time. A long recording is loaded in parts, one at a time.
 */
export class Replay {
  readonly id = `recording ${(made += 1)}`;
  readonly stage = new Stage();
  readonly store: Store<ReplayState>;
  /** The first and the last time of the recording. */
  readonly first: number;
  readonly last: number;
  /** Whether the limit of the recording has dropped what was before `first`. */
  readonly lacksBeginning: boolean;
  /** Whether the end is missing. */
  readonly cut: boolean;
  private readonly path: readonly PathRow[];
  /** The track of the part that is loaded. */
  track!: Track;
  private firings!: readonly FiringRow[];
  private checkpoints!: Int32Array[];
  private begin!: number;
  private end!: number;
  private index = 0;
  private frame = 0;
  /** The requested time while its part is on its way. */
  private wanted: number | null = null;

  /** onPart: called when there is another track. */
  constructor(
    readonly name: string,
    private readonly net: NetModel,
    recording: Recording,
    private readonly source: Source = () => Promise.resolve(null),
    private readonly onPart: () => void = () => undefined,
  ) {
    this.first = recording.first ?? 0;
    this.last = recording.last ?? this.first;
    this.lacksBeginning = recording.lacks_beginning;
    this.cut = recording.cut;
    this.path = recording.path;
    this.take(recording, this.first);
    this.store = new Store<ReplayState>({ time: this.first, playing: false, speed: 1, loading: false });
    this.seek(this.first);
  }

  private take(part: Recording, from: number): void {
    this.firings = part.firings;
    this.begin = from;
    // The firings of the last instant of a part may be split between two parts.
    this.end = part.dropped ? Math.max(from, (part.firings.at(-1)?.[0] ?? from) - 1) : this.last;
    this.index = 0;
    this.stage.reset(this.net, "recording", part.marking);
    if (part.marking?.length === 0)
      this.stage.setMarking(
        markingBefore(
          this.net,
          this.firings.map(([, transition]) => transition),
        ),
      );
    this.prepare(this.stage.marking.slice());
    this.track = this.trackOf(part);
  }

  /** Whether the time is in the loaded part. */
  isHere(time: number): boolean {
    return time >= this.begin && time <= this.end;
  }

  /** Loads parts until the one with the requested time is here. */
  private async fetch(): Promise<void> {
    this.store.set({ loading: true });
    for (let tries = 0; !this.isHere(this.wanted!); tries += 1) {
      // Loads some firings before that time, too, unless there are so many that the part would not reach the
      // time itself.
      const before = tries === 0 ? (this.end - this.begin) / 4 : 0;
      const from = Math.max(this.first, Math.floor(this.wanted! - before));
      const part = await this.source(from);
      if (!part) break;
      const { floor, world, arrays } = this.track;
      this.take(part, from);
      Object.assign(this.track, { floor, world, arrays });
      this.onPart();
    }
    const time = Math.min(this.end, Math.max(this.begin, this.wanted!));
    this.wanted = null;
    this.store.set({ loading: false });
    this.seek(time);
  }

  private prepare(marking: Int32Array): void {
    this.checkpoints = [marking.slice()];
    this.firings.forEach(([, transition], at) => {
      fire(this.net, marking, transition);
      if ((at + 1) % stride === 0) this.checkpoints.push(marking.slice());
    });
  }

  private trackOf(recording: Recording): Track {
    const track = new Track(this.net, true);
    if (recording.marking) track.tell(this.begin, runningBehaviours(this.net, this.stage.marking));
    for (const row of recording.firings) track.fired(row);
    noteNotices(track.log, recording.notices);
    // Those of other parts are loaded when they are shown.
    track.firings = track.listed = recording.total;
    track.known = this.end;
    for (const [path, samples] of Object.entries(recording.values))
      for (const [time, value] of samples) track.series.add(time, path, value);
    track.arrived(recording.arrivals ?? {});
    track.pathUpTo(this.path);
    return track;
  }

  /** Shows the marking at a time, or at the nearest time in the recording. */
  seek(wanted: number): void {
    const time = Math.min(this.last, Math.max(this.first, wanted));
    if (this.wanted !== null || !this.isHere(time)) {
      const underWay = this.wanted !== null;
      this.wanted = time;
      this.store.set({ time });
      if (!underWay) void this.fetch();
      return;
    }
    const index = count(this.firings, ([t]) => t <= time);
    if (index >= this.index && index - this.index < near)
      for (; this.index < index; this.index += 1) this.stage.fired(this.firings[this.index]![1]);
    else this.jump(index);
    this.track.now = time;
    this.store.set({ time });
  }

  /** Follows the time of the other pane. */
  follow(time: number): void {
    if (Math.min(this.last, Math.max(this.first, time)) !== this.track.now) this.seek(time);
  }

  private markingAfter(index: number): Int32Array {
    const base = Math.floor(index / stride);
    const marking = this.checkpoints[base]!.slice();
    for (let at = base * stride; at < index; at += 1) fire(this.net, marking, this.firings[at]![1]);
    return marking;
  }

  private jump(index: number): void {
    const marking = this.markingAfter(index);
    const counts = new Uint32Array(this.net.transitions.length);
    for (let at = 0; at < index; at += 1) counts[this.firings[at]![1]]! += 1;
    this.stage.setMarking(marking);
    this.stage.setCounts(counts);
    this.index = index;
  }

  /** The first and the last time of the loaded part. */
  get loaded(): { from: number; to: number } {
    return { from: this.begin, to: this.end };
  }

  /** The firings between two times of the loaded part, at most so many. */
  scenes(from: number, to: number, most: number): Scenes {
    const first = count(this.firings, ([t]) => t < from);
    const firings = this.firings
      .slice(
        first,
        count(this.firings, ([t]) => t <= to),
      )
      .slice(0, most);
    return {
      title: this.name,
      from: this.markingAfter(first),
      firings: firings.map(([, transition]) => transition),
      times: firings.map(([time]) => time),
      begin: from,
    };
  }

  /** The last firing at the shown time among those of the loaded part, and those before; empty: there is none. */
  fired(most: number): readonly FiringRow[] {
    return this.firings.slice(Math.max(0, this.index - most), this.index);
  }

  /** Goes to the next or the previous time at which a transition fired. */
  step(by: 1 | -1): void {
    const here = this.firings[this.index - 1]?.[0] ?? this.first;
    const at = by === 1 ? this.index : count(this.firings, ([t]) => t < here) - 1;
    const beyond = by === 1 ? this.end + 1 : this.begin - 1;
    this.seek(this.firings[at]?.[0] ?? beyond);
  }

  play(playing: boolean): void {
    cancelAnimationFrame(this.frame);
    this.store.set({ playing });
    if (!playing) return;
    if (this.store.get().time >= this.last) this.seek(this.first);
    let before = performance.now();
    const tick = (now: number) => {
      const { time, speed, loading } = this.store.get();
      if (loading) before = now;
      else this.seek(time + (now - before) * 1e6 * speed);
      before = now;
      if (this.store.get().time >= this.last) this.store.set({ playing: false });
      else this.frame = requestAnimationFrame(tick);
    };
    this.frame = requestAnimationFrame(tick);
  }
}
