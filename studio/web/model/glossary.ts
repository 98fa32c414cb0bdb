/** The meanings of terms, read from the glossary of the documents: docs/reference/glossary.md is their one home. */

/** Reads entries such as "* **rate**: how often a *subsystem* ..."; a term also has the names in backquotes that follow it. */
export function readGlossary(text: string): ReadonlyMap<string, string> {
  const found = new Map<string, string>();
  for (const entry of text.split(/^\* (?=\*\*)/m).slice(1)) {
    const line = entry.replace(/\s+/g, " ").trim();
    const [head = "", ...rest] = line.split(/: /);
    const names = [...head.matchAll(/\*\*([^*]+)\*\*|`([^`]+)`/g)].map(([, bold, code]) => (bold ?? code)!);
    const meaning = firstSentence(plain(rest.join(": ")));
    for (const name of names) if (!found.has(name.toLowerCase())) found.set(name.toLowerCase(), meaning);
  }
  return found;
}

/** Without the marks of Markdown. */
const plain = (text: string) =>
  text
    .replace(/\[([^\]]*)\]\([^)]*\)/g, "$1")
    .replace(/\s*\([\w./#-]+\.md[^)]*\)/g, "")
    .replace(/\*([^*]+)\*/g, "$1")
    .replace(/`([^`]+)`/g, "$1");

const firstSentence = (text: string) =>
  `${/^(.*?[^.])(?:\.(?=\s|$)|$)/.exec(text)?.[1] ?? text}.`.replace(/^./, (one) => one.toUpperCase());

/** The meaning of a term, or of a property by its name in the protocol; singular and plural are one term. */
export function meaningOf(glossary: ReadonlyMap<string, string>, term: string): string | undefined {
  const name = term.toLowerCase();
  return (
    glossary.get(name) ?? glossary.get(name.replaceAll("_", " ")) ?? glossary.get(name.replace(/ies$/, "y").replace(/s$/, ""))
  );
}
