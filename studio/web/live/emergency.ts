import { type Api, message } from "./api";
import type { Connection } from "./stream/connection";
import type { CommandDone, Driving } from "../model/protocol";
import { Store } from "./store";

export interface EmergencyState {
  /** The controllers that drive devices now. */
  controllers: Driving["controllers"];
  /** The command that they have not answered yet. */
  asked: "stop" | "reset" | null;
  /** The result of the last command; null: there was none, or it was put away. */
  told: (CommandDone & { what: "stop" | "reset" }) | null;
}

/** The emergency stop of everything that drives devices, as `tessera emergency-stop` does it. */
export class Emergency {
  readonly store = new Store<EmergencyState>({ controllers: [], asked: null, told: null });

  constructor(
    private readonly api: Api,
    connection: Connection,
  ) {
    connection.on("driving", ({ controllers }) => this.store.set({ controllers }));
    connection.on("hello", () => void this.look());
  }

  private async look(): Promise<void> {
    try {
      this.store.set(await this.api.driving());
    } catch {
      // The connection reports that the server is gone.
    }
  }

  /** May be called again while it waits: a second stop harms nobody. */
  async stop(): Promise<void> {
    await this.tell("stop", () => this.api.emergencyStop());
  }

  async reset(controller: string): Promise<void> {
    await this.tell("reset", () => this.api.emergencyReset(controller));
  }

  putAway(): void {
    this.store.set({ told: null });
  }

  private async tell(what: "stop" | "reset", ask: () => Promise<CommandDone>): Promise<void> {
    this.store.set({ asked: what });
    try {
      this.store.set({ told: { ...(await ask()), what } });
    } catch (error) {
      this.store.set({ told: { what, done: false, lines: [`The page could not tell them: ${message(error)}`] } });
    }
    this.store.set({ asked: null });
  }
}

export interface Stopped {
  /** The controller, or the deployed system, all of whose processes are reset together. */
  title: string;
  /** One of them. */
  name: string;
  why: string;
}

export function stoppedOf(controllers: Driving["controllers"]): Stopped[] {
  const all = controllers
    .filter(({ emergency }) => emergency !== null)
    .map(({ name, system, deployed, emergency }) => ({ title: deployed ? system : name, name, why: emergency! }));
  return all.filter((one, at) => all.findIndex(({ title }) => title === one.title) === at);
}
