import { describe, expect, it } from "vitest";
import { parseDocument } from "yaml";
import { lineText, listAsWritten } from "../../model/text/list_text";
import { apply, YamlText, type TextEdit, type Writer, type YamlPath } from "../../model/text/yaml_text";

/** Random texts in all styles of YAML. The parser of another library judges what an edit has made of them. */
class RandomText {
  private names = 0;
  constructor(private state: number) {}

  below(limit: number): number {
    this.state = (Math.imul(this.state, 1664525) + 1013904223) >>> 0;
    return Math.floor((this.state / 2 ** 32) * limit);
  }

  private name = () => `k${(this.names += 1)}`;

  private scalar(): string {
    return ["5", "word", "two words", '"quoted: # text"', "'it''s'", "", "true", "1.5 m/s"][this.below(8)]!;
  }

  private flow(depth: number): string {
    const gap = ["", " ", "  "][this.below(3)]!;
    const many = Array.from({ length: this.below(4) });
    if (depth === 0 || this.below(3) === 0) return ["5", "word", '"a, b"', "'}'"][this.below(4)]!;
    if (this.below(2) === 0) return `[${gap}${many.map(() => this.flow(depth - 1)).join(`,${gap}`)}${gap}]`;
    return `{${gap}${many.map(() => `${this.name()}: ${this.flow(depth - 1)}`).join(`, ${gap}`)}${gap}}`;
  }

  /** The text after a colon or a dash, without the end of its last line. */
  private after(depth: number, indent: number): string {
    const start = `\n${" ".repeat(indent + 2)}`;
    const style = this.below(depth === 0 ? 4 : 8);
    if (style < 2) return ` ${this.scalar()}`.trimEnd();
    if (style === 2) return ` ${["|", ">", "|-"][this.below(3)]!}${start}first line${start}  second line`;
    if (style === 3) return ` ${this.flow(2)}${this.below(2) === 0 ? "  # flow" : ""}`;
    if (style === 4)
      return Array.from({ length: 1 + this.below(3) }, () => `${start}-${this.item(depth - 1, indent + 2)}`).join("");
    return this.below(3) === 0 ? `  # below${start}${this.map(depth - 1, indent + 2)}` : start + this.map(depth - 1, indent + 2);
  }

  private item(depth: number, indent: number): string {
    return depth > 0 && this.below(2) === 0 ? ` ${this.map(depth - 1, indent + 2)}` : this.after(depth, indent);
  }

  /** The lines of a map; the first begins where the text before ends. */
  map(depth: number, indent: number): string {
    const start = `\n${" ".repeat(indent)}`;
    const entry = () => `${this.name()}:${this.after(depth, indent)}`;
    const between = () => ["", "", "", `${start}# of the next`, "\n"][this.below(5)]!;
    return Array.from({ length: 1 + this.below(3) }, entry).reduce((all, one) => all + between() + start + one);
  }
}

type Data = Record<string, unknown>;
const dataOf = (text: string) => {
  const document = parseDocument(text);
  expect(document.errors, text).toEqual([]);
  return document.toJS() as Data;
};

/** Each path of a document, with its value. */
function* pathsIn(value: unknown, at: YamlPath = []): Generator<[YamlPath, unknown]> {
  if (at.length > 0) yield [at, value];
  if (Array.isArray(value)) for (const [index, one] of value.entries()) yield* pathsIn(one, [...at, index]);
  else if (typeof value === "object" && value !== null)
    for (const [key, one] of Object.entries(value)) yield* pathsIn(one, [...at, key]);
}

const inside = (data: unknown, path: YamlPath) => path.reduce((now, key) => (now as Data)[key], data);
const isMap = (value: unknown): value is Data => typeof value === "object" && value !== null && !Array.isArray(value);

/** Removes what the path leads to; a map or list in lines of its own goes with its last entry. */
function removed(data: Data, path: YamlPath, isFlow: (path: YamlPath) => boolean): void {
  const parent = inside(data, path.slice(0, -1));
  const size = Array.isArray(parent) ? parent.length : Object.keys(parent as Data).length;
  if (size === 1 && !isFlow(path.slice(0, -1))) {
    if (path.length > 1) removed(data, path.slice(0, -1), isFlow);
  } else if (Array.isArray(parent)) parent.splice(Number(path.at(-1)), 1);
  else delete (parent as Data)[path.at(-1)!];
}

const comments = (text: string) => (text.match(/# (of the next|flow|below)/g) ?? []).length;

interface Edit {
  name: string;
  edits: TextEdit[];
  change: (data: Data) => void;
}

/** Every edit that the forms make, at one path. */
function* editsAt(yaml: YamlText, path: YamlPath, value: unknown): Generator<Edit> {
  const isFlow = (at: YamlPath) => (yaml.node(at) as { flow?: boolean } | undefined)?.flow === true;
  const [above, key] = [path.slice(0, -1), path.at(-1)!];
  yield { name: "remove", edits: yaml.remove(path), change: (data) => removed(data, path, isFlow) };
  if (typeof key === "string") {
    yield {
      name: "rename",
      edits: yaml.renameKey(path, "renamed"),
      change: (data) => {
        const parent = inside(data, above) as Data;
        parent.renamed = parent[key];
        delete parent[key];
      },
    };
    if (typeof value !== "object" || value === null)
      yield { name: "set", edits: yaml.set(above, key, "7"), change: (data) => void ((inside(data, above) as Data)[key] = 7) };
  }
  if (isMap(value) || value === null)
    for (const [text, fresh] of [
      ["1", 1],
      [
        { a: "1", b: { c: "2" } },
        { a: 1, b: { c: 2 } },
      ],
    ] as const)
      yield {
        name: "insert",
        edits: yaml.insert(path, "fresh", text),
        change: (data) => {
          if (value === null) (inside(data, above) as Data)[key] = { fresh };
          else (inside(data, path) as Data).fresh = fresh;
        },
      };
  if (Array.isArray(value))
    yield { name: "append", edits: yaml.append(path, "more"), change: (data) => (inside(data, path) as unknown[]).push("more") };
}

describe("An edit of a text", () => {
  it("changes what it names and nothing else, in every style", () => {
    const tried: Record<string, number> = {};
    for (let seed = 1; seed <= 100; seed += 1) {
      const text = `${new RandomText(seed).map(3, 0)}\n`;
      const yaml = new YamlText(text);
      for (const [path, value] of pathsIn(dataOf(text)))
        for (const { name, edits, change } of editsAt(yaml, path, value)) {
          const expected = dataOf(text);
          change(expected);
          const after = apply(text, edits);
          const told = `seed ${seed}, ${name} ${path.join(".")}:\n${text}\n--- is now:\n${after}`;
          expect(dataOf(after), told).toEqual(expected);
          if (name !== "remove") expect(comments(after), told).toBe(comments(text));
          tried[name] = (tried[name] ?? 0) + 1;
        }
    }
    for (const name of ["remove", "rename", "set", "insert", "append"]) expect(tried[name], name).toBeGreaterThan(50);
  });

  it("makes the first entry of an empty text, and leaves one that is no map as it is", () => {
    const insert = (text: string) => apply(text, new YamlText(text).insert(["agents", "robot"], "rate", "5 Hz"));
    const robot = "agents:\n  robot:\n    rate: 5 Hz\n";
    expect(insert("")).toBe(robot);
    expect(insert("# mine")).toBe(`# mine\n${robot}`);
    expect(dataOf(insert("{}\n"))).toEqual({ agents: { robot: { rate: "5 Hz" } } });
    expect(insert("- one\n")).toBe("- one\n");
    expect(insert("word\n")).toBe("word\n");
  });

  it("removes several entries one after the other", () => {
    const yaml = new YamlText("{a: 1,   b: 2, c: 3}\n");
    expect(yaml.without([], ["a", "b"]).text).toBe("{c: 3}\n");
  });
});

describe("aliases", () => {
  const text =
    "a: &r2 10 Hz\nb:\n  rate: *r2\n  list: [*r2, 5]\n  lines:\n    - *r2\n    - x\n  map: &m { one: 1 }\nc: *m\nlate: &r3 1\n";
  const set = (path: YamlPath, key: string, value: string, as?: Writer) => {
    const yaml = new YamlText(text);
    return apply(text, yaml.set(path, key, value, as));
  };
  it("stay aliases when they are written again, alone and in lists", () => {
    expect(set(["b"], "rate", "*r2")).toBe(text);
    expect(set(["b"], "list", "*r2, 5", listAsWritten)).toBe(text);
    expect(set(["b"], "list", "[*r2, 5]")).toBe(text);
    expect(lineText(new YamlText(text), ["b", "lines"])).toBe("[*r2, x]");
    expect(set(["b"], "new", "*r2")).toContain("  new: *r2\n");
    expect(dataOf(set(["b"], "rate", "20 Hz"))).toMatchObject({ a: "10 Hz", b: { rate: "20 Hz" } });
  });
  it("are texts if no anchor before them has the name", () => {
    for (const value of ["*r3", "*other", "*in.line", "&r2 5", "!in.line.fresh"])
      expect(dataOf(set(["b"], "rate", value))).toMatchObject({ b: { rate: value } });
  });
  it("of a map are not replaced by an entry of it", () => {
    const yaml = new YamlText(text);
    expect(yaml.isAlias(["c"])).toBe(true);
    expect(yaml.set(["c"], "one", "2")).toEqual([]);
    expect(yaml.insert(["c"], "two", "2")).toEqual([]);
  });
  it("that have lost their anchor are named", () => {
    expect(new YamlText(text).lostAlias()).toBeUndefined();
    expect(new YamlText(set([], "a", "")).lostAlias()).toEqual({ name: "r2", line: 2 });
  });
  it("keep their anchor when its value changes", () => {
    expect(dataOf(set([], "a", "30 Hz"))).toMatchObject({ a: "30 Hz", b: { rate: "30 Hz" } });
  });
});
