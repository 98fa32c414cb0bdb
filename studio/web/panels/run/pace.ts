/** The largest part of the time of the page that drawing may take. */
const ownShare = 1 / 3;
/** The largest part of the time in which a picture may be under way, in this process or in the one that draws. */
export const wholeShare = 1 / 2;

/**
 * When the next picture may be drawn. If WebGL runs on the processor, it takes time from everything else:
 * after a picture, the view rests in proportion. All times are those of performance.now().
 */
export class Pace {
  /** Milliseconds of the last picture: in the page, and until it was drawn. */
  own = 0;
  whole = 0;
  private begun = 0;
  /** When the next picture may be drawn. */
  due = 0;

  isDue(now: number): boolean {
    return now >= this.due;
  }

  begin(now: number): void {
    this.begun = now;
    this.due = Infinity;
  }

  /** The work of the page is done; another process draws the picture. */
  ordered(now: number): void {
    this.own = now - this.begun;
  }

  drawn(now: number): void {
    this.whole = now - this.begun;
    this.due = this.begun + Math.max(this.own / ownShare, this.whole / wholeShare);
  }
}
