import { History, type FileStep } from "../model/history";
import { after, applied } from "../model/text/edits";
import { lineEndOf, withEnds, withFeeds, type LineEnd } from "../model/text/line_ends";
import { merge, mergeLines, taking, type Side } from "../model/text/merge";
import { NetModel } from "../model/net/net";
import { Api, ApiError, message } from "./api";
import type { Analysis, Diagnostic, Edit, EditAnswer, FileRenamed, SpecAnswer } from "./protocol";
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
  /** Saves what other parts of the page hold of the files that a rename changes. false: it is not saved. */
  saveOthers: () => Promise<boolean> = () => Promise.resolve(true);
  /** Called with the names of files that this page has written. */
  wrote: (files: readonly string[]) => void = () => {};
  /** The edits that the server is asked for, one after the other. */
  private editing: Promise<unknown> = Promise.resolve();
  private waiting = 0;
  /** The renames that are done: an edit that was asked for meanwhile has the old names. */
  private readonly renamed: Edit[] = [];
  private agreed: (yes: boolean) => void = () => {};
  private name = "";
  /** The key under which this tab keeps unsaved text. Each project has its own: another may be served at this address. */
  private kept = "";
  private lineEnd: LineEnd = "\n";
  private saving: Promise<boolean> | null = null;
  private history = new History("");
  private timer: ReturnType<typeof setTimeout> | undefined;
  private asked = 0;

  constructor(private readonly api: Api) {}

  get dirty(): boolean {
    return this.store.get().text !== this.store.get().saved;
  }

  /** Reads the file, and restores text that this tab had not saved before a reload. name: of the file, with its folder. */
  async load(name: Promise<string>): Promise<void> {
    const [answer, of] = await Promise.all([this.api.spec(), name]);
    this.kept = `tessera.draft ${of}`;
    this.name = of.split("/").at(-1)!;
    const file = this.fileOf(answer);
    this.history = new History(file.text);
    this.onDisk(file);
    const { text, base } = JSON.parse(sessionStorage.getItem(this.kept) ?? "{}") as { text?: string; base?: string };
    this.store.set({ text: file.text, loaded: true });
    this.analysed(answer.analysis.diagnostics, netOf(answer.analysis, file.text));
    if (text === undefined || text === file.text) return;
    const merged = merge(base ?? file.text, text, file.text);
    this.edit(merged ?? text, "reload");
    if (merged === null) this.ask(file, base ?? file.text);
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
   * Does an edit. If a rename changes other files, the user is asked first; then the specification and all of them are
   * written together. then: called with the new text. false: it was not done, and a notice says why.
   */
  change(edit: Edit | Edit[], then: () => void = () => {}): Promise<boolean> {
    const known = this.renamed.length;
    const now = (one: Edit) => this.renamed.slice(known).reduce((all, renamed) => after(renamed, all), one);
    return this.queued(async () => {
      const edits = [edit].flat().map(now);
      const done = await this.changeNow(edits, then);
      if (done) this.renamed.push(...edits.filter((one) => one.do === "rename"));
      return done;
    });
  }

  /** The text after an edit, which is not done; undefined: it cannot be done. */
  async preview(edit: Edit): Promise<{ before: string; after: string } | undefined> {
    await this.settled();
    const before = this.store.get().text;
    const answer = await this.answerTo(before, edit);
    return answer && { before, after: applied(before, answer.edits) };
  }

  /** All edits so far are done or refused. */
  async settled(): Promise<void> {
    await this.editing;
  }

  private queued<T>(work: () => Promise<T>): Promise<T> {
    this.waiting += 1;
    this.store.set({ editing: true });
    const done = this.editing.then(work).finally(() => {
      this.waiting -= 1;
      this.store.set({ editing: this.waiting > 0 });
    });
    this.editing = done.catch(() => undefined);
    return done;
  }

  private refused(why: string): false {
    this.store.set({ notice: `Not changed: ${why}` });
    return false;
  }

  private async answerTo(text: string, edit: Edit | Edit[]): Promise<EditAnswer | undefined> {
    try {
      return await this.api.edit(text, edit);
    } catch (error) {
      this.refused(message(error));
      return undefined;
    }
  }

  private async changeNow(edit: Edit[], then: () => void): Promise<boolean> {
    // Text that was typed meanwhile stays.
    for (;;) {
      const { text } = this.store.get();
      const answer = await this.answerTo(text, edit);
      if (!answer) return false;
      if (this.store.get().text !== text) continue;
      if (answer.files.length > 0) return this.renameEverywhere(edit, answer.files, then);
      this.edit(applied(text, answer.edits), "edit");
      then();
      return true;
    }
  }

  /** The answer of the user to a rename that changes other files. */
  agree(yes: boolean): void {
    this.agreed(yes);
  }

  private async renameEverywhere(edit: Edit[], files: readonly FileRenamed[], then: () => void): Promise<boolean> {
    this.store.set({ renaming: { name: edit[0]!.text ?? "", files } });
    const yes = await new Promise<boolean>((agreed) => (this.agreed = agreed));
    this.store.set({ renaming: null });
    if (!yes) return false;
    if (this.store.get().conflict) return this.refused("the file was changed by another program");
    if (!(await this.saveOthers())) return this.refused("a function is not saved");
    const { text } = this.store.get();
    const answer = await this.answerTo(text, edit);
    if (!answer) return false;
    const after = applied(text, answer.edits);
    const changed = answer.files.filter(({ lines }) => lines.length > 0);
    const texts = changed.map((one) => ({ ...one, text: one.after }));
    if (!(await this.write(after, texts))) return false;
    this.edit(this.withTyped(text, after), "rename", changed);
    this.keep();
    then();
    return true;
  }

  /** The text `after`, with what was typed since it was `before`. If both changed the same lines, undo leads to the typed ones. */
  private withTyped(before: string, after: string): string {
    return merge(before, after, this.store.get().text) ?? after;
  }

  /** Writes the specification and other files together. */
  private async write(text: string, others: readonly { file: string; text: string; revision: string }[]): Promise<boolean> {
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

  undo = (): Promise<void> => this.step("undo");
  redo = (): Promise<void> => this.step("redo");

  private async step(way: "undo" | "redo"): Promise<void> {
    if (this.waiting === 0 && !this.history.ahead(way)?.files.length) return this.show(this.history[way]());
    await this.queued(async () => {
      const ahead = this.history.ahead(way);
      const { text } = this.store.get();
      if (!ahead || (ahead.files.length > 0 && !(await this.stepFiles(ahead.text, ahead.files)))) return;
      if (this.store.get().text === text) this.show(this.history[way]());
      else this.edit(this.withTyped(text, ahead.text), "rename", ahead.files);
      this.keep();
    });
  }

  /** Takes a change of files back, or does it again; what was changed elsewhere in them since then stays. */
  private async stepFiles(text: string, steps: readonly FileStep[]): Promise<boolean> {
    if (!(await this.saveOthers())) return this.refused("a function is not saved");
    const files = [];
    for (const { file, before, after } of steps) {
      let now;
      try {
        now = await this.api.source(file);
      } catch (error) {
        return this.refused(message(error));
      }
      const merged = merge(before, after, now.text);
      if (merged === null) return this.refused(`the same lines of ${file} were changed since then. Rename it instead`);
      files.push({ file, text: merged, revision: now.revision });
    }
    return this.write(text, files);
  }

  private show(text: string | undefined): void {
    if (text === undefined) return;
    this.store.set({ text, canUndo: this.history.canUndo, canRedo: this.history.canRedo, checking: true });
    this.keep();
    clearTimeout(this.timer);
    this.timer = setTimeout(() => void this.check(), 120);
  }

  private keep(): void {
    const { text, saved, conflict } = this.store.get();
    if (text === saved) sessionStorage.removeItem(this.kept);
    else sessionStorage.setItem(this.kept, JSON.stringify({ text, base: conflict?.base ?? saved }));
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
    await this.saving;
    if (revision === this.store.get().revision) return this.asBefore();
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
