import type { NetModel } from "../model/net";
import type { Api } from "./api";
import type { Connection } from "./connection";
import { message, type Draft } from "./draft";
import type { Verdict, VerifyEvent } from "./protocol";
import { Store } from "./store";

export interface VerifierState {
  state: "idle" | "running" | "done" | "stopped" | "failed";
  property: string;
  states: number;
  rate: number;
  verdicts: readonly Verdict[];
  /** The text that was verified, and its net. */
  text: string;
  net: NetModel | null;
  problem: string;
}

/** One verification at a time, of the text in the page. */
export class Verifier {
  readonly store = new Store<VerifierState>({
    state: "idle",
    property: "",
    states: 0,
    rate: 0,
    verdicts: [],
    text: "",
    net: null,
    problem: "",
  });
  private job: string | null = null;

  constructor(
    private readonly api: Api,
    private readonly draft: Draft,
    connection: Connection,
  ) {
    connection.on<VerifyEvent>("verify", (event) => this.told(event));
    // The end of a job may have been lost with a broken stream.
    connection.on("hello", () => void this.ask());
  }

  async start(): Promise<void> {
    const { text, net } = this.draft.store.get();
    this.store.set({ state: "running", property: "", states: 0, rate: 0, verdicts: [], text, net, problem: "" });
    try {
      this.job = (await this.api.verify(text)).job;
      await this.ask();
    } catch (error) {
      this.store.set({ state: "failed", problem: message(error) });
    }
  }

  stop(): void {
    if (this.job) void this.api.stopVerify(this.job).catch(() => undefined);
    this.store.set({ state: "stopped" });
  }

  private async ask(): Promise<void> {
    if (this.job === null || this.store.get().state !== "running") return;
    try {
      this.told({ ...(await this.api.verifyState(this.job)), job: this.job });
    } catch (error) {
      this.store.set({ state: "failed", problem: message(error) });
    }
  }

  private told(event: VerifyEvent): void {
    if (event.job !== this.job || this.store.get().state !== "running") return;
    const { property, states, rate } = this.store.get();
    this.store.set({
      state: event.state,
      property: event.property ?? property,
      states: event.states ?? states,
      rate: event.rate ?? rate,
      verdicts: event.result?.properties ?? [],
      problem: event.error ?? event.result?.error ?? "",
    });
    if (event.state === "done" && !event.result) void this.fetchResult();
  }

  private async fetchResult(): Promise<void> {
    try {
      const { result } = await this.api.verifyState(this.job!);
      if (result) this.store.set({ verdicts: result.properties ?? [], problem: result.error ?? "" });
    } catch (error) {
      this.store.set({ state: "failed", problem: message(error) });
    }
  }
}

/** The paths of the subsystems that wait for ever in some violation; the drawing marks them. */
export function stuck(verdicts: readonly Verdict[]): string[] {
  const waits = verdicts.filter((one) => one.verdict === "violated" && !one.warning).flatMap((one) => one.waits ?? []);
  return [...new Set(waits.flatMap((wait) => /^(\S+) waits /.exec(wait)?.[1] ?? []))];
}

/**
 * The firings of a violation as transitions of the net; null: there are none, or
 * they belong to another net.
 */
export function stepsOf(verdict: Verdict, net: NetModel): number[] | null {
  if (verdict.steps && verdict.steps.length > 0) {
    // A last step beyond the net means "no initial condition holds"; it is not drawn.
    const end = verdict.steps.findIndex((step) => step >= net.transitions.length);
    return end < 0 ? verdict.steps : verdict.steps.slice(0, end);
  }
  if (!verdict.trace || verdict.trace.length === 0) return null;
  const steps = verdict.trace.map((step) => net.transitionByName.get(step.transition) ?? -1);
  return steps.includes(-1) ? null : steps;
}
