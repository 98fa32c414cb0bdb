/** Line by line: the differences of two texts, and the merge of two changes of one text. */

export interface Hunk {
  /** Lines [from, to) of the old text become `lines`. */
  from: number;
  to: number;
  lines: string[];
}

/** The smallest replacement that makes `before` into `after`: one splice. */
export function splice(before: string, after: string): { from: number; to: number; insert: string } {
  let start = 0;
  const shorter = Math.min(before.length, after.length);
  while (start < shorter && before[start] === after[start]) start += 1;
  let end = 0;
  while (end < shorter - start && before[before.length - 1 - end] === after[after.length - 1 - end]) end += 1;
  return { from: start, to: before.length - end, insert: after.slice(start, after.length - end) };
}

/** Hunks from `before` to `after`, by a longest common subsequence of lines. */
export function diff(before: readonly string[], after: readonly string[]): Hunk[] {
  let head = 0;
  while (head < before.length && head < after.length && before[head] === after[head]) head += 1;
  let tail = 0;
  while (
    tail < before.length - head &&
    tail < after.length - head &&
    before[before.length - 1 - tail] === after[after.length - 1 - tail]
  )
    tail += 1;
  const old = before.slice(head, before.length - tail);
  const fresh = after.slice(head, after.length - tail);
  // The texts are too different to be compared in a table: one hunk.
  if (old.length * fresh.length > 4_000_000) return [{ from: head, to: head + old.length, lines: fresh }];
  return hunksOf(old, fresh, commonTable(old, fresh)).map((hunk) => ({ ...hunk, from: hunk.from + head, to: hunk.to + head }));
}

function commonTable(a: readonly string[], b: readonly string[]): Uint32Array[] {
  const table = Array.from({ length: a.length + 1 }, () => new Uint32Array(b.length + 1));
  for (let i = a.length - 1; i >= 0; i -= 1)
    for (let j = b.length - 1; j >= 0; j -= 1)
      table[i]![j] = a[i] === b[j] ? table[i + 1]![j + 1]! + 1 : Math.max(table[i + 1]![j]!, table[i]![j + 1]!);
  return table;
}

function hunksOf(a: readonly string[], b: readonly string[], table: Uint32Array[]): Hunk[] {
  const hunks: Hunk[] = [];
  let [i, j] = [0, 0];
  while (i < a.length || j < b.length) {
    if (i < a.length && j < b.length && a[i] === b[j]) {
      i += 1;
      j += 1;
      continue;
    }
    const hunk: Hunk = { from: i, to: i, lines: [] };
    while ((i < a.length || j < b.length) && !(i < a.length && j < b.length && a[i] === b[j])) {
      if (j < b.length && (i === a.length || table[i]![j + 1]! >= table[i + 1]![j]!)) hunk.lines.push(b[j++]!);
      else i += 1;
    }
    hunk.to = i;
    hunks.push(hunk);
  }
  return hunks;
}

export type Side = "mine" | "theirs";

/** Lines of `base` that both changed, in different ways. */
export interface Clash {
  /** The first of these lines in `base`, from 1. */
  line: number;
  mine: string[];
  theirs: string[];
}

/** Both changes of one text: lines that are agreed on, and the clashes between them. */
export type Merged = (string[] | Clash)[];

const isClash = (part: string[] | Clash): part is Clash => !Array.isArray(part);
export const clashesIn = (parts: Merged): Clash[] => parts.filter(isClash);

/** Both changes in one text; of the lines that both changed, those of one side. */
export const taking = (parts: Merged, side: Side): string =>
  parts.flatMap((part) => (isClash(part) ? part[side] : part)).join("\n");

/** Two changes that share a line, or of which one inserts where the other changes. */
const touch = (a: Hunk, b: Hunk) =>
  a.from === a.to || b.from === b.to ? a.from <= b.to && b.from <= a.to : a.from < b.to && b.from < a.to;

/** The lines [from, to) of `base` after some hunks within. */
function changed(base: readonly string[], from: number, to: number, hunks: readonly Hunk[]): string[] {
  const lines: string[] = [];
  let at = from;
  for (const hunk of hunks) {
    lines.push(...base.slice(at, hunk.from), ...hunk.lines);
    at = hunk.to;
  }
  return [...lines, ...base.slice(at, to)];
}

/** Merges two changes of `base` line by line. A change of one side alone is taken from it. */
export function mergeLines(base: string, mine: string, theirs: string): Merged {
  const lines = base.split("\n");
  const left = [
    ...diff(lines, mine.split("\n")).map((hunk) => ({ hunk, side: "mine" as Side })),
    ...diff(lines, theirs.split("\n")).map((hunk) => ({ hunk, side: "theirs" as Side })),
  ].sort((a, b) => a.hunk.from - b.hunk.from || a.hunk.to - b.hunk.to);
  const parts: Merged = [];
  let at = 0;
  while (left.length > 0) {
    const group = [left.shift()!];
    // Hunks of one side do not touch: each further one touches one of the other side.
    while (left[0] && group.some((one) => one.side !== left[0]!.side && touch(one.hunk, left[0]!.hunk)))
      group.push(left.shift()!);
    const from = group[0]!.hunk.from;
    const to = Math.max(...group.map(({ hunk }) => hunk.to));
    const of = (side: Side) =>
      changed(
        lines,
        from,
        to,
        group.filter((one) => one.side === side).map(({ hunk }) => hunk),
      );
    const [own, other] = [of("mine"), of("theirs")];
    const both = group.some(({ side }) => side === "mine") && group.some(({ side }) => side === "theirs");
    parts.push(lines.slice(at, from));
    if (both && own.join("\n") !== other.join("\n")) parts.push({ line: from + 1, mine: own, theirs: other });
    else parts.push(group[0]!.side === "mine" ? own : other);
    at = to;
  }
  parts.push(lines.slice(at));
  return parts;
}

/** Both changes of `base` in one text, or null if they changed the same lines in different ways. */
export function merge(base: string, mine: string, theirs: string): string | null {
  const parts = mergeLines(base, mine, theirs);
  return clashesIn(parts).length > 0 ? null : taking(parts, "mine");
}
