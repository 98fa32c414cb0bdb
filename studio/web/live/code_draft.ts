import { functionAt, type FunctionText } from "../model/text/cpp_function";
import { merge } from "../model/text/merge";
import type { FunctionShown } from "../model/protocol";

/** Text of a function that is not saved yet, and the text of the file that it was made of. */
export interface Edited {
  text: string;
  base: string;
}

export const nameOf = ({ subsystem, function: name }: Pick<FunctionShown, "subsystem" | "function">) => `${subsystem}.${name}`;

/** The function in a source; null: it is not at its line, for example since the source is newer. */
export function functionIn(source: string | undefined, known: FunctionShown): FunctionText | null {
  if (source === undefined || !known.line) return null;
  const line = source.split("\n")[known.line - 1] ?? "";
  return new RegExp(`\\b${known.function}\\b`).test(line) ? functionAt(source, known.line) : null;
}

/** The text of a function to show if its file has changed since the edit began; null: both changed the same lines. */
export function edited(held: Edited | undefined, inFile: string): Edited | null {
  if (!held) return { text: inFile, base: inFile };
  if (held.base === inFile) return held;
  const text = merge(held.base, held.text, inFile);
  return text === null ? null : { text, base: inFile };
}

/** C++ that is not saved, by "walker.control.follow". It stays in the tab after a reload. */
export class CodeDraft {
  private held = new Map<string, Edited>();
  private key = "";

  /** project: its folder. Restores what this tab had of it. */
  restore(project: string): void {
    this.key = `tessera.code ${project}`;
    this.held = new Map(JSON.parse(sessionStorage.getItem(this.key) ?? "[]") as [string, Edited][]);
  }

  get names(): string[] {
    return [...this.held.keys()];
  }

  get(name: string): Edited | undefined {
    return this.held.get(name);
  }

  /** A text like that in the file needs not be kept. */
  set(name: string, { text, base }: Edited): void {
    if (text === base) this.held.delete(name);
    else this.held.set(name, { text, base });
    if (this.held.size === 0) sessionStorage.removeItem(this.key);
    else sessionStorage.setItem(this.key, JSON.stringify([...this.held]));
  }
}
