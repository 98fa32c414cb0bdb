import { describe, expect, it } from "vitest";
import { addNext, changeNext, removeNext } from "../../model/text/next_edits";
import { candidatesFor } from "../../model/text/repair_edits";
import { findThing, readStructure, type Behaviour } from "../../model/structure/structure";
import { changes } from "./changes";

/** A behaviour `run` with the given `next`, in lines of its own. */
const withNext = (next: string) =>
  `agents:\n  a:\n    control:\n      behaviours:\n        run:\n          terminal: true\n${next}        rest: {}\n`;

const read = (text: string) => {
  const structure = readStructure(text);
  return { structure, run: (findThing(structure, "a.control.run") as { of: Behaviour }).of };
};
const nextOf = (text: string) => read(text).run.next;

const list = `          next:                     # in this order
            - { to: run, when: error }    # once more
            # nothing to do
            - rest                  # by day
            - to: run
              when: in.x            # by night
`;

describe("`next`", () => {
  it("is a name, a map, or a list of these", () => {
    expect(nextOf(withNext(""))).toEqual([]);
    expect(nextOf(withNext("          next:\n"))).toEqual([]);
    expect(nextOf(withNext("          next: rest\n"))).toEqual([{ to: "rest", when: "" }]);
    expect(nextOf(withNext("          next: { to: rest, when: error }\n"))).toEqual([{ to: "rest", when: "error" }]);
    expect(nextOf(withNext("          next:\n            to: rest\n            when: error\n"))).toEqual([
      { to: "rest", when: "error" },
    ]);
    expect(nextOf(withNext(list))).toEqual([
      { to: "run", when: "error" },
      { to: "rest", when: "" },
      { to: "run", when: "in.x" },
    ]);
  });
});

describe("a change of one entry leaves the others as they are", () => {
  const change = (next: string, index: number, part: Parameters<typeof changeNext>[3]) => {
    const { structure, run } = read(withNext(next));
    return changes(withNext(next), changeNext(structure, run, index, part));
  };
  it("in a list in lines of its own", () => {
    expect(change(list, 0, { when: "in.y || in.z, or" })).toEqual([
      "-            - { to: run, when: error }    # once more",
      '+            - { to: run, when: "in.y || in.z, or" }    # once more',
    ]);
    expect(change(list, 1, { when: "!in.day" })).toEqual([
      "-            - rest                  # by day",
      '+            - { to: rest, when: "!in.day" }                  # by day',
    ]);
    expect(change(list, 2, { to: "rest" })).toEqual(["-            - to: run", "+            - to: rest"]);
    expect(change(list, 2, { when: "" })).toEqual(["-              when: in.x            # by night"]);
    expect(change(list, 0, { when: "" })).toEqual([
      "-            - { to: run, when: error }    # once more",
      "+            - run    # once more",
    ]);
  });
  it("in a list in one line, in a map, and in a name", () => {
    expect(change("          next: [{ to: run, when: error }, rest]  # why\n", 1, { to: "end" })[1]).toBe(
      "+          next: [{ to: run, when: error }, end]  # why",
    );
    expect(change("          next: { to: run, when: error }  # why\n", 0, { when: "in.x" })[1]).toBe(
      "+          next: { to: run, when: in.x }  # why",
    );
    expect(change("          next: { to: run, when: error }  # why\n", 0, { when: "" })[1]).toBe("+          next: run  # why");
    expect(change("          next: run  # why\n", 0, { when: "error" })[1]).toBe(
      "+          next: [{ to: run, when: error }]  # why",
    );
    expect(change("          next: run  # why\n", 0, { to: "rest" })[1]).toBe("+          next: rest  # why");
  });
});

describe("a new entry stands behind the others", () => {
  const add = (next: string, when = "") => {
    const { structure, run } = read(withNext(next));
    const after = addNext(structure, run, { to: "end", when });
    expect(nextOf(after)).toEqual([...run.next, { to: "end", when }]);
    return changes(withNext(next), after);
  };
  it("of a list", () => {
    expect(add(list, "in.z")).toEqual(["+            - { to: end, when: in.z }"]);
    expect(add("          next: [rest]   # why\n")[1]).toBe("+          next: [rest, end]   # why");
    expect(add("          next: []\n")).toContain("+            - end");
  });
  it("of a name or a map", () => {
    expect(add("          next: rest   # why\n")[1]).toBe("+          next: [rest, end]   # why");
    expect(add("          next: { to: rest, when: error }   # why\n")[1]).toBe(
      "+          next: [{ to: rest, when: error }, end]   # why",
    );
    expect(
      add("          next:   # why\n            to: rest   # there\n            # as it\n            when: error   # failed\n"),
    ).toEqual([
      "-            to: rest   # there",
      "-            # as it",
      "-            when: error   # failed",
      "+            - to: rest   # there",
      "+              # as it",
      "+              when: error   # failed",
      "+            - end",
    ]);
  });
  it("where there was none", () => {
    expect(add("")).toEqual(["+          next: end"]);
    expect(add("", "error")).toEqual(["+          next: [{ to: end, when: error }]"]);
    expect(add("          next:\n")).toEqual(["-          next:", "+          next: end"]);
  });
  it("also if it is a repair", () => {
    const { structure } = read(withNext(list));
    const end = { path: "a.control", behaviour: "run", state: "no_successor" };
    const cause = { atEnd: [end], dead: [] } as unknown as Parameters<typeof candidatesFor>[0];
    expect(candidatesFor(cause, structure).map(({ text }) => changes(withNext(list), text))[0]).toEqual(["+            - run"]);
  });
});

describe("an entry is removed with its line", () => {
  const remove = (next: string, index: number) => {
    const { structure, run } = read(withNext(next));
    const after = removeNext(structure, run, index);
    expect(nextOf(after)).toEqual(run.next.filter((_, at) => at !== index));
    return changes(withNext(next), after);
  };
  it("from a list", () => {
    expect(remove(list, 1)).toEqual(["-            - rest                  # by day"]);
    expect(remove("          next: [rest, end]  # why\n", 0)[1]).toBe("+          next: [end]  # why");
    const flow =
      "          next: [\n            run,   # one\n            # two\n            rest,\n            end    # three\n          ]\n";
    expect(remove(flow, 0)).toEqual(["-            run,   # one"]);
    expect(remove(flow, 1)).toEqual(["-            rest,"]);
    expect(remove(flow, 2)).toEqual(["-            end    # three"]);
  });
  it("with `next` if it is the only one", () => {
    for (const next of ["[end]", "end", "{ to: end, when: error }", "\n            - end", "\n            to: end"])
      expect(remove(`          next: ${next}\n`, 0).filter((line) => line.startsWith("+"))).toEqual([]);
  });
});
