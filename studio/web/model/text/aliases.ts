import { isAlias, visit, type Document } from "yaml";

/** `*name` as a whole: the name of an alias, if there is such an anchor. */
export const aliasIn = (text: string) => /^\*([^\s,[\]{}]+)$/.exec(text)?.[1];

/** The names of all anchors before an offset. */
export function anchorsBefore(document: Document, offset: number): string[] {
  const names: string[] = [];
  visit(document, {
    Node: (_, node) => {
      if (!isAlias(node) && node.anchor && (node.range?.[0] ?? 0) < offset) names.push(node.anchor);
    },
  });
  return names;
}

/** The first alias without an anchor before it; undefined: there is none. */
export function lostAliasIn(document: Document): { name: string; offset: number } | undefined {
  const known = new Set<string>();
  let lost: { name: string; offset: number } | undefined;
  visit(document, {
    Node: (_, node) => {
      if (isAlias(node)) {
        if (!known.has(node.source)) lost ??= { name: node.source, offset: node.range?.[0] ?? 0 };
      } else if (node.anchor) known.add(node.anchor);
    },
  });
  return lost;
}
