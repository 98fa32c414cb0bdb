import { baseName, copiedText, kindName, namesAround, notCopied, placeFor, readCopied } from "../model/structure/copied";
import {
  bufferSelection,
  findThing,
  nextEntryOf,
  structureOf,
  withoutIndex,
  type Agent,
  type Buffer,
  type Structure,
  type Subsystem,
  type SubsystemKind,
  type Thing,
} from "../model/structure/structure";
import { outside } from "../model/structure/walk";
import { changedLines } from "../model/text/changed_lines";
import * as edits from "../model/text/edits";
import { arrowEdits, type NewArrow } from "../model/text/lead_on";
import type { YamlPath } from "../model/text/yaml_text";
import { keysNow, named, type Wish } from "./editor";
import { Store } from "./store";
import type { Studio } from "./studio";

/** The keys of the clipboard on this computer. */
const keysFor = (letter: "C" | "V") => `${/Mac|iP(hone|ad)/.test(navigator.platform) ? "⌘" : "Ctrl"} ${letter}`;

/** A removal that the user is asked about, since more than the element goes. */
export interface Removal {
  what: string;
  /** The lines that go or change. */
  lines: readonly string[];
}

/** The edits of whole elements that the drawing of the structure asks for. */
export class ElementEdits {
  readonly store = new Store<{ removal: Removal | null }>({ removal: null });
  /** The last copied text, for browsers that do not give the clipboard. */
  private copied = "";
  private answered: (yes: boolean) => void = () => {};

  constructor(private readonly studio: Studio) {}

  private get structure(): Structure {
    return structureOf(this.studio.draft.text);
  }

  private get selected(): string | null {
    return this.studio.view.get().selected;
  }

  private thing(path: string | null): Thing | undefined {
    return path === null ? undefined : findThing(this.structure, withoutIndex(path));
  }

  private tell(notice: string): void {
    this.studio.draft.store.set({ notice });
  }

  private refuse(why: string): false {
    this.tell(why);
    return false;
  }

  private added(
    name: string,
    taken: readonly YamlPath[],
    edit: (name: string) => ReturnType<typeof edits.insert>,
    select: (name: string) => string,
  ) {
    const given = named(name, keysNow(...taken), edit);
    return this.studio.change(given.wish, () => ({ selected: select(given.name), panel: "inspect" }));
  }

  /** Adds an agent, a subsystem of one, or a part of a subsystem or group. */
  addAgent(): Promise<boolean> {
    return this.added(
      "agent",
      [["agents"]],
      (name) => edits.insert(["agents"], name, edits.freshAgent),
      (name) => name,
    );
  }
  addSubsystem(agent: Agent, kind: SubsystemKind): Promise<boolean> {
    const maps = ["receptors", "effectors"].map((key) => [...agent.body, key]);
    const wish = kind === "receptor" ? "sensor" : kind === "effector" ? "motor" : kind;
    return this.added(
      wish,
      maps,
      (name) => edits.addSubsystem(agent, kind, name),
      (name) => `${agent.name}.${name}`,
    );
  }
  addBehaviour(of: { yaml: YamlPath; path: string }, isGroup: boolean): Promise<boolean> {
    const taken = ["behaviours", "inputs", "outputs", "real"].map((key) => [...of.yaml, key]);
    const add = isGroup ? edits.addGroup : edits.addBehaviour;
    return this.added(
      isGroup ? "group" : "act",
      taken,
      (name) => add(of, name),
      (name) => `${of.path}.${name}`,
    );
  }
  addBuffer(subsystem: Subsystem, direction: Buffer["direction"]): Promise<boolean> {
    const taken = ["behaviours", "inputs", "outputs", "real"].map((key) => [...subsystem.yaml, key]);
    const type = this.structure.types[0] ?? "float64";
    const wish = direction === "real" ? "device" : direction;
    const select = (name: string) => bufferSelection(direction, `${subsystem.path}.${name}`);
    return this.added(wish, taken, (name) => edits.addBuffer(subsystem, direction, name, type), select);
  }

  /** A copy beside an element. The channels of an agent to others are not copied: an input has one source. */
  async duplicate(path: string): Promise<void> {
    const thing = this.thing(path);
    if (!thing || thing.kind === "channel" || thing.kind === "template") return;
    if (thing.kind === "subsystem" && thing.of.kind === "control") return this.tell("An agent has one control subsystem");
    const { name, yaml } = thing.of;
    const left = thing.kind === "agent" ? notCopied(this.structure, thing.of) : { channels: 0, drivers: 0 };
    const at = path.lastIndexOf(name);
    const done = await this.added(
      baseName(name),
      namesAround(thing),
      (free) => edits.copyOf(yaml, free),
      (free) => path.slice(0, at) + free,
    );
    const counted = (count: number, one: string) => (count > 0 ? [`${count} ${one}${count > 1 ? "s" : ""}`] : []);
    const lost = [
      ...counted(left.channels, "channel").map((text) => `${text} to other agents`),
      ...counted(left.drivers, "driver"),
    ];
    if (done && lost.length > 0) this.tell(`The copy does not have: ${lost.join(", ")}`);
  }

  /** The text of an element for the clipboard; undefined: it cannot be copied. It is kept for a paste in this tab, too. */
  copy(path: string | null): string | undefined {
    const thing = this.thing(path);
    const text = thing && copiedText(this.structure, thing);
    if (text === undefined) return undefined;
    this.copied = text;
    this.tell(`Copied: ${kindName(thing!)} ${thing!.kind === "channel" ? "" : (thing!.of as { name: string }).name}`);
    return text;
  }

  /** Copies to the clipboard of the system. If the browser does not allow it, a paste in this tab works all the same. */
  async copyToClipboard(path: string | null): Promise<void> {
    const text = this.copy(path);
    try {
      if (text !== undefined) await navigator.clipboard.writeText(text);
    } catch {
      this.tell(`Copied for this tab alone: for other programs, press ${keysFor("C")}`);
    }
  }

  /** Pastes what is in the clipboard of the system, or else what was copied in this tab. */
  async pasteFromClipboard(): Promise<void> {
    let text: string;
    try {
      text = await navigator.clipboard.readText();
    } catch {
      // The browser or the user does not allow it. The keys work all the same: they give the text with the event.
      if (this.copied === "") return this.tell(`This browser does not let a menu read the clipboard: press ${keysFor("V")}`);
      if (await this.paste(""))
        this.tell(`Pasted what this tab has copied. For the clipboard of the computer, press ${keysFor("V")}`);
      return;
    }
    await this.paste(text);
  }

  /** Pastes an element beside or into what is selected, under a free name. text: of the clipboard; empty: it is not given. */
  async paste(text: string): Promise<boolean> {
    const copied = readCopied(text || this.copied);
    if (!copied) return this.refuse("The clipboard has no element of a specification");
    const place = placeFor(this.structure, this.selected, copied);
    if (typeof place === "string") return this.refuse(`Not pasted: ${place}`);
    return this.added(
      place.name ?? baseName(copied.name),
      place.taken,
      (name) => edits.paste(place.map, name, copied.text),
      place.select,
    );
  }

  /** Removes what is selected. The user is asked first if something else goes or changes with it. */
  async remove(path: string): Promise<void> {
    const { studio } = this;
    const entry = nextEntryOf(path);
    const thing = this.thing(path);
    if (!thing) return;
    if (entry !== undefined && thing.kind === "behaviour") {
      const { of } = thing;
      await studio.change(edits.changeNext(of, entry, { to: "" }), () => ({ selected: of.path }));
      return;
    }
    const at = thing.kind === "channel" ? ["channels", thing.of.index] : thing.of.yaml;
    const wish: Wish = edits.remove(at);
    const found = await studio.editor.preview(wish);
    if (!found) return;
    const lines = changedLines(found.before, found.after);
    const { yaml } = structureOf(found.before);
    const own = yaml.endLine(found.at(at)) - yaml.line(found.at(at)) + 1;
    const name = thing.kind === "channel" ? `${thing.of.from} → ${thing.of.to}` : thing.of.name;
    if (lines.length > own && !(await this.agreed({ what: `${kindName(thing)} ${name}`, lines }))) return;
    await studio.change(wish, () => ({ selected: outside(thing) }));
  }

  private async agreed(removal: Removal): Promise<boolean> {
    this.answered(false);
    const answer = new Promise<boolean>((answered) => (this.answered = answered));
    this.store.set({ removal });
    const yes = await answer;
    this.store.set({ removal: null });
    return yes;
  }

  /** The answer of the user to a removal. */
  agree(yes: boolean): void {
    this.answered(yes);
  }

  /** Adds an arrow: an entry of `next`, and what ends the behaviour for it. Selects the entry. */
  leadOn(from: string, arrow: NewArrow): Promise<boolean> {
    const thing = this.thing(from);
    if (thing?.kind !== "behaviour") return Promise.resolve(false);
    const { edits: all, entry } = arrowEdits(thing.of, arrow);
    return this.studio.change(all, () => ({ selected: `next:${from}#${entry}`, panel: "inspect" }));
  }
}
