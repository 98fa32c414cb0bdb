import { stuckIn } from "../model/causes";
import type { NetModel } from "../model/net/net";
import { type Api, message } from "./api";
import type { Connection } from "./stream/connection";
import type { Draft } from "./draft";
import type { Verdict, VerifyAnswer, VerifyEvent } from "../model/protocol";
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
  private started = 0;

  constructor(
    private readonly api: Api,
    private readonly draft: Draft,
    connection: Connection,
    /** Called with the verdicts of each completed verification. */
    private readonly onVerdicts: (verdicts: readonly Verdict[]) => void = () => undefined,
  ) {
    connection.on("verify", (event) => this.told(event));
    // If the stream broke, the end of a job may be lost.
    connection.on("hello", () => void this.ask());
  }

  async start(): Promise<void> {
    this.job = null;
    const started = ++this.started;
    const { text: before, net: drawn } = this.draft.store.get();
    const begun = { property: "", states: 0, rate: 0, verdicts: [], problem: "" };
    this.store.set({ ...begun, state: "running", text: before, net: drawn });
    await this.draft.settled();
    if (started !== this.started || this.store.get().state !== "running") return;
    const { text, net } = this.draft.store.get();
    this.store.set({ text, net });
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
      this.told(await this.api.verifyState(this.job));
    } catch (error) {
      this.store.set({ state: "failed", problem: message(error) });
    }
  }

  private told(event: VerifyEvent | VerifyAnswer): void {
    if (event.job !== this.job || this.store.get().state !== "running") return;
    if (event.state === "running") {
      if ("property" in event) this.store.set({ property: event.property, states: event.states, rate: event.rate });
      return;
    }
    const { state, result } = event;
    if ("error" in result) this.store.set({ state, problem: result.error });
    else {
      this.store.set({ state, verdicts: result.properties });
      this.onVerdicts(result.properties);
    }
  }
}

/** The paths of the subsystems that wait for ever in some violation; the drawing marks them. */
export function stuck(verdicts: readonly Verdict[]): string[] {
  return stuckIn(verdicts.flatMap((one) => (one.verdict === "violated" && !one.warning ? one.at_end : [])));
}

/** The firings of a violation as transitions of the net; null when there is none. */
export function stepsOf({ steps }: Pick<Verdict, "steps">, net: NetModel): number[] | null {
  if (!steps || steps.length === 0) return null;
  // A last step beyond the net means "no initial condition holds": it is not drawn.
  const end = steps.findIndex((step) => step >= net.transitions.length);
  return end < 0 ? steps : steps.slice(0, end);
}
