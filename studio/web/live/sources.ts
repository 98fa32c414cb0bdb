import { ApiError, message, type Api } from "./api";
import { CodeDraft, edited, functionIn, nameOf, type Edited } from "./code_draft";
import { lineEndOf, withEnds, withFeeds, type LineEnd } from "../model/text/line_ends";
import type { Draft } from "./draft";
import type { FunctionShown } from "../model/protocol";
import { Store } from "./store";

export interface SourcesState {
  /** The functions of the behaviours, of the last text without errors. */
  functions: readonly FunctionShown[];
  /** Sources that were opened, by name. */
  files: ReadonlyMap<string, SourceFile>;
  /** Functions whose text is not saved, by "walker.control.follow". */
  unsaved: readonly string[];
  problem: string;
}

export interface SourceFile {
  text: string;
  revision: string;
  lineEnd: LineEnd;
}

const sourceOf = ({ text, revision }: { text: string; revision: string }): SourceFile => ({
  text: withFeeds(text),
  revision,
  lineEnd: lineEndOf(text),
});

/** The C++ functions of the behaviours, in the files of the project. */
export class Sources {
  readonly store = new Store<SourcesState>({ functions: [], files: new Map(), unsaved: [], problem: "" });
  private readonly code = new CodeDraft();
  private asked = 0;
  /** The number of the last request about a file; answers to earlier ones are late. */
  private turns = new Map<string, number>();

  constructor(
    private readonly api: Api,
    private readonly draft: Draft,
  ) {}

  get dirty(): boolean {
    return this.store.get().unsaved.length > 0;
  }

  /** project: its folder. Restores what this tab had not saved before a reload. */
  restore(project: string): void {
    this.code.restore(project);
    this.store.set({ unsaved: this.code.names });
  }

  edited(of: FunctionShown): Edited | undefined {
    return this.code.get(nameOf(of));
  }

  edit(of: FunctionShown, to: Edited): void {
    this.code.set(nameOf(of), to);
    this.store.set({ unsaved: this.code.names });
  }

  /** Saves a function into its file. false: it is not saved, and `problem` says why. */
  async saveFunction(of: FunctionShown): Promise<boolean> {
    const { file } = of;
    if (!this.store.get().files.has(file)) await this.open(file);
    const known = this.store.get().functions.find((one) => nameOf(one) === nameOf(of));
    const source = this.store.get().files.get(file);
    const held = this.code.get(nameOf(of));
    const found = known && functionIn(source?.text, known);
    const now = held && found && edited(held, found.text);
    if (!source || !found || !now) {
      this.store.set({ problem: `${nameOf(of)} is not saved: ${file} was changed by another program.` });
      return false;
    }
    const whole = source.text.slice(0, found.from) + now.text + source.text.slice(found.to);
    if (!(await this.save(file, whole))) return false;
    const late = this.code.get(nameOf(of))?.text;
    this.edit(of, { text: late === undefined || late === held.text ? now.text : late, base: now.text });
    return true;
  }

  /** Saves all functions. false: one is not saved. */
  async saveAll(): Promise<boolean> {
    if (this.dirty) await this.look();
    for (const name of this.code.names) {
      const of = this.store.get().functions.find((one) => nameOf(one) === name);
      // The text of a behaviour that is gone has no place in a file.
      if (of?.state === "defined" && !(await this.saveFunction(of))) return false;
    }
    return true;
  }

  /** Reads the positions of the functions. */
  async look(): Promise<void> {
    const asked = ++this.asked;
    try {
      const functions = await this.api.functions(this.draft.store.get().text);
      if (asked !== this.asked) return;
      this.store.set({ functions, problem: "" });
      // A function that is not at its line: another program has changed the file since it was read.
      const { files } = this.store.get();
      const moved = functions.filter((one) => one.line && files.has(one.file) && !functionIn(files.get(one.file)!.text, one));
      await Promise.all([...new Set(moved.map(({ file }) => file))].map((file) => this.open(file)));
    } catch (error) {
      // A text with errors has no functions: those of the text before stay.
      if (asked === this.asked && !(error instanceof ApiError && error.status === 422))
        this.store.set({ problem: message(error) });
    }
  }

  async open(file: string): Promise<void> {
    const turn = this.turn(file);
    try {
      const content = await this.api.source(file);
      if (this.turns.get(file) !== turn) return;
      const isNew = this.store.get().files.get(file)?.revision !== content.revision;
      this.hold(file, sourceOf(content));
      // Its functions may be elsewhere.
      if (isNew) await this.look();
    } catch (error) {
      this.store.set({ problem: message(error) });
    }
  }

  /** Files have other texts now. */
  async reread(files: readonly string[]): Promise<void> {
    await Promise.all([this.look(), ...files.filter((file) => this.store.get().files.has(file)).map((file) => this.open(file))]);
  }

  /** Writes the beginning of a function that is missing. */
  async add({ subsystem, function: name }: FunctionShown): Promise<void> {
    try {
      await this.draft.settled();
      const { file } = await this.api.addFunction(this.draft.store.get().text, subsystem, name);
      await Promise.all([this.look(), this.open(file)]);
    } catch (error) {
      this.store.set({ problem: message(error) });
    }
  }

  /** Gives the function `from` the name of its behaviour, in all sources. */
  async rename({ subsystem, function: name }: FunctionShown, from: string): Promise<void> {
    try {
      await this.draft.settled();
      const { files } = await this.api.renameFunction(this.draft.store.get().text, subsystem, from, name);
      await Promise.all([this.look(), ...files.filter((file) => file.startsWith("src/")).map((file) => this.open(file))]);
    } catch (error) {
      this.store.set({ problem: message(error) });
    }
  }

  /** Saves a source as a whole. false: another program has changed it, or it cannot be written. */
  async save(file: string, text: string): Promise<boolean> {
    const known = this.store.get().files.get(file);
    if (!known) return false;
    const { lineEnd } = known;
    try {
      const { revision } = await this.api.saveSource(file, withEnds(text, lineEnd), known.revision);
      this.turn(file);
      this.hold(file, { text, revision, lineEnd });
      await this.look();
      return true;
    } catch (error) {
      if (error instanceof ApiError && error.status === 409) {
        await this.open(file);
        this.store.set({ problem: `${file} was changed by another program. This is its text now: look at it, then save again.` });
      } else this.store.set({ problem: message(error) });
      return false;
    }
  }

  private turn(file: string): number {
    const turn = (this.turns.get(file) ?? 0) + 1;
    this.turns.set(file, turn);
    return turn;
  }

  private hold(file: string, content: SourceFile): void {
    this.store.set({ files: new Map(this.store.get().files).set(file, content), problem: "" });
  }
}
