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

/** Both changes of `base` in one text, or null when they touch the same or neighbouring lines. */
export function merge(base: string, mine: string, theirs: string): string | null {
  if (mine === theirs || base === theirs) return mine;
  if (base === mine) return theirs;
  const lines = base.split("\n");
  const own = diff(lines, mine.split("\n"));
  const other = diff(lines, theirs.split("\n"));
  for (const a of own) for (const b of other) if (a.from <= b.to && b.from <= a.to && !same(a, b)) return null;
  const hunks = [...own, ...other.filter((b) => !own.some((a) => same(a, b)))].sort((a, b) => b.from - a.from);
  for (const hunk of hunks) lines.splice(hunk.from, hunk.to - hunk.from, ...hunk.lines);
  return lines.join("\n");
}

const same = (a: Hunk, b: Hunk) => a.from === b.from && a.to === b.to && a.lines.join("\n") === b.lines.join("\n");
