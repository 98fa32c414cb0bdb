import {
  isAlias,
  isCollection,
  isMap,
  isPair,
  isScalar,
  isSeq,
  LineCounter,
  parseDocument,
  type Document,
  type Node,
  type Pair,
  type YAMLMap,
  type YAMLSeq,
} from "yaml";

/** The specification as a text: its values for the forms, and their positions. The server edits it. */

export type YamlPath = readonly (string | number)[];

type PairOf = Pair<Node, Node | null>;

export class YamlText {
  readonly document: Document;
  private readonly lines = new LineCounter();

  constructor(readonly text: string) {
    this.document = parseDocument(text, { lineCounter: this.lines, keepSourceTokens: false });
  }

  /** The node at a path, not followed through aliases; undefined: there is none. */
  node(path: YamlPath): Node | undefined {
    const found = path.length === 0 ? this.document.contents : this.document.getIn(path as (string | number)[], true);
    return (found as Node | null | undefined) ?? undefined;
  }

  /** Whether an alias stands at a path. Its value is written elsewhere, and is changed there. */
  isAlias(path: YamlPath): boolean {
    return isAlias(this.node(path));
  }

  map(path: YamlPath): YAMLMap<Node, Node | null> | undefined {
    const node = this.node(path);
    return isMap(node) ? (node as unknown as YAMLMap<Node, Node | null>) : undefined;
  }

  seq(path: YamlPath): YAMLSeq<Node> | undefined {
    const node = this.node(path);
    return isSeq(node) ? (node as YAMLSeq<Node>) : undefined;
  }

  keys(path: YamlPath): string[] {
    return this.map(path)?.items.map((pair) => keyText(pair)) ?? [];
  }

  /** The value of a scalar, or the text of any other node in the file. */
  valueText(path: YamlPath): string | undefined {
    const node = this.node(path);
    if (!node || !node.range) return undefined;
    if (isScalar(node))
      return node.value === null ? "" : typeof node.value === "string" ? node.value : (node.source ?? String(node.value));
    return this.text.slice(node.range[0], node.range[1]).trim();
  }

  /** valueText of the value that an alias stands for. */
  followedText(path: YamlPath): string | undefined {
    const node = this.node(path);
    if (!isAlias(node)) return this.valueText(path);
    const meant = node.resolve(this.document);
    if (isScalar(meant)) return String(meant.value ?? "");
    return meant?.range ? this.text.slice(meant.range[0], meant.range[1]).trim() : node.toString();
  }

  /** valueText in one line: lists and maps as [a, b] and { a: b }. */
  lineText(path: YamlPath): string {
    const text = this.valueText(path) ?? "";
    const node = this.node(path);
    const isLine = !(isMap(node) || isSeq(node)) || (node.flow && !text.includes("\n"));
    return isLine ? text : this.flow(node);
  }

  private flow(node: unknown): string {
    if (isSeq(node)) return `[${node.items.map((item) => this.flow(item)).join(", ")}]`;
    if (isMap(node)) {
      const entries = node.items.map(({ key, value }) => {
        const text = this.flow(value);
        return this.flow(key) + (text && `: ${text}`);
      });
      return `{ ${entries.join(", ")} }`;
    }
    if (isAlias(node)) return `*${node.source}`;
    if (!isScalar(node) || node.value === null) return "";
    const source = node.source ?? String(node.value);
    const isPlain = node.type === "PLAIN" || node.type === undefined;
    return isPlain && !/[[\]{},]/.test(source) ? source : JSON.stringify(String(node.value));
  }

  pair(path: YamlPath): PairOf | undefined {
    const map = this.map(path.slice(0, -1));
    return map?.items.find((pair) => keyText(pair) === path.at(-1));
  }

  /** Line of the key or item at a path, from 1; 0: not there. */
  line(path: YamlPath): number {
    const at = this.pair(path)?.key.range?.[0] ?? this.node(path)?.range?.[0];
    return at === undefined ? 0 : this.lines.linePos(at).line;
  }

  endLine(path: YamlPath): number {
    const pair = this.pair(path);
    const end = pair ? this.endOf(pair) : (this.node(path)?.range?.[1] ?? 0);
    return this.lines.linePos(Math.max(0, end - 1)).line;
  }

  /** The value at a path as data, with empty maps and lists inside; undefined: there is none, or an alias. */
  data(path: YamlPath): unknown {
    const plain = (node: unknown) => (isScalar(node) ? node.value : isMap(node) ? {} : isSeq(node) ? [] : null);
    const node = this.node(path);
    if (isMap(node)) return Object.fromEntries(node.items.map((pair) => [keyText(pair), plain(pair.value)]));
    return isSeq(node) ? node.items.map(plain) : isScalar(node) ? node.value : undefined;
  }

  /** The characters of the entry or item at a path, with its key; null: not there. */
  range(path: YamlPath): [number, number] | null {
    const pair = this.pair(path);
    if (pair) return [pair.key.range![0], this.endOf(pair)];
    const node = this.node(path);
    return node?.range ? [node.range[0], this.endOf(node)] : null;
  }

  /** The offset of a line and a column, both from 1. */
  offset(line: number, column: number): number {
    return (this.lines.lineStarts[line - 1] ?? this.text.length) + column - 1;
  }

  /** The end of an entry, without the comments and empty lines after it. */
  private endOf(item: PairOf | Node): number {
    if (!isPair(item)) return this.endOfNode(item as Node);
    const { key, value } = item as PairOf;
    const end = key.range![1];
    if (value?.range && value.range[1] > end) return this.endOfNode(value);
    // Behind the colon, or behind a key without one: `{ in, out }`.
    return end + (/^[ \t]*:/.exec(this.text.slice(end))?.[0].length ?? 0);
  }

  private endOfNode(node: Node): number {
    if (isCollection(node) && !node.flow && node.items.length > 0) return this.endOf(node.items.at(-1) as PairOf | Node);
    const [start, end] = node.range!;
    // The range of a block text (`|`, `>`) ends at the start of the next line.
    const isBlockText = isScalar(node) && (node.type === "BLOCK_LITERAL" || node.type === "BLOCK_FOLDED");
    return isBlockText ? start + this.text.slice(start, end).trimEnd().length : end;
  }
}

export const keyText = (pair: { key: unknown }): string => (isScalar(pair.key) ? String(pair.key.value) : String(pair.key));
