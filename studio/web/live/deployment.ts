import type { Connection } from "./stream/connection";
import type { DeploymentSeen, LinkSeen, ProcessSeen } from "../model/protocol";
import type { Runner } from "./run/runner";
import { Store } from "./store";

/** The state of all processes of a deployed system that are watched together. */
export class Deployment {
  readonly store = new Store<{ seen: DeploymentSeen | null }>({ seen: null });

  constructor(runner: Runner, connection: Connection) {
    connection.on("deployment", (event) => {
      if (event.run === runner.store.get().run) this.store.set({ seen: event });
    });
    runner.onInfo((info) => {
      if (info.kind !== "deployment") this.store.set({ seen: null });
      else if (info.deployment) this.store.set({ seen: info.deployment });
    });
  }
}

/** The severity of a process's problem; 0: there is none. */
export function trouble(process: ProcessSeen): number {
  if (process.state === "gone") return 5;
  if (process.state === "silent") return 4;
  if (process.emergency !== null) return 3;
  if (process.errors > 0) return 2;
  return process.state === "ended" ? 1 : 0;
}

export const lossOf = (link: LinkSeen): number => (link.signs === 0 ? 0 : link.signs_lost / link.signs);

/** Links with problems come first: those that are cut, then those that lose most. */
export function worstFirst(links: readonly LinkSeen[]): LinkSeen[] {
  const rank = (link: LinkSeen) => (link.reachable ? lossOf(link) : 2);
  return [...links].sort((one, other) => rank(other) - rank(one));
}
