import { concernedIn, stuckIn, titleOf, waitsIn, type Wait } from "../model/causes";
import { type Api, message } from "./api";
import type { NetModel } from "../model/net/net";
import type { SubsystemAtEnd } from "../model/protocol";
import { Store } from "./store";

/** The subsystems of a standstill, for the drawings. */
export interface Stuck {
  title: string;
  /** The net in which they are stuck: in another one they may go on. */
  net: NetModel | null;
  atEnd: readonly SubsystemAtEnd[];
  /** Subsystems that cannot go on. */
  stuck: readonly string[];
  /** These subsystems and those that they wait for: everything that is not grey. */
  concerned: readonly string[];
  waits: readonly Wait[];
}

export interface LensState {
  shown: Stuck | null;
  /** Grows with each request, so that the camera flies again. */
  request: number;
  problem: string;
}

/** The lens that shows the stuck subsystems, in the net and in the structure, until it is closed. */
export class Lens {
  readonly store = new Store<LensState>({ shown: null, request: 0, problem: "" });

  constructor(private readonly api: Api) {}

  show(net: NetModel | null, atEnd: readonly SubsystemAtEnd[], title = titleOf(atEnd)): void {
    const shown = { title, net, atEnd, stuck: stuckIn(atEnd), concerned: concernedIn(atEnd), waits: waitsIn(atEnd) };
    this.store.set({ shown: atEnd.length > 0 ? shown : null, request: this.store.get().request + 1, problem: "" });
  }

  close(): void {
    this.store.set({ shown: null, problem: "" });
  }

  /** Requests the subsystems that cannot go on in a marking: of a run that has stopped, or stands still. */
  async look(net: NetModel, marking: Int32Array): Promise<void> {
    const marked = [...marking.entries()].flatMap(([place, tokens]) => (tokens > 0 ? [{ place }] : []));
    try {
      const { at_end: atEnd } = await this.api.waits(net.text, marked);
      if (atEnd.length > 0) return this.show(net, atEnd);
      this.store.set({ shown: null, problem: "Nobody waits for another subsystem at this moment." });
    } catch (error) {
      this.store.set({ problem: message(error) });
    }
  }
}
