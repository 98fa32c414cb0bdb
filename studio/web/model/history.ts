import { both, reversed, type BoxChange } from "./structure/box_changes";

/** The change of a file beside the text by an action. */
export interface FileStep {
  file: string;
  before: string;
  after: string;
}

/** A text, and the change of files that leads to it from the step before. */
interface Step {
  text: string;
  files: readonly FileStep[];
  /** The boxes of the drawing that it moves or renames. */
  boxes?: BoxChange;
}

/** Undo and redo of a text. Changes of one kind that follow each other quickly are one step. */
export class History {
  private readonly past: Step[] = [];
  private readonly future: Step[] = [];
  private lastKind = "";
  private lastTime = -Infinity;
  private now: Step;

  constructor(text: string) {
    this.now = { text, files: [] };
  }

  get current(): string {
    return this.now.text;
  }
  get canUndo(): boolean {
    return this.past.length > 0;
  }
  get canRedo(): boolean {
    return this.future.length > 0;
  }

  /** kind: the kind of change ("typing"); now: in milliseconds. */
  change(text: string, kind: string, now: number, files: readonly FileStep[] = []): void {
    if (text === this.now.text) return;
    const joins = kind === "typing" && this.lastKind === kind && now - this.lastTime < 600;
    if (!joins) this.past.push(this.now);
    if (this.past.length > 500) this.past.shift();
    this.future.length = 0;
    this.now = { text, files: joins ? this.now.files : files };
    this.lastKind = kind;
    this.lastTime = now;
  }

  /** Moves boxes of the drawing: a step with the same text. Moves of one kind that follow each other quickly are one step. */
  moved(boxes: BoxChange, kind: string, now: number): void {
    const joins = this.lastKind === kind && now - this.lastTime < 600;
    if (!joins) this.past.push(this.now);
    this.future.length = 0;
    this.now = { text: this.now.text, files: [], boxes: both(joins ? this.now.boxes : undefined, boxes) };
    this.lastKind = kind;
    this.lastTime = now;
  }

  /** The last change has also changed the names of boxes. */
  alsoMoved(boxes: BoxChange): void {
    this.now = { ...this.now, boxes: both(this.now.boxes, boxes) };
  }

  /** The next change is a step of its own, whatever its kind is. */
  endTyping(): void {
    this.lastKind = "";
  }

  /**
   * A change of one of the last texts, `before`. The steps that followed stay after it: merged tells their texts with it, from
   * the text that both changed. false: it was not done, since one of them has no such text.
   */
  insert(
    before: string,
    after: string,
    now: number,
    merged: (base: string, mine: string, theirs: string) => string | null,
  ): boolean {
    if (before === this.now.text) {
      this.change(after, "edit", now);
      return true;
    }
    const all = [...this.past, this.now];
    const at = all.findLastIndex(({ text }) => text === before);
    const later = all.slice(at + 1).map((step) => ({ ...step, text: merged(before, after, step.text) }));
    if (at < 0 || !later.every((step): step is Step => step.text !== null)) return false;
    this.past.splice(at + 1, Infinity, { text: after, files: [] }, ...later);
    this.now = this.past.pop()!;
    this.future.length = 0;
    return true;
  }

  /** The text and the files that a step leads to; undefined: there is none. */
  ahead(way: "undo" | "redo"): Step | undefined {
    if (way === "redo") return this.future.at(-1);
    const before = this.past.at(-1);
    const { files, boxes } = this.now;
    return (
      before && {
        text: before.text,
        files: files.map((one) => ({ ...one, before: one.after, after: one.before })),
        ...(boxes ? { boxes: reversed(boxes) } : {}),
      }
    );
  }

  undo(): string | undefined {
    return this.step(this.past, this.future);
  }
  redo(): string | undefined {
    return this.step(this.future, this.past);
  }

  private step(from: Step[], to: Step[]): string | undefined {
    const step = from.pop();
    if (step === undefined) return undefined;
    to.push(this.now);
    this.lastKind = "";
    this.now = step;
    return step.text;
  }
}
