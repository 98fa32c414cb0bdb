import type { Api } from "./api";
import { ApiError } from "./api";
import { message, type Draft } from "./draft";
import type { FunctionShown } from "./protocol";
import { Store } from "./store";

export interface SourcesState {
  /** The functions of the behaviours, of the last text without errors. */
  functions: readonly FunctionShown[];
  /** Sources that were opened, by name. */
  files: ReadonlyMap<string, { text: string; revision: string }>;
  problem: string;
}

/** The C++ functions of the behaviours, in the files of the project. */
export class Sources {
  readonly store = new Store<SourcesState>({ functions: [], files: new Map(), problem: "" });
  /** Unsaved text of functions, by "walker.control.follow": it stays while others are shown. */
  readonly unsaved = new Map<string, string>();
  private asked = 0;
  /** The number of the last request about a file; answers to earlier ones are late. */
  private turns = new Map<string, number>();

  constructor(
    private readonly api: Api,
    private readonly draft: Draft,
  ) {}

  /** Reads the positions of the functions. */
  async look(): Promise<void> {
    const asked = ++this.asked;
    try {
      const functions = await this.api.functions(this.draft.store.get().text);
      if (asked !== this.asked) return;
      this.store.set({ functions, problem: "" });
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
      if (this.turns.get(file) === turn) this.hold(file, content);
    } catch (error) {
      this.store.set({ problem: message(error) });
    }
  }

  /** Writes the beginning of a function that is missing. */
  async add({ subsystem, function: name }: FunctionShown): Promise<void> {
    try {
      const { file } = await this.api.addFunction(this.draft.store.get().text, subsystem, name);
      await Promise.all([this.look(), this.open(file)]);
    } catch (error) {
      this.store.set({ problem: message(error) });
    }
  }

  /** Gives the function `from` the name of its behaviour, in all sources. */
  async rename({ subsystem, function: name }: FunctionShown, from: string): Promise<void> {
    try {
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
    try {
      const { revision } = await this.api.saveSource(file, text, known.revision);
      this.turn(file);
      this.hold(file, { text, revision });
      await this.look();
      return true;
    } catch (error) {
      this.store.set({ problem: message(error) });
      return false;
    }
  }

  private turn(file: string): number {
    const turn = (this.turns.get(file) ?? 0) + 1;
    this.turns.set(file, turn);
    return turn;
  }

  private hold(file: string, content: { text: string; revision: string }): void {
    this.store.set({ files: new Map(this.store.get().files).set(file, content), problem: "" });
  }
}
