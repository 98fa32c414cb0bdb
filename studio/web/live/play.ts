import { activeTransitions, Walk, type Conditions } from "../model/net/game";
import type { NetModel } from "../model/net/net";
import type { Stage } from "./stage";
import { Store } from "./store";

export interface PlayState {
  /** The thing that is played: nothing, the token game, or a run that shows a violation. */
  what: "nothing" | "game" | "trace";
  title: string;
  position: number;
  length: number;
  /** Transitions that can fire now. */
  active: number[];
  conditions: Conditions;
  running: boolean;
  waits: readonly string[];
}

const nothing: PlayState = {
  what: "nothing",
  title: "",
  position: 0,
  length: 0,
  active: [],
  conditions: new Map(),
  running: false,
  waits: [],
};

/** The token game, and stepping through runs. Neither needs a compiler or a server. */
export class Play {
  readonly store = new Store<PlayState>(nothing);
  private walk: Walk | null = null;
  /** The net in play: that of the text at the beginning. */
  net: NetModel | null = null;
  private timer: ReturnType<typeof setInterval> | undefined;

  constructor(private readonly stage: Stage) {}

  get steps(): readonly number[] {
    return this.walk?.steps ?? [];
  }

  get marking(): Int32Array | undefined {
    return this.walk?.marking;
  }

  game(net: NetModel): void {
    this.begin(net, [], { what: "game", title: "Token game", waits: [] });
    this.stage.reset(net, "game");
    this.tell();
  }

  /** Transition indices of the net. Begins at the end of the run, where the violation is. */
  trace(net: NetModel, steps: readonly number[], title: string, waits: readonly string[]): void {
    this.begin(net, steps, { what: "trace", title, waits });
    this.stage.reset(net, "trace");
    this.seek(steps.length);
  }

  private begin(net: NetModel, steps: readonly number[], state: Pick<PlayState, "what" | "title" | "waits">): void {
    this.run(false);
    this.net = net;
    this.walk = new Walk(net, steps);
    this.store.set({ ...nothing, ...state, length: steps.length });
  }

  stop(): void {
    this.run(false);
    const { net } = this;
    this.walk = this.net = null;
    this.store.set(nothing);
    if (net) this.stage.reset(net, "edit");
  }

  choose(transition: number): boolean {
    if (!this.walk || !this.store.get().active.includes(transition)) return false;
    const fired = this.walk.choose(transition);
    if (fired) this.stage.fired(transition);
    this.tell();
    return fired;
  }

  forward(): void {
    const next = this.walk?.steps[this.walk.position];
    if (next !== undefined && this.walk!.forward()) this.stage.fired(next);
    this.tell();
  }

  back(): void {
    if (this.walk?.back()) this.stage.setMarking(this.walk.marking);
    this.tell();
  }

  seek(position: number): void {
    if (!this.walk) return;
    this.walk.seek(position);
    this.stage.setMarking(this.walk.marking);
    this.tell();
  }

  /** true: the condition holds, false: it does not, undefined: both are possible. */
  setCondition(transition: number, falls: boolean | undefined): void {
    const conditions = new Map(this.store.get().conditions);
    if (falls === undefined) conditions.delete(transition);
    else conditions.set(transition, falls);
    this.store.set({ conditions });
    this.tell();
  }

  /** Runs automatically: the game fires any transition that can fire, a run continues to its end. */
  run(running: boolean): void {
    clearInterval(this.timer);
    this.store.set({ running });
    if (running) this.timer = setInterval(() => this.tick(), 120);
  }

  private tick(): void {
    const { what, active, length } = this.store.get();
    if (what === "trace") {
      this.forward();
      if (this.walk!.position >= length) this.run(false);
      return;
    }
    const chosen = active[Math.floor(Math.random() * active.length)];
    if (chosen === undefined) this.run(false);
    else this.choose(chosen);
  }

  private tell(): void {
    if (!this.walk || !this.net) return;
    const { conditions } = this.store.get();
    this.store.set({
      position: this.walk.position,
      length: this.walk.steps.length,
      active: activeTransitions(this.net, this.walk.marking, conditions),
    });
  }
}
