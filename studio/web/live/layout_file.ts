import type { Positions } from "../model/structure/moved_boxes";
import { joined, withChange, type BoxChange } from "../model/structure/box_changes";
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
  private writing: Promise<void> = Promise.resolve();

  constructor(
    private readonly api: Api,
    private readonly draft: Draft,
  ) {
    draft.takeBoxes = (change) => this.take(change);
  }

  /** Reads the file, and joins it with the moves of this tab that are not written yet. */
  async load(): Promise<void> {
    try {
      const { boxes, revision, error } = await this.api.layout();
      const theirs = boxes as Positions;
      const mine = this.store.get().boxes;
      this.store.set({ boxes: joined(this.onDisk, mine, theirs), problem: error ?? "" });
      this.onDisk = theirs;
      this.revision = revision;
    } catch (error) {
      this.store.set({ problem: message(error) });
    }
  }

  /** The file changed on disk. */
  async changedOnDisk(revision: string): Promise<void> {
    await this.writing;
    if (revision !== this.revision) await this.load();
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
    this.store.set({ boxes: withChange(this.store.get().boxes, change) });
    this.write(false);
  }

  private write(anyway: boolean): void {
    this.writing = this.writing.then(() => this.writeNow(anyway));
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
        await this.load();
      }
    }
  }
}
