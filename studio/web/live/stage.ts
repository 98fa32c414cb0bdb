import { fire, initialMarking, isEnabled, runningBehaviours, type Marking } from "../model/net/game";
import type { NetModel } from "../model/net/net";
import type { Coverage } from "../model/protocol";
import { Store } from "./store";

export type StageMode = "edit" | "game" | "trace" | "live" | "recording";

/** The elements that a run has never reached, by the numbers of the net; pages by their paths. */
export interface Unreached {
  places: ReadonlySet<number>;
  transitions: ReadonlySet<number>;
  /** Transitions that have fired, but whose condition was never false. */
  oneSided: ReadonlySet<number>;
  pages: ReadonlySet<string>;
}

/** Milliseconds between two pictures. */
const pause = 30;

/**
 * The content of one pane: the marking, and the last firings. The edited net and the games on it have one
 * stage; the live run and each recording have their own. Listeners are called at most thirty times a second,
 * however many events arrive: more is not visible, and the time is needed for drawing.
 */
export class Stage {
  mode: StageMode = "edit";
  marking: Marking = new Int32Array();
  /** For each transition, the number of its firings, and the time of the last (performance.now). */
  counts = new Uint32Array();
  /** Some firings are not reported one by one: the counts are lower bounds. */
  sampled = false;
  firedAt = new Float64Array();
  /** Per page, whether a token is somewhere inside. */
  occupied = new Uint8Array();
  /** Paths of the subsystems that run another behaviour in the other pane. */
  differing: ReadonlySet<string> = new Set();
  /** Shaded on the drawing; null: no shade. */
  unreached: Unreached | null = null;
  /** The net that is shown, and its mode. */
  readonly shown = new Store<{ net: NetModel | null; mode: StageMode }>({ net: null, mode: "edit" });
  private net: NetModel | null = null;
  private readonly listeners = new Set<() => void>();
  private frame = 0;
  private told = -Infinity;
  /** The behaviours that run in the present marking, once somebody has asked. */
  private now: ReadonlyMap<number, string> | null = null;

  /** Shows a net with its initial marking, or with a token in each of the places. */
  reset(net: NetModel, mode: StageMode, marked?: readonly number[] | null): void {
    if (net !== this.net) this.unreached = null;
    this.net = net;
    this.mode = mode;
    this.marking = initialMarking(net);
    this.counts = new Uint32Array(net.transitions.length);
    this.sampled = false;
    this.firedAt = new Float64Array(net.transitions.length).fill(-Infinity);
    this.shown.set({ net, mode });
    if (marked) this.setMarked(marked);
    this.touch();
  }

  is(net: NetModel): boolean {
    return this.net === net;
  }

  /** The behaviour that each subsystem runs. A look at a large marking takes long, so it is shared by all who ask. */
  running(net: NetModel): ReadonlyMap<number, string> {
    return (this.now ??= runningBehaviours(net, this.marking));
  }

  setMarking(marking: Marking): void {
    this.marking.set(marking);
    this.touch();
  }

  /** The places that hold one token each; all others are empty. */
  setMarked(places: readonly number[]): void {
    this.marking.fill(0);
    for (const place of places) if (place < this.marking.length) this.marking[place] = 1;
    this.touch();
  }

  setCounts(counts: Uint32Array): void {
    this.counts.set(counts);
    this.touch();
  }

  /**
   * Counts and shows a firing. It also moves the tokens, unless the marking will be reported separately.
   */
  fired(transition: number, move = true): void {
    if (!this.net || transition >= this.counts.length) return;
    if (move && isEnabled(this.net, this.marking, transition)) fire(this.net, this.marking, transition);
    this.counts[transition]! += 1;
    this.firedAt[transition] = performance.now();
    this.touch();
  }

  differ(paths: ReadonlySet<string>): void {
    if (paths.size === this.differing.size && [...paths].every((path) => this.differing.has(path))) return;
    this.differing = paths;
    this.touch();
  }

  shade(missing: Coverage["missing"] | null): void {
    this.unreached = missing && {
      places: new Set(missing.places),
      transitions: new Set(missing.transitions),
      oneSided: new Set(missing.never_false),
      pages: new Set(missing.behaviours),
    };
    this.touch();
  }

  subscribe = (listener: () => void): (() => void) => {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  };

  private touch(): void {
    this.now = null;
    if (!this.frame) this.frame = requestAnimationFrame(this.tell);
  }

  private tell = (now: number): void => {
    if (now - this.told < pause) {
      this.frame = requestAnimationFrame(this.tell);
      return;
    }
    this.told = now;
    this.frame = 0;
    this.occupy();
    this.listeners.forEach((listener) => listener());
  };

  private occupy(): void {
    const { net } = this;
    if (!net || this.mode === "edit") return;
    const occupied = (this.occupied = new Uint8Array(net.pages.length));
    this.marking.forEach((tokens, place) => {
      if (tokens === 0) return;
      for (let page = net.places.at(place)!.page; page !== null && occupied[page] === 0; page = net.page(page).parent)
        occupied[page] = 1;
    });
  }
}
