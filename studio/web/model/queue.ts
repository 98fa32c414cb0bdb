/** Work that is done one after the other, in the order in which it was asked for. */
export class Queue {
  private last: Promise<unknown> = Promise.resolve();
  private waiting = 0;

  /** changed: called with whether work is left. */
  constructor(private readonly changed: (busy: boolean) => void) {}

  get busy(): boolean {
    return this.waiting > 0;
  }

  add<T>(work: () => Promise<T>): Promise<T> {
    this.waiting += 1;
    this.changed(true);
    const done = this.last.then(work).finally(() => {
      this.waiting -= 1;
      this.changed(this.busy);
    });
    this.last = done.catch(() => undefined);
    return done;
  }

  /** All work so far is done or has failed. */
  async settled(): Promise<void> {
    await this.last;
  }
}
