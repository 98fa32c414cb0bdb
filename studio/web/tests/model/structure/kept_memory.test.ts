import { describe, expect, it } from "vitest";
import { exampleOf, goalsOf, keptCells } from "../../../model/structure/kept_cells";
import { readStructure } from "../../../model/structure/structure";

const text = `agents:
  dock:
    control:
      memory:
        lent_to: { values: [nobody, a, b] }
        served: { counts: 0..4 }
        last: int32
        going: { goal: out.goal, progress: in.progress }
        at: { type: float64, initial: 2 }
      send:
        - answer   # the only one
        - "-x, y"
      behaviours:
        wait:
          sets:
            served: +1
            lent_to: a
          terminal: { done: in.x, other }
          error:
            late:
            far: "in.where[0] > 3, or so"
          next:
            - { to: lend, when: memory.lent_to == nobody, sets: { served: -1 } }
            - to: wait
              sets:
                lent_to: nobody
            - wait
        lend: {}
`;

describe("memory with few values", () => {
  const structure = readStructure(text);
  const control = structure.agents[0]!.subsystems[0]!;
  const [wait, lend] = control.behaviours;

  it("has the goals apart from what sets changes", () => {
    expect(goalsOf(structure, control)).toEqual(["going"]);
  });

  it("is read with its values", () => {
    expect(keptCells(structure, control)).toEqual([
      { name: "lent_to", counts: "", values: ["nobody", "a", "b"] },
      { name: "served", counts: "0..4", values: [] },
    ]);
    expect(exampleOf(keptCells(structure, control))).toBe("{ lent_to: a, served: +1 }");
  });

  it("is changed by behaviours and entries, shown in one line", () => {
    expect(wait!.sets).toBe("{ served: +1, lent_to: a }");
    expect(lend!.sets).toBe("");
    expect(wait!.next.map(({ sets }) => sets)).toEqual(["{ served: -1 }", "{ lent_to: nobody }", ""]);
  });

  it("leaves other values of several lines in one line, too", () => {
    expect(wait!.terminal).toBe("{ done: in.x, other }");
    expect(wait!.error).toBe('{ late, far: "in.where[0] > 3, or so" }');
    expect(structure.yaml.lineText([...control.yaml, "send"])).toBe('[answer, "-x, y"]');
    expect(structure.yaml.lineText(["nowhere"])).toBe("");
  });
});
