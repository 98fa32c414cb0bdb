import { causesOf, type Cause } from "../model/causes";
import { candidatesFor, type Candidate } from "../model/text/repair_edits";
import { readStructure } from "../model/structure/structure";
import { applied } from "../model/text/edits";
import { type Api, ApiError, message } from "./api";
import type { Verdict } from "../model/protocol";
import { Store } from "./store";

/** An edit that was verified: the violations of the cause are gone, and no property that held is violated. */
export interface Repair {
  title: string;
  meaning: string;
  /** The whole text after the edit. */
  text: string;
  mends: string[];
}

export interface RepairState {
  state: "idle" | "searching" | "done" | "failed";
  tried: number;
  found: readonly Repair[];
  /** The text that the edits change. */
  text: string;
  /** The title of the cause that they mend. */
  cause: string;
  problem: string;
}

/** Verifications for one search, number of repairs that is enough to choose from, and edits of one repair. */
const mostTried = 30;
const enough = 3;
const mostEdits = 3;

/** One edit or several; their number, the number of timeouts among them, and the text that they change. */
type Attempt = Candidate & { count: number; timeouts: number; of: string };

const timeoutsIn = ({ title }: Candidate) => Number(title.startsWith("Give up"));

/**
 * The order of attempts: few edits first. One timeout changes least. If one is not enough, two sides that
 * gave up at different times seldom meet again, so edits that let a side go on at once come first.
 */
const byHope = (a: Attempt, b: Attempt) => a.count - b.count || (a.count > 1 ? a.timeouts - b.timeouts : 0);

function further(before: Attempt, text: string, verdicts: readonly Verdict[]): Attempt[] {
  const structure = readStructure(text);
  return causesOf(verdicts, structure.channels)
    .filter(({ warning, atEnd }) => !warning && atEnd.length > 0)
    .flatMap((cause) => candidatesFor(cause, structure))
    .map((next) => ({
      title: `${before.title}; ${next.title.charAt(0).toLowerCase()}${next.title.slice(1)}`,
      meaning: `${before.meaning} ${next.meaning}`,
      edits: next.edits,
      of: text,
      count: before.count + 1,
      timeouts: before.timeouts + timeoutsIn(next),
    }));
}

const nothing: RepairState = { state: "idle", tried: 0, found: [], text: "", cause: "", problem: "" };

/** Looks for edits that mend a violation. Each is verified before it is offered. */
export class Repairs {
  readonly store = new Store<RepairState>(nothing);
  private search = 0;

  constructor(private readonly api: Api) {}

  forget(): void {
    this.search += 1;
    this.store.set(nothing);
  }

  /** text, verdicts: of the verified text. */
  async find(cause: Cause, text: string, verdicts: readonly Verdict[]): Promise<void> {
    const search = ++this.search;
    // If another standstill is left after an edit, the edits that mend that one are tried in addition.
    const queue = candidatesFor(cause, readStructure(text)).map((one): Attempt => ({
      ...one,
      of: text,
      count: 1,
      timeouts: timeoutsIn(one),
    }));
    const seen = new Set([text]);
    this.store.set({ ...nothing, state: "searching", text, cause: cause.title });
    try {
      for (let next = queue.shift(); next; next = queue.shift()) {
        const { found, tried } = this.store.get();
        if (tried >= mostTried || found.length >= enough) break;
        const edited = await this.edited(next);
        if (search !== this.search) return;
        if (seen.has(edited)) continue;
        seen.add(edited);
        const after = await this.after(cause, edited, verdicts, () => search !== this.search);
        if (search !== this.search) return;
        const mends = after ? mended(cause, verdicts, after) : [];
        this.store.set({ tried: tried + 1 });
        if (mends.length > 0)
          this.store.set({ found: [...found, { title: next.title, meaning: next.meaning, text: edited, mends }] });
        else if (after && next.count < mostEdits) {
          queue.push(...further(next, edited, after));
          queue.sort(byHope);
        }
      }
      this.store.set({ state: "done" });
    } catch (error) {
      if (search === this.search) this.store.set({ state: "failed", problem: message(error) });
    }
  }

  /** The text after an attempt; the same text: it cannot be done. */
  private async edited({ of, edits }: Attempt): Promise<string> {
    try {
      return applied(of, (await this.api.edit(of, edits)).edits);
    } catch (error) {
      if (error instanceof ApiError && error.status === 422) return of;
      throw error;
    }
  }

  /**
   * The verdicts after an edit. Most edits mend nothing, so the property with the shortest run is verified
   * first, and the others only if it holds. null: the text has no net, or the verification failed.
   */
  private async after(
    cause: Cause,
    text: string,
    before: readonly Verdict[],
    stopped: () => boolean,
  ): Promise<readonly Verdict[] | null> {
    const { diagnostics } = await this.api.check(text);
    if (diagnostics.some(({ severity }) => severity === "error")) return null;
    const first = wantedOf(cause)[0]!;
    const telling = await this.verdictsOf(text, [first], stopped);
    if (!telling || telling[0]?.verdict !== "holds") return telling;
    const others = before.map(({ name }) => name).filter((name) => name !== first);
    const rest = await this.verdictsOf(text, others, stopped);
    return rest && [...telling, ...rest];
  }

  private async verdictsOf(text: string, properties: string[], stopped: () => boolean): Promise<readonly Verdict[] | null> {
    // An empty list would mean all properties.
    if (properties.length === 0) return [];
    const { job } = await this.api.verify(text, "10s", properties);
    for (;;) {
      const answer = await this.api.verifyState(job);
      if (answer.state !== "running") return "error" in answer.result ? null : answer.result.properties;
      if (stopped()) {
        await this.api.stopVerify(job);
        return null;
      }
      await new Promise((done) => setTimeout(done, 60));
    }
  }
}

/** The properties that a repair has to mend, the one with the shortest run first. */
const wantedOf = (cause: Cause) => cause.verdicts.filter(({ warning }) => !warning || cause.warning).map(({ name }) => name);

/**
 * The violations of the cause that are gone; none if one of them is left, or if a property that held is
 * violated.
 */
export function mended(cause: Cause, before: readonly Verdict[], after: readonly Verdict[]): string[] {
  const now = new Map(after.map(({ name, verdict }) => [name, verdict]));
  const wanted = wantedOf(cause);
  const kept = before.every(({ name, verdict }) => verdict !== "holds" || now.get(name) === "holds");
  return kept && wanted.every((name) => now.get(name) === "holds") ? wanted : [];
}
