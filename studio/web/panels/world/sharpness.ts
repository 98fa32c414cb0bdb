import { type Pace, wholeShare } from "../run/pace";

/** Parts of width and height: the picture is stretched to the canvas. Less than half would look bad. */
const steps = [1, 0.84, 0.71, 0.6, 0.5] as const;
/** A picture of fewer pixels would look bad, and its time goes to other things. */
const fewest = 125_000;
/** Milliseconds of a picture: with more, `Pace` lets the next frame of the page pass; with less, there is room. */
const most = 0.92 * wholeShare * (1000 / 60);
const room = 0.75 * most;
/** Milliseconds that a lower resolution must save. */
const worthwhile = 0.7;
/** If nothing has changed for so long although a picture could be drawn, nothing moves. */
const rest = 150;
/** A judgement is the median of so many pictures. */
const several = 7;
/** So many judgements must find room before the next sharper step; more, each time that it was none. */
const first = 4;
const longest = 64;

/**
 * How finely to draw where WebGL runs on the processor: as coarsely as it must be to keep up with the page while
 * something moves, and with every pixel when it stands. All times are those of performance.now().
 */
export class Sharpness {
  private step = 0;
  /** The last step that the canvas allows for. */
  private coarsest = steps.length - 1;
  /** When the next picture could have been drawn after the last one that showed a change. */
  private last = -Infinity;
  /** The picture under way shows a change. */
  private shows = false;
  private owns: number[] = [];
  private wholes: number[] = [];
  private roomy = 0;
  private patience = first;
  private wasRaised = false;

  /** The canvas has so many pixels. */
  fit(pixels: number): void {
    this.coarsest = Math.max(0, steps.filter((step) => pixels * step ** 2 >= fewest).length - 1);
    if (this.step > this.coarsest) this.to(this.coarsest, false);
  }

  /** The part of width and height of the canvas for a picture now. */
  scale(now: number): number {
    return this.isMoving(now) ? steps[this.step]! : 1;
  }

  /** Whether a picture of that scale can be drawn again with every pixel. */
  isBlurred(now: number, scale: number): boolean {
    return scale < 1 && !this.isMoving(now);
  }

  /** A picture is drawn because something has changed. */
  moved(now: number): void {
    this.last = now;
    this.shows = true;
  }

  /** A picture is done; own, whole, due: as in Pace. */
  drawn(scale: number, { own, whole, due }: Pace): void {
    if (this.shows) this.last = due;
    this.shows = false;
    if (scale !== steps[this.step]) return;
    this.owns.push(own);
    this.wholes.push(whole);
    if (this.wholes.length < several) return;
    this.judge(median(this.owns), median(this.wholes));
    this.owns = [];
    this.wholes = [];
  }

  private isMoving(now: number): boolean {
    return now - this.last < rest;
  }

  private judge(own: number, whole: number): void {
    const at = (step: number) => own + (whole - own) * (steps[step]! / steps[this.step]!) ** 2;
    if (whole > most && this.step < this.coarsest && whole - at(this.step + 1) > worthwhile) {
      if (this.wasRaised) this.patience = Math.min(longest, 2 * this.patience);
      this.to(this.step + 1, false);
      return;
    }
    this.roomy = this.step > 0 && at(this.step - 1) < room ? this.roomy + 1 : 0;
    if (this.roomy >= this.patience) this.to(this.step - 1, true);
  }

  private to(step: number, raised: boolean): void {
    this.step = step;
    this.roomy = 0;
    this.wasRaised = raised;
  }
}

const median = (list: number[]) => list.sort((a, b) => a - b)[list.length >> 1]!;
