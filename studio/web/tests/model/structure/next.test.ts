import { describe, expect, it } from "vitest";
import { findThing, readStructure, type Behaviour } from "../../../model/structure/structure";

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
    expect(nextOf(withNext("          next: rest\n"))).toEqual([{ to: "rest", when: "", sets: "" }]);
    expect(nextOf(withNext("          next: { to: rest, when: error }\n"))).toEqual([{ to: "rest", when: "error", sets: "" }]);
    expect(nextOf(withNext("          next:\n            to: rest\n            when: error\n"))).toEqual([
      { to: "rest", when: "error", sets: "" },
    ]);
    expect(nextOf(withNext(list))).toEqual([
      { to: "run", when: "error", sets: "" },
      { to: "rest", when: "", sets: "" },
      { to: "run", when: "in.x", sets: "" },
    ]);
  });
});
