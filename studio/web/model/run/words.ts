import type { FlatTransition, NetModel, Page, PageTransition } from "../net/net";
import { readIn, spelledOut, valuePath } from "./conditions";

/** A firing in words: "robot.control goes on from drive to ask because memory.battery < parameters.tired". */
export interface Words {
  /** change: of the behaviour that a subsystem executes, or of what runs. failure and timeout: of an iteration. */
  kind: "change" | "step" | "failure" | "timeout";
  /** The path of the subsystem, the agent or the channel; empty: the system. */
  who: string;
  does: string;
  /** The condition that held, as the specification has it; empty: none had to be asked. */
  because: string;
  /** The path to select: the behaviour that begins, or the transition. */
  place: string;
}

/** Words as one sentence. */
export const sentenceOf = ({ who, does, because }: Words): string =>
  `${who || "the system"} ${does}${because && ` because ${because}`}`;

/** Why a behaviour ended: the transition that ended its last iteration; null: not known. */
export type Ending = number | null;

/** So many firings before one are searched for what ended the behaviour. */
const farthest = 4000;

/** Conditions that ask nothing. */
const asksNothing = new Set(["", "otherwise", "no error", "never"]);

/** The words for the firings of a net. Each is made once. */
export class Teller {
  private readonly known = new Map<number, Map<number, Words>>();

  constructor(private readonly net: NetModel) {}

  /** ending: of the same subsystem, before the firing. It says why the behaviour was left. */
  words(transition: number, ending: Ending = null): Words {
    let before = this.known.get(transition);
    if (!before) this.known.set(transition, (before = new Map()));
    let words = before.get(ending ?? -1);
    if (!words) before.set(ending ?? -1, (words = this.tell(transition, ending)));
    return words;
  }

  /** Whether the firing ends an iteration as terminal or by an error, so that it says why the behaviour is left. */
  ends(transition: number): boolean {
    const role = this.bar(transition)?.bar.role;
    return role === "terminal" || role === "error";
  }

  /** The firing at a position of a run, with what ended the behaviour before it. */
  at(run: readonly number[], position: number): Words {
    const of = (transition: number) => this.net.transitions.at(transition)?.subsystem ?? -1;
    const transition = run[position]!;
    if (this.words(transition).kind !== "change") return this.words(transition);
    for (let at = position - 1; at >= Math.max(0, position - farthest); at -= 1) {
      const before = run[at]!;
      if (of(before) !== of(transition)) continue;
      if (this.ends(before)) return this.words(transition, before);
      if (this.words(before).kind !== "change") break;
    }
    return this.words(transition);
  }

  /** The values that its condition read, at the moment of the firing: "memory.battery = 0.18". */
  values({ who, because }: Words, at: (path: string) => unknown): string[] {
    return readIn(because).flatMap((read) => {
      const value = at(valuePath(who, read));
      if (typeof value === "number") return [`${read} = ${Number(value.toPrecision(4))}`];
      return typeof value === "boolean" || typeof value === "string" ? [`${read} = ${value}`] : [];
    });
  }

  private bar(transition: number): { flat: FlatTransition; page: Page; number: number; bar: PageTransition } | undefined {
    const flat = this.net.transitions.at(transition);
    if (!flat || flat.page === null) return undefined;
    const page = this.net.page(flat.page);
    const bar = page.transitions[this.net.flatTransitions(flat.page).indexOf(transition)];
    return bar && { flat, page, number: flat.page, bar };
  }

  private tell(transition: number, ending: Ending): Words {
    const found = this.bar(transition);
    if (!found) {
      const place = this.net.transitions.at(transition)?.name ?? "";
      return { kind: "step", who: place, does: "fires", because: "", place };
    }
    const { flat, page, number, bar } = found;
    const who = this.subsystem(number);
    const behaviour = this.net.behaviourName(number) ?? "";
    const of = { kind: "step", who, because: "", place: flat.name } as const;
    switch (bar.role) {
      case "start_system":
      case "start_agent":
        return { ...of, kind: "change", who: page.path, does: "starts" };
      case "end_system":
      case "end_agent":
        return { ...of, kind: "change", who: page.path, does: "ends" };
      case "start":
      case "begin_group":
      case "leave":
      case "leave_group":
        return this.between(found, who, ending);
      case "begin_sending":
        return { ...of, does: this.calls(found) ? `calls its function ${functionOf(behaviour)}()` : "begins to send" };
      case "end_sending":
        return { ...of, does: "has sent its outputs" };
      case "begin_receiving":
        return { ...of, does: this.calls(found) ? `calls its function ${functionOf(behaviour)}()` : "begins to receive" };
      case "end_receiving":
        return { ...of, does: "has received its inputs" };
      case "go_on":
        return { ...of, does: `goes on with ${behaviour}` };
      case "terminal":
        return { ...of, does: `ends ${behaviour}`, because: this.endingOf(transition) };
      case "error":
        return { ...of, kind: "failure", does: `fails in ${behaviour}`, because: this.endingOf(transition) };
      case "deliver":
      case "replace":
      case "deliver_older":
      case "lose_older":
        return { ...of, ...onTheWay(bar.role, flat.name) };
      case "page":
        return { ...of, does: passes(page, bar) };
      case "transfer":
      case "overwrite":
      case "skip":
      case "timeout":
        return { ...of, ...this.communicates(page, bar) };
      default:
        return { ...of, who: who || flat.name, does: who ? `fires ${flat.name.slice(who.length + 1)}` : "fires" };
    }
  }

  /** The subsystem around a page. */
  private subsystem(page: number): string {
    const { subsystem } = this.net.page(page);
    if (subsystem === null) return "";
    let path = "";
    for (let at: number | null = page; at !== null && this.net.page(at).subsystem === subsystem; at = this.net.page(at).parent)
      path = this.net.page(at).path;
    return path;
  }

  /** Whether the transition is the end of the transition function. */
  private calls({ flat }: { flat: FlatTransition }): boolean {
    return flat.inputs.some(({ place }) => this.net.places.at(place)?.operation?.kind === "transition_function");
  }

  /** Between two behaviours or groups of a page. */
  private between(
    { page, bar, flat }: { page: Page; bar: PageTransition; flat: FlatTransition },
    who: string,
    ending: Ending,
  ): Words {
    const pages = (nodes: readonly number[]) =>
      nodes.flatMap((node) => {
        const inside = page.nodes[node]!.page;
        return inside === null ? [] : [this.net.page(inside).path];
      });
    const [from] = pages(bar.inputs);
    const [to] = pages(bar.outputs);
    const name = (path: string) => path.slice(who.length + 1);
    const words = { kind: "change", who, because: "", place: to ?? flat.name } as const;
    if (from === undefined) return { ...words, does: `begins ${to === undefined ? name(page.path) : `with ${name(to)}`}` };
    const group = page.path === who ? "" : name(page.path);
    const does =
      to === from
        ? `begins ${name(from)} again`
        : to !== undefined
          ? `goes on from ${name(from)} to ${name(to)}`
          : group
            ? `leaves the group ${group} after ${name(from)}`
            : `ends after ${name(from)}`;
    return { ...words, kind: to === from ? "step" : "change", does, because: this.reason(bar, from, ending) };
  }

  /** Why an entry of `next` is taken: by its own condition, or by that of the end of the behaviour. */
  private reason(bar: PageTransition, from: string, ending: Ending): string {
    const text = bar.condition?.text ?? "";
    const failed = `${from.slice(from.lastIndexOf(".") + 1)} failed`;
    if (text === "error") return (ending !== null && this.endingOf(ending)) || failed;
    if (!asksNothing.has(text)) return spelledOut(this.net.text, from, text);
    if (ending === null) return "";
    return this.endingOf(ending) || (this.bar(ending)?.bar.role === "error" ? failed : "");
  }

  /** The condition by which an iteration has ended its behaviour; empty: it always does, or its function failed. */
  private endingOf(transition: number): string {
    const found = this.bar(transition);
    const behaviour = found && this.net.behaviourOf(found.number);
    const text = found?.bar.condition?.text ?? "";
    if (!behaviour || text === "failure" || asksNothing.has(text)) return "";
    const bare = text.replace(/^(terminal|error): /, "").replace(/; no error$/, "");
    if (asksNothing.has(bare)) return "";
    const spelled = spelledOut(this.net.text, behaviour.path, bare);
    // The transition of an error condition also fires after a failure of the function or of a device.
    return found?.bar.role === "error" ? `${spelled}, or its function or a device failed` : spelled;
  }

  private communicates(page: Page, bar: PageTransition): Pick<Words, "kind" | "does" | "because"> {
    const buffer = bar.name.split(".")[0]!;
    const sends = page.name === "snd" || [...bar.inputs, ...bar.outputs].some((node) => operation(page, node) === "write");
    const step = (does: string, because = "") => ({ kind: "step", does, because }) as const;
    if (bar.role === "overwrite") return step(`overwrites ${buffer}, which nobody has read`);
    if (bar.role === "timeout")
      return {
        kind: "timeout",
        does: `no longer waits for ${buffer}: its time of ${bar.condition?.text ?? "?"} is over`,
        because: "",
      };
    if (bar.role === "skip")
      return sends
        ? step(`does not send ${buffer}`, asksNothing.has(bar.condition?.text ?? "") ? "" : bar.condition!.text)
        : step(`finds nothing new in ${buffer}`);
    if (bar.outputs.some((node) => operation(page, node) === "write")) return step(`writes ${buffer}`);
    if (bar.outputs.some((node) => operation(page, node) === "read")) return step(`reads ${buffer}`);
    if (bar.inputs.some((node) => operation(page, node) === "read")) return step(`has received ${buffer}`);
    if (bar.inputs.some((node) => operation(page, node) === "write"))
      return step(waits(page, bar) ? `has sent ${buffer}, and waits until it is read` : `has sent ${buffer}`);
    return step(sends ? `is told that ${buffer} was read` : `passes ${buffer} on`);
  }
}

const functionOf = (behaviour: string) => behaviour.replace(/\[[^\]]*\]/g, "").replaceAll(".", "_");

const operation = (page: Page, node: number) => page.nodes[node]!.operation?.kind ?? null;

/** Whether a sender waits after the firing: another transition of the block takes an acknowledgement from there. */
function waits(page: Page, bar: PageTransition): boolean {
  const given = bar.outputs.filter((node) => page.nodes[node]!.fusion === null && node !== page.output);
  return page.transitions.some(
    (other) =>
      other !== bar &&
      other.role === "transfer" &&
      other.name.split(".")[0] === bar.name.split(".")[0] &&
      [...other.inputs, ...other.outputs].every((node) => operation(page, node) === null) &&
      other.inputs.some((node) => given.includes(node)),
  );
}

/** A transition of a page of communication that belongs to none of its channels. */
function passes(page: Page, bar: PageTransition): string {
  const [verb, done, things] = page.name === "snd" ? ["send", "sent", "outputs"] : ["receive", "received", "inputs"];
  if (bar.outputs.length > 1) return `begins to ${verb} all its ${things} at once`;
  if (bar.inputs.length > 1) return `has ${done} all its ${things}`;
  return `has nothing to ${verb}`;
}

/** Between two processes. */
function onTheWay(role: "deliver" | "replace" | "deliver_older" | "lose_older", name: string): Pick<Words, "who" | "does"> {
  const who = name.slice(0, name.lastIndexOf("."));
  const does = {
    deliver: "delivers a value",
    replace: "delivers a value over one that nobody has read",
    deliver_older: "delivers an older value",
    lose_older: "loses its older values on the way",
  }[role];
  return { who, does };
}
