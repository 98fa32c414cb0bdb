import { History, type FileStep } from "../model/history";
import { lineEndOf, withEnds, withFeeds, type LineEnd } from "../model/text/line_ends";
import type { BoxChange } from "../model/structure/box_changes";
import { merge, mergeLines, taking, type Side } from "../model/text/merge";
import { NetModel } from "../model/net/net";
import { Api, ApiError, message } from "./api";
import type { Analysis, Diagnostic, Edit, FileRenamed, SpecAnswer } from "../model/protocol";
import { Queue } from "../model/queue";
import { Store } from "./store";

export interface DraftState {
  text: string;
  /** The text on disk as far as known, and its revision. */
  saved: string;
  revision: string;
  diagnostics: Diagnostic[];
  /** The net of the last text that had one. */
  net: NetModel | null;
  /** Whether the net belongs to the current text. */
  current: boolean;
  checking: boolean;
  loaded: boolean;
  canUndo: boolean;
  canRedo: boolean;
  /** The file on disk, if it changed where this page changed it, too; and the text that both have changed. */
  conflict: (File & { base: string }) | null;
  /** Why the file on disk cannot be read; empty: it can. */
  unreadable: string;
  notice: string;
  /** Whether an edit is not done yet. */
  editing: boolean;
  /** A rename that changes other files too, until the user agrees. */
  renaming: { name: string; files: readonly FileRenamed[] } | null;
}

/** The file on disk, with lines that end as the page has them. */
interface File {
  text: string;
  revision: string;
}

/** A tab keeps this until it is saved: its text, the text on disk that this began with, and edits that are not done. */
interface Kept {
  text?: string;
  base?: string;
  edits?: Edit[][];
}

/** Whether something is not in the file: an edit that is not done yet is neither. */
export const isUnsaved = ({ text, saved, editing }: DraftState) => editing || text !== saved;

const netOf = ({ net, net_hash }: Analysis, text: string) => (net ? new NetModel(net, net_hash ?? "", text) : null);

/**
 * The specification in the editor: one text, its history, the server's results for
 * it, and the file on disk.
 */
export class Draft {
  readonly store = new Store<DraftState>({
    text: "",
    saved: "",
    revision: "",
    diagnostics: [],
    net: null,
    current: false,
    checking: false,
    loaded: false,
    canUndo: false,
    canRedo: false,
    conflict: null,
    unreadable: "",
    notice: "",
    editing: false,
    renaming: null,
  });
  /** Called with the names of files that this page has written. */
  wrote: (files: readonly string[]) => void = () => {};
  /** Called with the boxes that undo or redo moves. */
  takeBoxes: (change: BoxChange) => void = () => {};
  /** The edits that are not done yet, and all that has to wait for them. */
  readonly queue = new Queue((editing) => this.store.set({ editing }));
  /** These edits, so that a reload does not forget them. */
  private waiting: Edit[][] = [];
  private name = "";
  /** The key under which this tab keeps unsaved text. Each project has its own: another may be served at this address. */
  private kept = "";
  private lineEnd: LineEnd = "\n";
  private saving: Promise<boolean> | null = null;
  private history = new History("");
  private timer: ReturnType<typeof setTimeout> | undefined;
  private asked = 0;

  constructor(private readonly api: Api) {}

  get text(): string {
    return this.store.get().text;
  }

  get dirty(): boolean {
    return isUnsaved(this.store.get());
  }

  /**
   * Reads the file, and restores text that this tab had not saved before a reload. name: of the file, with its folder. Gives
   * the edits that were not done then.
   */
  async load(name: Promise<string>): Promise<Edit[][]> {
    const [answer, of] = await Promise.all([this.api.spec(), name]);
    this.kept = `tessera.draft ${of}`;
    this.name = of.split("/").at(-1)!;
    const file = this.fileOf(answer);
    this.history = new History(file.text);
    this.onDisk(file);
    const { text, base, edits = [] } = JSON.parse(sessionStorage.getItem(this.kept) ?? "{}") as Kept;
    this.store.set({ text: file.text, loaded: true });
    this.analysed(answer.analysis.diagnostics, netOf(answer.analysis, file.text));
    if (text === undefined || text === file.text) return edits;
    const merged = merge(base ?? file.text, text, file.text);
    this.edit(merged ?? text, "reload");
    if (merged === null) this.ask(file, base ?? file.text);
    return edits;
  }

  /** Asks about the lines that both changed. Until then, this tab keeps the text that they were before. */
  private ask(file: File, base: string): void {
    this.store.set({ conflict: { ...file, base } });
    this.keep();
  }

  /** The file of an answer. Whether it can be read, and how its lines end, is noted. */
  private fileOf({ text, revision, error }: Pick<SpecAnswer, "text" | "revision" | "error">): File {
    // A file that is missing reads as empty, and may be written.
    this.store.set({ unreadable: revision === "" ? (error ?? "") : "" });
    if (text !== "") this.lineEnd = lineEndOf(text);
    return { text: withFeeds(text), revision };
  }

  private onDisk(file: File): void {
    this.store.set({ saved: file.text, revision: file.revision, conflict: null });
  }

  private analysed(diagnostics: Diagnostic[], net: NetModel | null): void {
    this.store.set({ diagnostics, current: net !== null, checking: false, ...(net ? { net } : {}) });
  }

  /** A new text. Changes with the same `kind`, such as "typing", are undone together. */
  edit(text: string, kind: string, files: readonly FileStep[] = []): void {
    if (text === this.store.get().text) return;
    this.history.change(text, kind, performance.now(), files);
    this.show(text);
  }

  /**
   * An edit of the text `before`. Text typed since then stays, and is the first that is undone. false: it is not done,
   * since the same lines were changed.
   */
  editOf(before: string, after: string): boolean {
    if (before === after) return true;
    if (!this.history.insert(before, after, performance.now(), merge)) return false;
    this.show(this.history.current);
    return true;
  }

  /** Text typed from now on is a step of its own. */
  endTyping(): void {
    this.history.endTyping();
  }

  /** Keeps edits that are asked for in this tab, until the function that it gives is called. */
  keepEdits(edits: Edit[]): () => void {
    this.waiting.push(edits);
    this.keep();
    return () => {
      this.waiting = this.waiting.filter((one) => one !== edits);
      this.keep();
    };
  }

  /** All edits so far are done or refused. */
  settled(): Promise<void> {
    return this.queue.settled();
  }

  /** Tells why an edit is not done. */
  refused(why: string): false {
    this.store.set({ notice: `Not changed: ${why}` });
    return false;
  }

  /** Writes the specification and other files together. */
  async write(text: string, others: readonly { file: string; text: string; revision: string }[]): Promise<boolean> {
    while (this.saving) await this.saving;
    this.saving = this.writeNow(text, others);
    const written = await this.saving;
    this.saving = null;
    return written;
  }

  private async writeNow(text: string, others: readonly { file: string; text: string; revision: string }[]): Promise<boolean> {
    const { revision } = this.store.get();
    const own = { file: this.name, text: withEnds(text, this.lineEnd), revision };
    try {
      const { files } = await this.api.saveFiles([own, ...others.map(({ file, text, revision }) => ({ file, text, revision }))]);
      this.onDisk({ text, revision: files[0]!.revision });
      this.wrote(others.map(({ file }) => file));
      return true;
    } catch (error) {
      return this.refused(message(error));
    }
  }

  /** The text and the files that undo or redo leads to; undefined: there is none. */
  ahead(way: "undo" | "redo") {
    return this.history.ahead(way);
  }

  step(way: "undo" | "redo"): void {
    const boxes = this.history.ahead(way)?.boxes;
    this.show(this.history[way]());
    if (boxes) this.takeBoxes(boxes);
  }

  /** Boxes of the drawing were moved: undo moves them back. */
  boxesMoved(change: BoxChange, kind: string): void {
    this.history.moved(change, kind, performance.now());
    this.store.set({ canUndo: this.history.canUndo, canRedo: this.history.canRedo });
  }

  /** Boxes have other names with the last edit. */
  boxesRenamed(change: BoxChange): void {
    this.history.alsoMoved(change);
  }

  private show(text: string | undefined): void {
    if (text === undefined) return;
    const { canUndo, canRedo } = this.history;
    if (text === this.store.get().text) return this.store.set({ canUndo, canRedo });
    this.store.set({ text, canUndo: this.history.canUndo, canRedo: this.history.canRedo, checking: true });
    this.keep();
    clearTimeout(this.timer);
    this.timer = setTimeout(() => void this.check(), 120);
  }

  /** Keeps in this tab what is not saved. */
  keep(): void {
    const { text, saved, conflict } = this.store.get();
    const edits = this.waiting;
    if (text === saved && edits.length === 0) sessionStorage.removeItem(this.kept);
    else sessionStorage.setItem(this.kept, JSON.stringify({ text, base: conflict?.base ?? saved, edits }));
  }

  private async check(): Promise<void> {
    const { text } = this.store.get();
    const asked = ++this.asked;
    try {
      const analysis = await this.api.check(text);
      if (asked === this.asked) this.analysed(analysis.diagnostics, netOf(analysis, text));
    } catch (error) {
      if (asked === this.asked) this.store.set({ checking: false, notice: message(error) });
    }
  }

  /** One save follows another: the second names the revision that the first has made. */
  async save(): Promise<boolean> {
    await this.settled();
    while (this.saving) await this.saving;
    this.saving = this.saveNow();
    const saved = await this.saving;
    this.saving = null;
    return saved;
  }

  private async saveNow(): Promise<boolean> {
    const { text, revision } = this.store.get();
    try {
      const answer = await this.api.save(withEnds(text, this.lineEnd), revision);
      this.onDisk({ text, revision: answer.revision });
      this.keep();
      this.store.set({ notice: "Saved" });
      return true;
    } catch (error) {
      if (error instanceof ApiError && error.status === 409)
        this.disk(this.fileOf({ text: String(error.body.text ?? ""), revision: String(error.body.revision ?? ""), error: null }));
      else this.store.set({ notice: message(error) });
      return false;
    }
  }

  /** The server reports that the file changed on disk. */
  async changedOnDisk(revision: string): Promise<void> {
    // Edits that are not done yet are changes of this page, too.
    await this.settled();
    await this.saving;
    if (revision === this.store.get().revision) {
      this.asBefore();
      // An included file may have changed, and with it the meaning of the same text.
      return this.check();
    }
    let answer: SpecAnswer;
    try {
      answer = await this.api.spec();
    } catch (error) {
      this.store.set({ notice: message(error) });
      return;
    }
    await this.saving;
    const file = this.fileOf(answer);
    if (file.revision === "") this.store.set({ notice: `The file on disk cannot be read: ${answer.error}` });
    else if (file.revision !== this.store.get().revision) this.disk(file);
    else this.asBefore();
  }

  /** The file has the revision of this page: another program has undone its change. A conflict that was there after a reload stays. */
  private asBefore(): void {
    const { conflict, revision } = this.store.get();
    if (conflict?.revision !== revision) this.store.set({ conflict: null });
  }

  /** Takes the content on disk, merges it with the changes of this page, or asks. */
  private disk(file: File): void {
    const { text, saved, conflict } = this.store.get();
    if (file.text === text) {
      this.onDisk(file);
      this.keep();
      return;
    }
    const base = conflict?.base ?? saved;
    const merged = merge(base, text, file.text);
    if (merged === null) return this.ask(file, base);
    const unsaved = text !== saved;
    this.onDisk(file);
    this.edit(merged, "disk");
    this.store.set({
      notice:
        file.text === ""
          ? "The file on disk is gone or empty. Undo brings its text back"
          : unsaved
            ? "The file changed on disk; both changes were merged"
            : "The file changed on disk; reloaded",
    });
  }

  /**
   * The answer to a conflict: whose lines are taken where both changed them. Elsewhere, both changes are. In each case, undo
   * leads back to the other text.
   */
  resolve(side: Side): void {
    const { conflict, text } = this.store.get();
    if (!conflict) return;
    const parts = mergeLines(conflict.base, text, conflict.text);
    this.onDisk({ text: conflict.text, revision: conflict.revision });
    this.edit(taking(parts, "theirs"), "disk");
    if (side === "mine") this.edit(taking(parts, "mine"), "mine");
    this.keep();
  }
}
