import type { Positions } from "../model/structure/moved_boxes";
import { differing, joined, withChange, type BoxChange } from "../model/structure/box_changes";
import { ApiError, message, type Api } from "./api";
import type { Draft } from "./draft";
import { Store } from "./store";

export interface LayoutState {
  /** The boxes that were moved by hand. */
  boxes: Positions;
  /** Why the file on disk is not understood; empty: it is. It stays as it is, until the user replaces it. */
  problem: string;
}

const file = ".tessera-layout.json";

/**
 * The positions of boxes that the user has moved. They are written at once, beside the specification. If another tab or
 * program moves boxes meanwhile, both count; of one box, the last move does.
 */
export class LayoutFile {
  readonly store = new Store<LayoutState>({ boxes: {}, problem: "" });
  /** The boxes on disk as far as known, and the revision of that file. */
  private onDisk: Positions = {};
  private revision = "";
  /** Reads and writes of the file, one after the other: an answer that is late would undo a move. */
  private queue: Promise<void> = Promise.resolve();
  /** The boxes that this tab has moved, and nobody else since. */
  private readonly mine = new Set<string>();

  constructor(
    private readonly api: Api,
    private readonly draft: Draft,
  ) {
    draft.takeBoxes = (change) => this.take(change);
  }

  /** Reads the file, and joins it with the moves of this tab that are not written yet. */
  load(): Promise<void> {
    return (this.queue = this.queue.then(() => this.read()));
  }

  private async read(): Promise<void> {
    try {
      const { boxes: read, revision, error } = await this.api.layout();
      const theirs = read as Positions;
      const mine = this.store.get().boxes;
      const boxes = joined(this.onDisk, mine, theirs);
      const both = differing(this.onDisk, theirs).filter((path) => this.mine.has(path));
      this.store.set({ boxes, problem: error ?? "" });
      this.onDisk = theirs;
      this.revision = revision;
      this.tell(both, mine, boxes);
    } catch (error) {
      this.store.set({ problem: message(error) });
    }
  }

  /** Says that someone else has moved boxes, too, which this tab had moved. Undo leads to the places of this tab. */
  private tell(both: readonly string[], mine: Positions, now: Positions): void {
    if (both.length === 0) return;
    const names = both.length > 3 ? `${both.length} boxes` : both.join(", ");
    const left = differing(mine, now).filter((path) => both.includes(path));
    const others = `Another tab or program has moved ${names}`;
    if (left.length === 0) return this.draft.store.set({ notice: `${others} at the same time: this tab was later` });
    for (const path of left) this.mine.delete(path);
    const places = (boxes: Positions) => Object.fromEntries(left.map((path) => [path, boxes[path] ?? null]));
    const undoes = !this.draft.store.get().canRedo;
    if (undoes) this.draft.boxesMoved({ before: places(mine), after: places(now) }, "moved elsewhere");
    this.draft.store.set({ notice: undoes ? `${others}. Undo puts back what this tab had` : others });
  }

  /** The file changed on disk. */
  changedOnDisk(revision: string): Promise<void> {
    return (this.queue = this.queue.then(() => (revision !== this.revision ? this.read() : undefined)));
  }

  /** Moves boxes; undo takes it back. kind: moves of the same kind that follow each other quickly are one step. */
  move(change: BoxChange, kind: string): void {
    this.draft.boxesMoved(change, kind);
    this.take(change);
  }

  /** All boxes are where the layout puts them. */
  arrange(): void {
    const { boxes } = this.store.get();
    const nothing = Object.fromEntries(Object.keys(boxes).map((path) => [path, null]));
    this.move({ before: { ...boxes }, after: nothing }, "arrange");
  }

  /** Elements have new paths. */
  renamed(path: (before: string) => string): void {
    const { boxes } = this.store.get();
    const changed = Object.entries(boxes).filter(([old]) => path(old) !== old);
    if (changed.length === 0) return;
    const change: BoxChange = { before: {}, after: {} };
    for (const [old, at] of changed) {
      change.before[old] = at;
      change.after[old] = null;
    }
    for (const [old, at] of changed) {
      change.before[path(old)] ??= null;
      change.after[path(old)] = at;
    }
    this.draft.boxesRenamed(change);
    this.take(change);
  }

  /** Replaces a file that is not understood. */
  replace(): void {
    this.store.set({ problem: "" });
    this.write(true);
  }

  private take(change: BoxChange): void {
    for (const path of Object.keys(change.after)) this.mine.add(path);
    this.store.set({ boxes: withChange(this.store.get().boxes, change) });
    this.write(false);
  }

  private write(anyway: boolean): void {
    this.queue = this.queue.then(() => this.writeNow(anyway));
  }

  private async writeNow(anyway: boolean): Promise<void> {
    for (let attempt = 0; attempt < 5; attempt += 1) {
      const { boxes, problem } = this.store.get();
      if (problem) return;
      if (!anyway && JSON.stringify(boxes) === JSON.stringify(this.onDisk)) return;
      try {
        const { revision } = await this.api.saveLayout(boxes, this.revision);
        this.onDisk = boxes;
        this.revision = revision;
        return;
      } catch (error) {
        if (!(error instanceof ApiError) || error.status !== 409) {
          this.draft.store.set({ notice: `The moved boxes are not kept in ${file}: ${message(error)}` });
          return;
        }
        await this.read();
      }
    }
  }
}
