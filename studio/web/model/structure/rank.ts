/**
 * The matches of a search, best first. Every word must occur, in any order; shorter and
 * later matches rank higher.
 */
export function rank<T>(text: string, all: readonly T[], nameOf: (one: T) => string): T[] {
  const words = text.toLowerCase().split(/\s+/).filter(Boolean);
  if (words.length === 0) return [...all];
  const scored: { one: T; score: number }[] = [];
  for (const one of all) {
    const name = nameOf(one).toLowerCase();
    if (!words.every((word) => name.includes(word))) continue;
    const last = words[words.length - 1]!;
    const whole = name === text.toLowerCase() ? -1000 : 0;
    const atEnd = name.endsWith(last) ? -50 : 0;
    scored.push({ one, score: whole + atEnd + name.length });
  }
  return scored.sort((a, b) => a.score - b.score).map(({ one }) => one);
}
