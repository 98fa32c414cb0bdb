import { describe, expect, it } from "vitest";
import { activeTransitions, fire } from "../../model/net/game";
import { flagsOf } from "../../model/flags";
import { NetModel, type FoldedNet } from "../../model/net/net";
import type { NetJson } from "../../model/net/net_json";
import json from "./ring.json";

// Three robots of one template in a ring and two other agents, in the forms of the server and of `tessera
// show --json`.
const { folded, whole } = json as unknown as { folded: FoldedNet; whole: NetJson };
const net = new NetModel(folded);

describe("a net whose agents come folded", () => {
  it("has every page, place and transition of the whole net", () => {
    expect(folded.shapes.length).toBe(3);
    expect([...net.places]).toEqual(whole.flat.places);
    expect([...net.transitions]).toEqual(whole.flat.transitions);
    const nameOf = (fusion: number | null) => (fusion === null ? null : whole.fusions[fusion]!.name);
    const ofShow = whole.pages.map((page) => ({
      ...page,
      nodes: page.nodes.map((node) => ({ ...node, fusion: nameOf(node.fusion) })),
    }));
    const ofNet = [...net.pages].map((page) => ({
      ...page,
      nodes: page.nodes.map((node) => ({ ...node, fusion: node.fusion === null ? null : net.places.at(node.fusion)!.name })),
    }));
    expect(ofNet).toEqual(ofShow);
  });

  it("finds each of them by its name", () => {
    whole.pages.forEach(({ path }, page) => expect(net.pageByPath.get(path)).toBe(page));
    whole.flat.places.forEach(({ name }, place) => expect(net.placeByName.get(name)).toBe(place));
    whole.flat.transitions.forEach(({ name }, transition) => expect(net.transitionByName.get(name)).toBe(transition));
    for (const wrong of ["robot", "robot[3]", "robot[0].control.", "a->b.full", "robot[0]..in", "."])
      for (const names of [net.pageByPath, net.placeByName, net.transitionByName]) expect(names.has(wrong), wrong).toBe(false);
  });

  it("knows what each page draws", () => {
    whole.pages.forEach((page, index) => {
      const named = [...net.flatPlaces(index)].map((place) => net.places.at(place)?.name ?? null);
      const own = (name: string) => (page.path ? `${page.path}.${name}` : name);
      expect(named).toEqual(
        page.nodes.map((node) =>
          node.page !== null ? null : node.fusion === null ? own(node.name) : whole.fusions[node.fusion]!.name,
        ),
      );
      expect([...net.flatTransitions(index)].map((at) => net.transitions.at(at)!.name)).toEqual(
        page.transitions.map(({ name }) => own(name)),
      );
    });
    for (const { name, page } of whole.flat.places) {
      const first = whole.pages.findIndex(({ nodes }) =>
        nodes.some(({ fusion }) => fusion !== null && whole.fusions[fusion]!.name === name),
      );
      expect(net.find(name)).toMatchObject({ path: name, kind: "place", page: page ?? first });
    }
  });

  it("plays like the whole net", () => {
    const marking = net.elements.initialMarking();
    expect([...marking]).toEqual(whole.flat.places.map(({ tokens }) => tokens));
    for (let step = 0; step < 400; step += 1) {
      const enabled = whole.flat.transitions.flatMap(({ inputs, condition }, index) =>
        condition?.truth !== "never" && inputs.every(({ place, weight }) => marking[place]! >= weight) ? [index] : [],
      );
      expect(activeTransitions(net, marking)).toEqual(enabled);
      fire(net, marking, enabled[(step * 7919) % enabled.length]!);
    }
    const free = whole.flat.transitions.flatMap(({ condition }, index) => (condition?.truth === "free" ? [index] : []));
    expect(net.elements.free(1000)).toEqual(free);
    expect(net.elements.free(2)).toEqual(free.slice(0, 2));
  });

  it("marks a complaint about a template in all its agents", () => {
    const walk = net.page(net.pageByPath.get("robot[1].control.walk")!);
    const flags = flagsOf(net, [{ severity: "error", line: walk.span.line }]);
    expect([...flags.keys()]).toEqual([0, 1, 2].map((at) => `robot[${at}].control.walk`));
  });
});
