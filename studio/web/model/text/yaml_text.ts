import {
  isAlias,
  isCollection,
  isMap,
  isPair,
  isScalar,
  isSeq,
  LineCounter,
  parseDocument,
  stringify,
  type Document,
  type Node,
  type Pair,
  type YAMLMap,
  type YAMLSeq,
} from "yaml";
import { aliasIn, anchorsBefore, lostAliasIn } from "./aliases";

/**
 * The specification as a text that is edited in place. The parsed document gives positions,
 * and an edit replaces only those characters. Comments, order, alignment and quotes of
 * everything else stay as they are.
 */

export type YamlPath = readonly (string | number)[];
/** A new value: a scalar or flow text as it is to appear in the file, or a map or list of such values. */
export type Value = string | readonly Value[] | { readonly [key: string]: Value };
/** How a text is to stand in the file, where aliases may have these names. */
export type Writer = (text: string, anchors: readonly string[]) => string;
export interface TextEdit {
  from: number;
  to: number;
  insert: string;
}

export function apply(text: string, edits: readonly TextEdit[]): string {
  return [...edits]
    .sort((a, b) => b.from - a.from || b.to - a.to)
    .reduce((now, edit) => now.slice(0, edit.from) + edit.insert + now.slice(edit.to), text);
}

/**
 * A text as a YAML scalar: in quotes only if YAML needs them. Flow collections and
 * numbers stay as they are. `anchors`: the names that an alias may have; an alias in quotes would be a text like any other.
 */
export function scalarText(text: string, anchors: readonly string[] = []): string {
  const trimmed = text.trim();
  if (anchors.includes(aliasIn(trimmed) ?? "")) return trimmed;
  if (/^(true|false|-?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?)$/.test(trimmed)) return trimmed;
  if (/^[[{]/.test(trimmed)) {
    // With the anchors that its aliases stand for before it.
    const before = anchors.map((name) => `&${name} 0, `).join("");
    if (parseDocument(`[${before}${trimmed}]`).errors.length === 0) return trimmed;
  }
  return stringify([trimmed], { collectionStyle: "flow", lineWidth: 0 }).trim().slice(1, -1).trim();
}

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

  /** The first alias without an anchor before it; undefined: there is none. */
  lostAlias(): { name: string; line: number } | undefined {
    const lost = lostAliasIn(this.document);
    return lost && { name: lost.name, line: this.lines.linePos(lost.offset).line };
  }

  /** The offset at which a new value of `key` of the map at `path` comes to stand. */
  private placeOf(path: YamlPath, key: string): number {
    return this.pair([...path, key])?.key.range?.[0] ?? this.range(path)?.[1] ?? this.text.length;
  }

  /** The same, but for an alias the node that it stands for. */
  resolved(path: YamlPath): Node | undefined {
    const node = this.node(path);
    return isAlias(node) ? node.resolve(this.document) : node;
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

  // ---------------------------------------------------------------------------------------------- edits

  /** Inserts `key: value` at the end of the map at `path`; makes the map if it does not exist. */
  insert(path: YamlPath, key: string, value: Value): TextEdit[] {
    const map = this.map(path);
    if (!map || map.items.length === 0) return this.insertMap(path, key, value);
    if (map.flow) {
      const at = this.endOf(map.items.at(-1)!);
      return [{ from: at, to: at, insert: `, ${key}: ${flowText(value)}` }];
    }
    const indent = this.columnOf(map.items[0]!.key.range![0]);
    return [this.afterLine(this.endOf(map.items.at(-1)!), `${" ".repeat(indent)}${key}:${block(value, indent)}`)];
  }

  /** Whether the path leads to an item of a list. */
  private itemOf(path: YamlPath): boolean {
    return typeof path.at(-1) === "number" && this.seq(path.slice(0, -1)) !== undefined;
  }

  private insertMap(path: YamlPath, key: string, value: Value): TextEdit[] {
    // An entry in place of the alias would drop all that it stands for.
    if (this.isAlias(path)) return [];
    const inside = { [key]: value };
    if (path.length === 0) return this.insertFirst(key, value);
    if (this.pair(path)) return this.replaceWith(path, inside);
    if (this.itemOf(path)) return this.replace(path, flowText(inside));
    return this.insert(path.slice(0, -1), String(path.at(-1)), inside);
  }

  /** Inserts the first entry of a text that has none. A text that is no map stays as it is. */
  private insertFirst(key: string, value: Value): TextEdit[] {
    const root = this.node([]);
    if (isMap(root)) return [{ from: root.range![0], to: root.range![1], insert: flowText({ [key]: value }) }];
    if (root?.range && root.range[1] > root.range[0]) return [];
    const end = this.text.length;
    const gap = end === 0 || this.text.endsWith("\n") ? "" : "\n";
    return [{ from: end, to: end, insert: `${gap}${key}:${block(value, 0)}\n` }];
  }

  /** Replaces a value; within flow style, the new value is in flow style. */
  private replaceWith(path: YamlPath, value: Value): TextEdit[] {
    const pair = this.pair(path);
    if (!pair) return [];
    const inFlow = this.map(path.slice(0, -1))?.flow === true;
    const [from, to] = this.valueRange(pair);
    const indent = this.columnOf(pair.key.range![0]);
    const insert = inFlow || typeof value === "string" ? ` ${flowText(value)}` : block(value, indent);
    return [{ from, to, insert: from === pair.key.range![1] ? `:${insert}` : insert }];
  }

  /** The position after the colon of an entry, or after the key of one without a colon: `{ in, out }`. */
  private colonOf({ key }: PairOf): number {
    const end = key.range![1];
    return end + (/^[ \t]*:/.exec(this.text.slice(end))?.[0].length ?? 0);
  }

  /** The range from after the colon to the end of the value. */
  private valueRange(pair: PairOf): [number, number] {
    const colon = this.colonOf(pair);
    return [colon, Math.max(colon, pair.value?.range ? this.endOf(pair) : colon)];
  }

  /**
   * Sets a scalar of the map at `path`; an empty text removes the key. Spaces before the value stay. `as`: how the text is
   * to stand in the file.
   */
  set(path: YamlPath, key: string, text: string, as: Writer = scalarText): TextEdit[] {
    const at = [...path, key];
    const pair = this.pair(at);
    if (text.trim() === "") return pair ? this.remove(at) : [];
    const written = as(text, anchorsBefore(this.document, this.placeOf(path, key)));
    if (!pair) return this.insert(path, key, written);
    if (!pair.value?.range || pair.value.range[0] === pair.value.range[1]) return this.replaceWith(at, written);
    return [{ from: pair.value.range[0], to: this.endOf(pair), insert: written }];
  }

  /** Replaces the scalar or collection at a path. */
  replace(path: YamlPath, text: string): TextEdit[] {
    const node = this.node(path);
    if (!node?.range) return [];
    const from = node.range[0];
    const gap = this.text[from - 1] === "-" ? " " : ""; // an item without a value
    return [{ from, to: this.endOfNode(node), insert: gap + text }];
  }

  /** Makes the value at a path the only item of a list. */
  makeList(path: YamlPath): TextEdit[] {
    const node = this.node(path);
    if (!node?.range) return [];
    const [from, to] = [node.range[0], this.endOfNode(node)];
    const old = this.text.slice(from, to);
    // The lines of a map go behind the dash.
    const isBlock = isMap(node) && !node.flow;
    return [{ from, to, insert: isBlock ? `- ${old.replace(/\n(?=[^\n])/g, "\n  ")}` : `[${old}]` }];
  }

  renameKey(path: YamlPath, name: string): TextEdit[] {
    const range = this.pair(path)?.key.range;
    return range ? [{ from: range[0], to: range[1], insert: name }] : [];
  }

  /** Removes an entry of a map or an item of a list, together with its line if it has one of its own. */
  remove(path: YamlPath): TextEdit[] {
    const parent = this.node(path.slice(0, -1));
    if (!isCollection(parent)) return [];
    const last = path.at(-1)!;
    const items = parent.items as (PairOf | Node)[];
    const at = isMap(parent) ? items.findIndex((item) => isPair(item) && keyText(item as PairOf) === last) : Number(last);
    const item = items[at];
    if (!item) return [];
    if (items.length === 1 && !parent.flow) return path.length > 1 ? this.remove(path.slice(0, -1)) : [];
    if (parent.flow) return [this.linesOfItem(items, at) ?? this.removeFromFlow(items, at, parent as Node)];
    const begins = (one: PairOf | Node) => (isMap(parent) ? startOf(one) : this.dashOf(parent as YAMLSeq<Node>, one as Node));
    const start = this.lineStart(begins(item));
    // The first entry of an item of a list stands behind the dash: the next one takes its place.
    if (this.text.slice(start, begins(item)).trim() !== "")
      return [{ from: begins(item), to: begins(items[at + 1]!), insert: "" }];
    const end = this.text.indexOf("\n", this.endOf(item));
    return [{ from: start, to: end < 0 ? this.text.length : end + 1, insert: "" }];
  }

  /** The lines of an item of a flow, if they have nothing but it and its comment. */
  private linesOfItem(items: (PairOf | Node)[], at: number): TextEdit | undefined {
    const item = items[at]!;
    const [from, end] = [this.lineStart(startOf(item)), this.text.indexOf("\n", this.endOf(item))];
    const isAlone =
      end >= 0 &&
      this.text.slice(from, startOf(item)).trim() === "" &&
      /^\s*,?\s*(#.*)?$/.test(this.text.slice(this.endOf(item), end));
    return isAlone && items.length > 1 ? { from, to: end + 1, insert: "" } : undefined;
  }

  private removeFromFlow(items: (PairOf | Node)[], at: number, parent: Node): TextEdit {
    if (items.length === 1) return { from: parent.range![0], to: parent.range![1], insert: isMap(parent) ? "{}" : "[]" };
    if (at > 0) return { from: this.endOf(items[at - 1]!), to: this.endOf(items[at]!), insert: "" };
    return { from: startOf(items[0]!), to: startOf(items[1]!), insert: "" };
  }

  /** The text without several entries of the map at `path`, one after the other: the rest decides how the next one goes. */
  without(path: YamlPath, keys: readonly string[]): YamlText {
    return keys.reduce((now: YamlText, key) => new YamlText(apply(now.text, now.remove([...path, key]))), this);
  }

  /** Adds an item at the end of the list at `path`. */
  append(path: YamlPath, item: string): TextEdit[] {
    const list = this.seq(path);
    if (!list || list.items.length === 0) {
      if (this.pair(path)) return this.replaceWith(path, [item]);
      if (this.itemOf(path)) return this.replace(path, flowText([item]));
      if (path.length > 1) return this.insert(path.slice(0, -1), String(path.at(-1)), [item]);
      const end = this.text.length;
      const gap = this.text.endsWith("\n") ? "\n" : "\n\n";
      return [{ from: end, to: end, insert: `${gap}${String(path.at(-1))}:\n  - ${item}\n` }];
    }
    const last = list.items.at(-1)!;
    if (list.flow) return [{ from: this.endOf(last), to: this.endOf(last), insert: `, ${item}` }];
    const indent = this.columnOf(list.range![0]);
    return [this.afterLine(this.endOf(last), `${" ".repeat(indent)}- ${item}`)];
  }

  /** Replaces matching parts of a scalar in place. */
  replaceWithin(node: Node | null | undefined, pattern: RegExp, by: string): TextEdit[] {
    if (!node?.range) return [];
    const [from, to] = [node.range[0], node.range[1]];
    const now = this.text.slice(from, to);
    const then = now.replace(pattern, by);
    return now === then ? [] : [{ from, to, insert: then }];
  }

  /** The end of an entry, without the comments and empty lines after it. */
  private endOf(item: PairOf | Node): number {
    if (!isPair(item)) return this.endOfNode(item as Node);
    const { key, value } = item as PairOf;
    if (value?.range && value.range[1] > key.range![1]) return this.endOfNode(value);
    return this.colonOf(item as PairOf);
  }

  private endOfNode(node: Node): number {
    if (isCollection(node) && !node.flow && node.items.length > 0) return this.endOf(node.items.at(-1) as PairOf | Node);
    const [start, end] = node.range!;
    // The range of a block text (`|`, `>`) ends at the start of the next line.
    const isBlockText = isScalar(node) && (node.type === "BLOCK_LITERAL" || node.type === "BLOCK_FOLDED");
    return isBlockText ? start + this.text.slice(start, end).trimEnd().length : end;
  }

  private lineStart(offset: number): number {
    return offset === 0 ? 0 : this.text.lastIndexOf("\n", offset - 1) + 1;
  }

  private columnOf(offset: number): number {
    return offset - this.lineStart(offset);
  }

  /** The dash of an item of a list that is no flow. All dashes of a list stand in one column; an item may begin lines below. */
  private dashOf(list: YAMLSeq<Node>, item: Node): number {
    const column = this.columnOf(list.range![0]);
    for (let line = this.lineStart(item.range![0]); line >= 0; line = line === 0 ? -1 : this.lineStart(line - 1))
      if (this.text[line + column] === "-" && /^[ -]*$/.test(this.text.slice(line, line + column))) return line + column;
    return item.range![0];
  }

  private afterLine(offset: number, line: string): TextEdit {
    const end = this.text.indexOf("\n", offset);
    if (end < 0) return { from: this.text.length, to: this.text.length, insert: `\n${line}\n` };
    return { from: end, to: end, insert: `\n${line}` };
  }
}

export const keyText = (pair: { key: unknown }): string => (isScalar(pair.key) ? String(pair.key.value) : String(pair.key));

function startOf(item: PairOf | Node): number {
  return isPair(item) ? (item as PairOf).key.range![0] : (item as Node).range![0];
}

const isList = (value: Value): value is readonly Value[] => Array.isArray(value);

/** A value as text in one line. */
export function flowText(value: Value): string {
  if (typeof value === "string") return value;
  if (isList(value)) return `[${value.map(flowText).join(", ")}]`;
  const entries = Object.entries(value).map(([key, one]) => `${key}: ${flowText(one)}`);
  return entries.length === 0 ? "{}" : `{ ${entries.join(", ")} }`;
}

/** The text after the colon: maps that contain maps as blocks, others in one line; items in lines of their own. */
function block(value: Value, indent: number): string {
  if (typeof value === "string") return ` ${value}`;
  const start = `\n${" ".repeat(indent + 2)}`;
  if (isList(value)) return value.map((one) => `${start}- ${flowText(one)}`).join("");
  const entries = Object.entries(value);
  if (entries.length === 0) return " {}";
  return entries.map(([key, one]) => `${start}${key}:${block(one, indent + 2)}`).join("");
}
