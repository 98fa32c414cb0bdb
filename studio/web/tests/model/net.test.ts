import { describe, expect, it } from "vitest";
import { rank } from "../../model/structure/rank";
import { lineFollower } from "./line_follower";

const net = lineFollower();

describe("NetModel", () => {
  it("finds the flat element behind every drawn one", () => {
    [...net.pages].forEach((page, index) => {
      page.nodes.forEach((node, at) =>
        expect(net.flatPlaces(index)[at]! >= 0, `${page.path}.${node.name}`).toBe(node.page === null),
      );
      expect(
        [...net.flatTransitions(index)].every((flat) => flat >= 0),
        page.path,
      ).toBe(true);
    });
  });
  it("gives the members of a fusion set one flat place", () => {
    const places = ["robot.control.init.rcv", "robot.control.follow.rcv", "robot.sensor.watch.snd"].map((path) => {
      const page = net.pageByPath.get(path)!;
      return net.flatPlaces(page)[net.page(page).nodes.findIndex((node) => node.fusion === net.elements.firstFused)];
    });
    expect(places[0]).toBeGreaterThanOrEqual(0);
    expect(new Set(places).size).toBe(1);
  });
  it("finds elements of every kind by their path", () => {
    expect(net.find("robot.control.follow")).toMatchObject({ kind: "page", page: net.pageByPath.get("robot.control") });
    expect(net.find("robot.control.follow.snd.motion.2")).toMatchObject({
      kind: "place",
      page: net.pageByPath.get("robot.control.follow.snd"),
    });
    expect(net.find("robot.control.t_init_1")).toMatchObject({ kind: "transition" });
    expect(net.find("robot.sensor.line->robot.control.line.channel")).toMatchObject({ kind: "place" });
    expect(net.find("robot.nobody")).toBeUndefined();
  });
  it("goes from the system down to a page", () => {
    const chain = net.ancestry(net.pageByPath.get("robot.control.follow.snd")!).map((page) => net.page(page).path);
    expect(chain).toEqual(["", "robot", "robot.control", "robot.control.follow", "robot.control.follow.snd"]);
  });
});

describe("rank", () => {
  it("puts the exact path first and asks for every word", () => {
    const found = rank("control follow", [...net.pages], (page) => page.path).map((page) => page.path);
    expect(found[0]).toBe("robot.control.follow");
    expect(found).not.toContain("robot.control.init");
  });
});
