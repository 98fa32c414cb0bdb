import { describe, expect, it } from "vitest";
import { baseName, copiedText, notCopied, placeFor, readCopied } from "../../model/structure/copied";
import {
  findThing,
  nextEntryOf,
  nextSelection,
  readStructure,
  selectedPath,
  selectionAfter,
} from "../../model/structure/structure";
import { inside, nextIn, outside } from "../../model/structure/walk";
import { elementText } from "../../model/text/element_text";

const text = `tessera: 1
system: s
agents:
  # Carries boxes.
  robot:
    control:
      rate: 10 Hz
      outputs: { go: bool }
      behaviours:
        # Looks for a box.
        look: { next: [{ to: carry, when: in.seen }, look] }  # for ever
        carry:
          # until it is there
          terminal: true

          next: look
    receptors:
      eye: { rate: 5 Hz, real: { camera: bool }, behaviours: { read: {} } }
  desk:
    control:
      behaviours: { sit: {} }
channels:
  - robot.control.go -> desk.control.go
drivers:
  robot.eye.camera: { ros2: /camera }
`;
const structure = readStructure(text);
const thing = (path: string) => findThing(structure, path)!;

describe("an element in the clipboard", () => {
  it("has its comments, and stands in the first column", () => {
    const at = ["agents", "robot", "control", "behaviours"];
    expect(elementText(structure.yaml, [...at, "carry"])).toBe(
      "carry:\n  # until it is there\n  terminal: true\n\n  next: look\n",
    );
    expect(elementText(structure.yaml, [...at, "look"])).toMatch(/^# Looks for a box\.\nlook: .*# for ever\n$/);
    expect(elementText(structure.yaml, ["agents", "robot"])).toMatch(/^# Carries boxes\.\nrobot:\n {2}control:\n/);
    expect(elementText(structure.yaml, ["agents", "desk", "control", "behaviours", "sit"])).toBe("sit: {}\n");
  });

  it("says what it is, so that another project can take it", () => {
    for (const [path, kind] of [
      ["robot", "agent"],
      ["robot.control", "control"],
      ["robot.eye", "receptor"],
      ["robot.control.look", "behaviour"],
      ["output:robot.control.go", "output"],
    ] as const) {
      const copied = readCopied(copiedText(structure, thing(path))!.replaceAll("\n", "\r\n"))!;
      expect(copied.kind).toBe(kind);
      expect(copied.text).toBe(elementText(structure.yaml, (thing(path).of as unknown as { yaml: string[] }).yaml));
    }
  });

  it("may be any text: its keys tell what it is, or it is refused", () => {
    expect(readCopied("wait: { terminal: elapsed > 1 s }")).toMatchObject({ kind: "behaviour", name: "wait" });
    expect(readCopied("arm:\n  control: { behaviours: { a: {} } }\n")).toMatchObject({ kind: "agent" });
    for (const wrong of ["", "hello", "a: 1", "a: {}\nb: {}", "- a", "{", "# Tessera: nothing\na: {}\n", "\0"])
      expect(readCopied(wrong)).toBeUndefined();
  });

  it("goes where it belongs, seen from what is selected", () => {
    const behaviour = readCopied("wait: { terminal: true }")!;
    expect(placeFor(structure, "robot.control.look", behaviour)).toMatchObject({
      map: ["agents", "robot", "control", "behaviours"],
    });
    expect(placeFor(structure, "robot", behaviour)).toBe("Select the subsystem to paste it into");
    const receptor = { kind: "receptor", name: "ear", text: "ear: {}\n" } as const;
    const place = placeFor(structure, "output:robot.control.go", receptor);
    expect(place).toMatchObject({ map: ["agents", "robot", "receptors"] });
    expect(typeof place === "string" ? "" : place.select("ear")).toBe("robot.ear");
    expect(placeFor(structure, null, receptor)).toBe("Select the agent to paste it into");
    expect(placeFor(structure, "desk", { ...receptor, kind: "control" })).toMatch("has its control subsystem already");
  });

  it("tells what a copy of an agent has not", () => {
    const robot = thing("robot");
    expect(robot.kind === "agent" && notCopied(structure, robot.of)).toEqual({ channels: 1, drivers: 1 });
    expect(baseName("look_12")).toBe("look");
  });
});

describe("an entry of next", () => {
  it("is selected by its behaviour and number, and keeps both after a rename", () => {
    const selection = nextSelection("robot.control.look", 1);
    expect(selectedPath(selection)).toBe("robot.control.look");
    expect(nextEntryOf(selection)).toBe(1);
    expect(nextEntryOf("robot.control.look")).toBeUndefined();
    expect(thing(selection)).toMatchObject({ kind: "behaviour", of: { name: "look" } });
    const renamed = selectionAfter(structure, selection, (at) => at.map((step) => (step === "robot" ? "rover" : step)));
    expect(renamed).toBe("next:rover.control.look#1");
    expect(selectionAfter(structure, "output:robot.control.go", (at) => [...at])).toBe("output:robot.control.go");
  });
});

describe("the keys", () => {
  it("go into elements and out of them", () => {
    const way: string[] = [];
    for (let at = inside(structure, null); at !== undefined && way.length < 9; at = inside(structure, at)) way.push(at);
    expect(way).toEqual(["robot", "robot.control", "robot.control.look", "next:robot.control.look#0"]);
    expect(outside(thing("robot.control.look"))).toBe("robot.control");
    expect(outside(thing("robot.control"))).toBe("robot");
    expect(outside(thing("robot"))).toBeNull();
    expect(inside(structure, "output:robot.control.go")).toBe("channel:0");
  });

  it("go to the nearest box in a direction", () => {
    const at = (path: string, x: number, y: number) => ({ path, x, y, width: 10, height: 10 });
    const boxes = [at("a", 0, 0), at("b", 30, 2), at("c", 25, 40), at("d", 0, 60)];
    expect(nextIn(boxes, boxes[0]!, "right")).toBe("b");
    expect(nextIn(boxes, boxes[0]!, "down")).toBe("d");
    expect(nextIn(boxes, boxes[3]!, "up")).toBe("a");
    expect(nextIn(boxes, boxes[0]!, "left")).toBeUndefined();
  });
});
