/** Undo and redo of a text. Changes of one kind that follow each other quickly are one step. */
export class History {
  private readonly past: string[] = [];
  private readonly future: string[] = [];
  private lastKind = "";
  private lastTime = -Infinity;

  constructor(private text: string) {}

  get current(): string {
    return this.text;
  }
  get canUndo(): boolean {
    return this.past.length > 0;
  }
  get canRedo(): boolean {
    return this.future.length > 0;
  }

  /** kind: the kind of change ("typing"); now: in milliseconds. */
  change(text: string, kind: string, now: number): void {
    if (text === this.text) return;
    const joins = kind === "typing" && this.lastKind === kind && now - this.lastTime < 600;
    if (!joins) this.past.push(this.text);
    if (this.past.length > 500) this.past.shift();
    this.future.length = 0;
    this.text = text;
    this.lastKind = kind;
    this.lastTime = now;
  }

  undo(): string | undefined {
    return this.step(this.past, this.future);
  }
  redo(): string | undefined {
    return this.step(this.future, this.past);
  }

  private step(from: string[], to: string[]): string | undefined {
    const text = from.pop();
    if (text === undefined) return undefined;
    to.push(this.text);
    this.lastKind = "";
    return (this.text = text);
  }
}
