import type { Edit } from "../protocol";
import type { Behaviour } from "../structure/structure";
import { addNext, changeNext, set } from "./edits";

/** A new arrow from a behaviour: the entry of `next`, and whether its condition also ends the behaviour. */
export interface NewArrow {
  to: string;
  /** Empty: always. */
  when: string;
  ends: boolean;
}

/** Conditions with a meaning of their own: an ending that is a failure, and a condition that is asked in a group. */
const endings = ["error", "until"];
const isName = (condition: string) => /^\w+$/.test(condition);
const bracketed = (condition: string) => (/&&|\?/.test(condition) ? `(${condition})` : condition);
const alternatives = (condition: string) => condition.split("||").map((one) => one.trim());

/** The terminal condition with which a behaviour also ends when `when` holds; undefined: it cannot be made of the two. */
export function terminalWith({ isGroup, terminal }: Pick<Behaviour, "isGroup" | "terminal">, when: string): string | undefined {
  if (isGroup || when === "" || endings.includes(when) || terminal === "true") return undefined;
  if (terminal === "") return when;
  // Endings with names are chosen by their names, and names of conditions stand alone.
  if (/^[{|>&*]|\n/.test(terminal) || isName(terminal) || isName(when)) return undefined;
  if (alternatives(terminal).includes(when)) return undefined;
  return `${bracketed(terminal)} || ${bracketed(when)}`;
}

/**
 * Edits that add an arrow. If its condition ends the behaviour, it becomes the terminal condition or a part of it, since
 * `next` is asked only after the end. An arrow with a condition stands before the one that is always taken.
 */
export function arrowEdits(behaviour: Behaviour, { to, when, ends }: NewArrow): { edits: Edit[]; entry: number } {
  const { next, yaml } = behaviour;
  const terminal = ends ? terminalWith(behaviour, when) : undefined;
  const edits = terminal === undefined ? [] : [set(yaml, "terminal", terminal)];
  const only = terminal !== undefined && behaviour.terminal === "" && !next.some((one) => one.when !== "error");
  const condition = only ? "" : when;
  const always = next.findIndex((one) => one.when === "");
  if (always < 0 || condition === "" || condition === "error")
    return { edits: [...edits, addNext(behaviour, { to, when: condition })], entry: next.length };
  const old = next[always]!;
  return {
    edits: [
      ...edits,
      changeNext(behaviour, always, { to, when: condition, sets: "" }),
      addNext(behaviour, { to: old.to, when: "", sets: old.sets }),
    ],
    entry: always,
  };
}
