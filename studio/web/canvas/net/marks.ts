import type { Stage } from "../../live/stage";
import { isActive } from "../../model/net/game";
import type { NetModel } from "../../model/net/net";
import type { Breakpoint } from "../../model/protocol";

/** The classes that the state of a stage gives to the drawn elements. */
export const marksOf = {
  place: ["unreached", "breakpoint"],
  transition: ["enabled", "fired", "breakpoint", "unreached", "one-sided"],
  page: ["occupied", "unreached", "differs"],
} as const;

/** How long a firing is visible, in milliseconds. */
const afterglow = 350;

/** The state of a stage as it is drawn: the classes of elements, and the texts that change. */
export class Marks {
  private readonly stops = { places: new Set<number>(), transitions: new Set<number>() };
  private readonly now = performance.now();
  /** Whether the stage shows this net at all. */
  private readonly mine: boolean;
  private readonly playing: boolean;

  constructor(
    private readonly net: NetModel,
    private readonly stage: Stage,
    breakpoints: readonly Breakpoint[],
  ) {
    this.mine = stage.is(net);
    this.playing = this.mine && stage.mode !== "edit";
    for (const one of breakpoints)
      if ("place" in one) this.stops.places.add(one.place);
      else this.stops.transitions.add("transition" in one ? one.transition : one.condition);
  }

  tokens(place: number): number {
    return this.mine ? (this.stage.marking[place] ?? 0) : (this.net.places.at(place)?.tokens ?? 0);
  }

  place(index: number): string {
    return words(
      this.mine && (this.stage.unreached?.places.has(index) ?? false) && "unreached",
      this.stops.places.has(index) && "breakpoint",
    );
  }

  transition(index: number): string {
    const { stage, net, mine } = this;
    const isUnreached = mine && (stage.unreached?.transitions.has(index) ?? false);
    return words(
      mine && stage.mode === "game" && isActive(net, stage.marking, index) && "enabled",
      this.playing && this.now - stage.firedAt[index]! < afterglow && "fired",
      this.stops.transitions.has(index) && "breakpoint",
      isUnreached && "unreached",
      mine && !isUnreached && (stage.unreached?.oneSided.has(index) ?? false) && "one-sided",
    );
  }

  page(index: number): string {
    const { stage, mine } = this;
    const { layer, path } = this.net.page(index);
    return words(
      this.playing && layer !== "system" && stage.occupied[index] === 1 && "occupied",
      mine && (stage.unreached?.pages.has(path) ?? false) && "unreached",
      mine && layer === "subsystem" && stage.differing.has(path) && "differs",
    );
  }

  /** Whether a token is somewhere on the sheet of the page. */
  runs(page: number): boolean {
    return this.playing && this.stage.occupied[page] === 1;
  }

  /** The text beside a transition: how often it has fired. */
  firings(transition: number): string {
    const count = this.playing ? this.stage.counts[transition]! : 0;
    return count > 0 ? `${this.stage.sampled ? "≥" : "×"}${short(count)}` : "";
  }

  /** The text on the page of a subsystem: the behaviour that it runs. */
  running(page: number): string {
    if (!this.playing) return "";
    const { layer, subsystem } = this.net.page(page);
    const name = layer === "subsystem" && subsystem !== null ? this.stage.running(this.net).get(subsystem) : undefined;
    return name ? `▸ ${name}` : "";
  }
}

const words = (...all: (string | false)[]) => all.filter(Boolean).join(" ");

/** 999, 12k, 3.4M */
export function short(count: number): string {
  if (count < 1000) return String(count);
  if (count < 1e6) return `${(count / 1000).toFixed(count < 1e4 ? 1 : 0)}k`;
  return `${(count / 1e6).toFixed(1)}M`;
}
