import type { FileStep } from "../model/history";
import { structureOf, type Structure } from "../model/structure/structure";
import { applied, freeName, moved, pathAfter, pathNow, type At } from "../model/text/edits";
import { merge } from "../model/text/merge";
import type { YamlPath } from "../model/text/yaml_text";
import { ApiError, message, type Api } from "./api";
import type { Draft } from "./draft";
import type { Edit, EditAnswer, FileRenamed } from "../model/protocol";

/** The specification when an edit is done: other edits may have changed it since the user asked for it. */
export interface Now {
  structure: Structure;
  /** The present path of an element that the user saw at a path. */
  at: (path: At) => YamlPath;
}

/**
 * Edits that the user asks for, with the paths that the user saw. If they depend on more of the text, they are made when they
 * are done.
 */
export type Wish = Edit | Edit[] | ((now: Now) => Edit | Edit[]);

/** An edit that gives a new element a name, with a number if it is taken then. */
export function named(name: string, taken: (now: Now) => readonly string[], edit: (name: string) => Edit) {
  const given = {
    name,
    wish: (now: Now) => {
      given.name = freeName(name, taken(now));
      return edit(given.name);
    },
  };
  return given;
}

/** The names of the entries of a map. */
export const keysNow =
  (...maps: At[]) =>
  ({ structure, at }: Now) =>
    maps.flatMap((map) => structure.yaml.keys(at(map)));

/** before: the text before the edit. moved: the present path of an element that had a path in it. */
type Then = (before: string, moved: (at: At) => YamlPath) => void;

/** Between two questions to a server that does not answer. */
const pause_ms = 1000;

/** A wish, the text that the user saw, and the number of renames that were done then. */
interface Asked {
  wish: Wish;
  seen: string;
  renames: number;
}

/**
 * The edits of the specification that the server does, and the steps of undo and redo: one after the other, in the order of
 * the user. Until all are done, the draft is not saved.
 */
export class Editor {
  /** Saves what other parts of the page hold of the files that a rename changes. false: it is not saved. */
  saveOthers: () => Promise<boolean> = () => Promise.resolve(true);
  /** The renames that are done: an edit that was asked for meanwhile has the old names. */
  private readonly renamed: Edit[] = [];
  private agreed: (yes: boolean) => void = () => {};

  constructor(
    private readonly api: Api,
    private readonly draft: Draft,
  ) {}

  /** Reads the file, and what this tab had not saved before a reload. name: of the file, with its folder. */
  async load(name: Promise<string>): Promise<void> {
    for (const edits of await this.draft.load(name)) void this.change(edits);
  }

  /**
   * Does an edit. If a rename changes other files, the user is asked first; then the specification and all of them are
   * written together. then: called once the draft has the new text. false: it was not done, and a notice says why.
   */
  change(wish: Wish, then: Then = () => {}): Promise<boolean> {
    const asked = this.asked(wish);
    const forget = this.draft.keepEdits(this.editsOf(asked));
    return this.draft.queue.add(async () => {
      const done = await this.changeNow(asked, then);
      forget();
      return done;
    });
  }

  /** The text after an edit, which is not done; undefined: it cannot be done. */
  preview(wish: Wish): Promise<{ before: string; after: string; at: Now["at"] } | undefined> {
    const asked = this.asked(wish);
    return this.draft.queue.add(async () => {
      const before = this.draft.text;
      const answer = await this.answerTo(before, asked);
      return answer && { before, after: applied(before, answer.edits), at: this.now(asked).at };
    });
  }

  /** The answer of the user to a rename that changes other files. */
  agree(yes: boolean): void {
    this.agreed(yes);
  }

  undo = (): Promise<void> => this.step("undo");
  redo = (): Promise<void> => this.step("redo");

  private asked(wish: Wish): Asked {
    return { wish, seen: this.draft.text, renames: this.renamed.length };
  }

  private now({ seen, renames }: Asked): Now {
    const structure = structureOf(this.draft.text);
    const all = this.renamed.slice(renames);
    const at = (path: At) =>
      pathNow(path, (one) => all.reduce((now, renamed) => pathAfter(renamed, now), one), structureOf(seen).yaml, structure.yaml);
    return { structure, at };
  }

  private editsOf(asked: Asked): Edit[] {
    const now = this.now(asked);
    const { wish } = asked;
    return [typeof wish === "function" ? wish(now) : wish].flat().map((one) => moved(one, now.at));
  }

  private async answerTo(text: string, asked: Asked): Promise<(EditAnswer & { done: Edit[] }) | undefined> {
    try {
      const done = this.editsOf(asked);
      return { ...(await this.ask(text, done)), done };
    } catch (error) {
      this.draft.refused(message(error));
      return undefined;
    }
  }

  /** A server that is gone, or that has another key now, is asked again until it answers: the edit is nowhere else. */
  private async ask(text: string, edits: Edit[]): Promise<EditAnswer> {
    for (;;) {
      try {
        return await this.api.edit(text, edits);
      } catch (error) {
        if (!(error instanceof ApiError) || (error.status !== 0 && error.status !== 401)) throw error;
      }
      await new Promise((done) => setTimeout(done, pause_ms));
    }
  }

  private async changeNow(asked: Asked, then: Then): Promise<boolean> {
    for (;;) {
      const { text } = this.draft;
      this.draft.endTyping();
      const answer = await this.answerTo(text, asked);
      if (!answer) return false;
      if (answer.files.length > 0) {
        if (!(await this.renameEverywhere(asked, answer, then))) return false;
      } else {
        // Text that was typed meanwhile stays. If it is on the same lines, the edit is made of it.
        if (!this.draft.editOf(text, applied(text, answer.edits))) continue;
        this.ended(then, text, answer.done);
      }
      this.renamed.push(...answer.done.filter((one) => one.do === "rename"));
      return true;
    }
  }

  private async renameEverywhere(asked: Asked, { done, files }: { done: Edit[]; files: readonly FileRenamed[] }, then: Then) {
    this.draft.store.set({ renaming: { name: done[0]!.text ?? "", files } });
    const yes = await new Promise<boolean>((agreed) => (this.agreed = agreed));
    this.draft.store.set({ renaming: null });
    if (!yes) return false;
    if (this.draft.store.get().conflict) return this.draft.refused("the file was changed by another program");
    if (!(await this.saveOthers())) return this.draft.refused("a function is not saved");
    const { text } = this.draft;
    const answer = await this.answerTo(text, asked);
    if (!answer) return false;
    const after = applied(text, answer.edits);
    const changed = answer.files.filter(({ lines }) => lines.length > 0);
    const texts = changed.map((one) => ({ ...one, text: one.after }));
    if (!(await this.draft.write(after, texts))) return false;
    this.draft.edit(this.withTyped(text, after), "rename", changed);
    this.draft.keep();
    this.ended(then, text, answer.done);
    return true;
  }

  private ended(then: Then, before: string, done: readonly Edit[]): void {
    const renames = done.filter((one) => one.do === "rename");
    then(before, (at) => renames.reduce((now, renamed) => pathAfter(renamed, now), at) as YamlPath);
  }

  /** The text `after`, with what was typed since it was `before`. If both changed the same lines, undo leads to the typed ones. */
  private withTyped(before: string, after: string): string {
    return merge(before, after, this.draft.text) ?? after;
  }

  private async step(way: "undo" | "redo"): Promise<void> {
    const { draft } = this;
    if (!draft.queue.busy && !draft.ahead(way)?.files.length) return draft.step(way);
    await draft.queue.add(async () => {
      const ahead = draft.ahead(way);
      const { text } = draft;
      if (!ahead || (ahead.files.length > 0 && !(await this.stepFiles(ahead.text, ahead.files)))) return;
      if (draft.text === text) draft.step(way);
      else draft.edit(this.withTyped(text, ahead.text), "rename", ahead.files);
      draft.keep();
    });
  }

  /** Takes a change of files back, or does it again; what was changed elsewhere in them since then stays. */
  private async stepFiles(text: string, steps: readonly FileStep[]): Promise<boolean> {
    if (!(await this.saveOthers())) return this.draft.refused("a function is not saved");
    const files = [];
    for (const { file, before, after } of steps) {
      let now;
      try {
        now = await this.api.source(file);
      } catch (error) {
        return this.draft.refused(message(error));
      }
      const merged = merge(before, after, now.text);
      if (merged === null) return this.draft.refused(`the same lines of ${file} were changed since then. Rename it instead`);
      files.push({ file, text: merged, revision: now.revision });
    }
    return this.draft.write(text, files);
  }
}
