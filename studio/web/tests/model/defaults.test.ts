import { describe, expect, it } from "vitest";
import { leadsFailures, listAround, onError, readStructure } from "../../model/structure/structure";

const text = `on_error: stop
agents:
  a:
    on_error: rest
    control:
      on_error: safe
      send: [x]
      receive: { first: [i] }
      behaviours:
        go: {}
        own: { next: [{ to: go, when: error }] }
        safe: { terminal: true, next: go }
    receptors:
      eye: { receive: first, behaviours: { look: {}, rest: {} } }
`;

describe("defaults", () => {
  const structure = readStructure(text);
  const [control, eye] = structure.agents[0]!.subsystems;

  it("are those of the nearest part that says them", () => {
    expect(onError(structure, control!.yaml)).toEqual({ text: "safe", of: "subsystem" });
    expect(onError(structure, control!.yaml, true)).toEqual({ text: "rest", of: "agent" });
    expect(onError(structure, eye!.yaml)).toEqual({ text: "rest", of: "agent" });
    expect(onError(structure, ["agents", "a"], true)).toEqual({ text: "stop", of: "system" });
    expect(onError(structure, [], true)).toBeUndefined();
  });

  it("lead the failures that no entry of a behaviour names", () => {
    const of = (name: string) =>
      leadsFailures(
        structure,
        control!,
        control!.behaviours.find((one) => one.name === name)!,
      )?.text;
    expect(of("go")).toBe("safe");
    expect(of("own")).toBeUndefined();
    expect(of("safe")).toBeUndefined();
  });

  it("list buffers, but not the order of receiving", () => {
    expect(listAround(structure, control!, "send")).toBe("[x]");
    expect(listAround(structure, control!, "receive")).toBe("{ first: [i] }");
    expect(listAround(structure, eye!, "receive")).toBe("");
    expect(listAround(structure, eye!, "send")).toBe("");
  });
});
