import { describe, expect, it } from "vitest";
import { NetModel, type FoldedNet } from "../../model/net/net";
import { readIn, spelledOut, valuePath } from "../../model/run/conditions";
import { sentenceOf, Teller } from "../../model/run/words";
import { lineFollower } from "./line_follower";
import json from "./words.json";

// A specification with every role of a transition, and its net as the server sends it.
const { text } = json;
const net = new NetModel(json.net as unknown as FoldedNet, "", text);
const teller = new Teller(net);
const at = (name: string) => net.transitionByName.get(name)!;
const said = (name: string, ending?: string) => sentenceOf(teller.words(at(name), ending === undefined ? null : at(ending)));

describe("a firing in words", () => {
  it.each([
    ["t_in", "the system starts"],
    ["robot.t_out", "robot ends"],
    ["robot.control.t_in", "robot.control begins with drive"],
    ["robot.control.t_drive_1", "robot.control goes on from drive to stop because in.line > 100"],
    ["robot.control.t_drive_3", "robot.control ends after drive because drive failed"],
    ["robot.control.trip.t_in", "robot.control begins with trip.out"],
    ["robot.control.trip.t_out_2", "robot.control goes on from trip.out to trip.back"],
    ["robot.control.trip.t_back_2", "robot.control leaves the group trip after trip.back"],
    ["robot.control.t_trip_1", "robot.control goes on from trip to stop"],
    ["robot.control.drive.t1", "robot.control calls its function drive()"],
    ["robot.motor.move.t3", "robot.motor calls its function move()"],
    ["robot.motor.move.t1", "robot.motor begins to receive"],
    ["robot.control.trip.out.t1", "robot.control calls its function trip_out()"],
    ["robot.control.drive.t4", "robot.control goes on with drive"],
    ["robot.control.drive.t5", "robot.control ends drive because memory.battery < parameters.tired"],
    ["robot.control.stop.t5", "robot.control ends stop because memory.battery > 0.9"],
    ["robot.control.ask.t6", "robot.control fails in ask"],
    ["robot.control.drive.t6", "robot.control fails in drive because in.line > 100, or its function or a device failed"],
    ["robot.control.drive.snd.fork", "robot.control begins to send all its outputs at once"],
    ["robot.control.drive.rcv.join", "robot.control has received all its inputs"],
    ["robot.control.ask.rcv.t1", "robot.control has nothing to receive"],
    ["robot.control.drive.snd.motion.t1", "robot.control writes motion"],
    ["robot.control.drive.snd.motion.t2", "robot.control has sent motion, and waits until it is read"],
    ["robot.control.drive.snd.motion.t3", "robot.control is told that motion was read"],
    ["robot.control.drive.snd.motion.timeout", "robot.control no longer waits for motion: its time of 1 s is over"],
    ["robot.control.drive.snd.report.skip", "robot.control does not send report because not (memory.asking)"],
    ["robot.control.drive.rcv.line.t1", "robot.control reads line"],
    ["robot.control.drive.rcv.line.t2", "robot.control has received line"],
    ["robot.sensor.watch.snd.wish.t1o", "robot.sensor overwrites wish, which nobody has read"],
    ["robot.sensor.watch.snd.wish.t2", "robot.sensor has sent wish"],
    ["robot.motor.move.rcv.report.skip", "robot.motor finds nothing new in report"],
  ])("%s: %s", (name, words) => expect(said(name)).toBe(words));

  it("names the condition that ended the behaviour, if the entry of next asks for none", () => {
    expect(said("robot.control.t_drive_2", "robot.control.drive.t5")).toBe(
      "robot.control goes on from drive to ask because memory.battery < parameters.tired",
    );
    expect(said("robot.control.t_ask_1", "robot.control.ask.t5")).toBe("robot.control goes on from ask to trip because in.wish");
    expect(teller.ends(at("robot.control.drive.t5"))).toBe(true);
    expect(teller.ends(at("robot.control.drive.t4"))).toBe(false);
  });

  it("has words for every transition of a net", () => {
    for (const one of [net, lineFollower()]) {
      const words = new Teller(one);
      for (let index = 0; index < one.transitions.length; index += 1)
        expect(sentenceOf(words.words(index)), one.transitions.at(index)!.name).not.toMatch(/fires|\.t\d|\.t_|passes|undefined/);
    }
  });

  it("tells changes of behaviour, failures and timeouts from the other steps", () => {
    const kind = (name: string) => teller.words(at(name)).kind;
    expect(kind("robot.control.t_drive_2")).toBe("change");
    expect(kind("robot.control.drive.t6")).toBe("failure");
    expect(kind("robot.motor.move.rcv.motion.timeout")).toBe("timeout");
    expect(kind("robot.control.drive.t4")).toBe("step");
  });

  it("leads to the behaviour that begins, and otherwise to the transition", () => {
    expect(teller.words(at("robot.control.t_drive_2")).place).toBe("robot.control.ask");
    expect(teller.words(at("robot.control.drive.t4")).place).toBe("robot.control.drive.t4");
  });

  it("shows the values that the condition read, as far as they are known", () => {
    const values = new Map<string, unknown>([["robot.control.memory.battery", 0.18339]]);
    const words = teller.words(at("robot.control.drive.t5"));
    expect(teller.values(words, (path) => values.get(path))).toEqual(["memory.battery = 0.1834"]);
    expect(teller.values(teller.words(at("robot.control.drive.t4")), () => 1)).toEqual([]);
  });
});

describe("conditions", () => {
  it("are spelled out with the expressions of the specification", () => {
    expect(spelledOut(text, "robot.control.drive", "empty or lost")).toBe("memory.battery < parameters.tired or in.line > 100");
    expect(spelledOut(text, "robot.control.drive", "unknown")).toBe("unknown");
    expect(spelledOut(text, "dock.control.poll[2]", "in.request[i].fresh")).toBe("in.request[2].fresh");
  });

  it("read buffers, memory and parameters", () => {
    expect(readIn("memory.a < parameters.b && in.line.left > in.request[1] || memory.a > 2")).toEqual([
      "memory.a",
      "parameters.b",
      "in.line.left",
      "in.request[1]",
    ]);
    expect(valuePath("robot.control", "in.line.left")).toBe("robot.control.line.left");
    expect(valuePath("robot.control", "memory.a")).toBe("robot.control.memory.a");
  });
});
