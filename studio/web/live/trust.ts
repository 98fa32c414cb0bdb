import { type Api, message } from "./api";
import { Store } from "./store";

/** Asks once for a folder whether its code may be compiled and run. The server enforces the answer. */
export class Trust {
  readonly store = new Store<{ asking: boolean; problem: string }>({ asking: false, problem: "" });
  private answered: (yes: boolean) => void = () => {};

  constructor(private readonly api: Api) {}

  /** Whether the folder is trusted; asks the user if it was not. */
  async given(): Promise<boolean> {
    try {
      // Another tab, or a command, may have answered.
      if ((await this.api.project()).trusted) return true;
    } catch {
      return true; // the run itself says what is wrong
    }
    this.store.set({ asking: true, problem: "" });
    const yes = await new Promise<boolean>((answered) => (this.answered = answered));
    this.store.set({ asking: false });
    return yes;
  }

  async answer(yes: boolean): Promise<void> {
    if (!this.store.get().asking) return;
    try {
      if (yes) await this.api.trust();
      this.answered(yes);
    } catch (error) {
      this.store.set({ problem: message(error) });
    }
  }
}
