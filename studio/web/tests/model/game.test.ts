import { describe, expect, it } from "vitest";
import { activeTransitions, fire, initialMarking, runningBehaviours, Walk } from "../../model/net/game";
import { lineFollower } from "./line_follower";

const net = lineFollower();
const named = (name: string) => net.transitionByName.get(name)!;

describe("token game", () => {
  it("begins with the start of the system as the only choice", () => {
    expect(activeTransitions(net, initialMarking(net))).toEqual([named("t_in")]);
  });
  it("never offers a transition whose condition never holds", () => {
    const walk = new Walk(net);
    for (let step = 0; step < 400; step += 1) {
      const active = activeTransitions(net, walk.marking);
      expect(active.every((transition) => net.transitions.at(transition)!.condition?.truth !== "never")).toBe(true);
      if (active.length === 0) break;
      walk.choose(active[(step * 7) % active.length]!);
      expect(Math.max(...walk.marking)).toBe(1);
    }
  });
  it("leaves out what its conditions exclude", () => {
    const marking = initialMarking(net);
    expect(activeTransitions(net, marking, new Map([[named("t_in"), false]]))).toEqual([]);
  });
  it("says which behaviour of each subsystem holds a token", () => {
    const marking = initialMarking(net);
    for (const name of ["t_in", "robot.t_in", "robot.control.t_in"]) fire(net, marking, named(name));
    expect([...runningBehaviours(net, marking)]).toEqual([[0, "init"]]);
  });
});

describe("Walk", () => {
  it("comes back to the same marking", () => {
    const walk = new Walk(net, ["t_in", "robot.t_in", "robot.sensor.t_in"].map(named));
    walk.seek(3);
    expect(walk.position).toBe(3);
    walk.seek(0);
    expect(walk.marking).toEqual(initialMarking(net));
  });
  it("stops at a step that the net cannot take", () => {
    const walk = new Walk(net, [named("t_in"), named("robot.t_out")]);
    walk.seek(2);
    expect(walk.position).toBe(1);
  });
  it("forgets what came after when another way is chosen", () => {
    const walk = new Walk(net, ["t_in", "robot.t_in", "robot.sensor.t_in"].map(named));
    walk.seek(2);
    expect(walk.choose(named("robot.motor.t_in"))).toBe(true);
    expect(walk.steps).toEqual(["t_in", "robot.t_in", "robot.motor.t_in"].map(named));
  });
});
