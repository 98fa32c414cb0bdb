/** A run as data that plays without the studio: the state of its drawing at each firing. */

import type { Marking } from "../net/game";
import type { NetModel } from "../net/net";
import { sentenceOf, Teller } from "./words";

export interface Film {
  title: string;
  /** The time of the run at the first moment, in seconds. */
  begin: number;
  /** Nanoseconds from the first moment on, for each firing; null: the steps of a run without times. */
  times: number[] | null;
  /** The transition of each firing. */
  fired: number[];
  /** Tokens at the beginning, of places of the drawing, and inside its pages: page p is the place -1 - p. */
  start: [place: number, tokens: number][];
  /** The effect of each transition on them. */
  effects: Record<number, [place: number, change: number][]>;
  names: Record<number, string>;
  /** Sentences, and for each firing the one that tells it. */
  sentences: string[];
  told: number[];
  /** The numbers of firings after which a subsystem executes another behaviour, or something has failed. */
  turns: number[];
  /** Seconds from the first moment to the last; null: to the last firing. */
  length: number | null;
  world: FilmedWorld | null;
  plots: FilmedPlots | null;
  /** The behaviour that each subsystem of the drawing runs after so many firings. */
  running: [firings: number, page: number, behaviour: string][];
}

/** The simulated world in a film. Times are in seconds from its first moment. */
export type FilmedWorld =
  | { kind: "pictures"; times: number[]; pictures: string[] }
  /** A robot from above: x, y and heading at each time; and the picture of its floor with its size in metres. */
  | { kind: "path"; times: number[]; poses: number[]; floor: { picture: string; width: number; height: number } | null };

/** Curves of watched values, over the whole time of the film. */
export interface FilmedPlots {
  svg: string;
  /** The parts of the drawing's width at which the time begins and ends. */
  left: number;
  right: number;
}

/** The content of a drawing, by the numbers of the net. */
export interface Drawn {
  places: ReadonlySet<number>;
  pages: ReadonlySet<number>;
  /** Pages that can show the running behaviour; those of subsystems have one. */
  subsystems: readonly number[];
}

/** More firings make a file too large for browsers. */
export const mostFirings = 50_000;

/** The name of the file of a film: that of the run, with its times. */
export function filmName(run: string, from?: number, to?: number): string {
  const seconds = (time: number) => `${Number((time / 1e9).toFixed(3))}s`;
  const span = from === undefined || to === undefined ? "" : `_${seconds(from)}-${seconds(to)}`;
  return `${run.replace(/\.[a-z]+$/, "").replace(/[^\w.-]+/g, "_")}${span}`;
}

export function drawnIn(svg: string): Drawn {
  const numbers = (attribute: string) =>
    [...svg.matchAll(new RegExp(`${attribute}="(\\d+)"`, "g"))].map(([, one]) => Number(one));
  return {
    places: new Set(numbers("data-place")),
    pages: new Set(numbers("data-page")),
    subsystems: [...new Set(numbers("data-running"))],
  };
}

/** A run, or a part of one. */
export interface Scenes {
  title: string;
  /** The marking before the first firing. */
  from: Marking;
  firings: readonly number[];
  /** For each firing, in nanoseconds; null: a run without times. */
  times: readonly number[] | null;
  /** Time of the first moment, in nanoseconds. */
  begin: number;
}

export function filmOf(
  { title, from, firings, times, begin }: Scenes,
  net: NetModel,
  drawn: Drawn,
  beside: { length?: number; world?: FilmedWorld | null; plots?: FilmedPlots | null } = {},
): Film {
  const teller = new Teller(net);
  const numbers = new Map<string, number>();
  const turns: number[] = [];
  const told = firings.map((_, at) => {
    const words = teller.at(firings, at);
    if (words.kind !== "step") turns.push(at + 1);
    const sentence = sentenceOf(words);
    const number = numbers.get(sentence) ?? numbers.size;
    numbers.set(sentence, number);
    return number;
  });
  const effects: Film["effects"] = {};
  const names: Film["names"] = {};
  const running = runningOn(net, drawn, from);
  firings.forEach((transition, at) => {
    running.fire(transition, at + 1);
    effects[transition] ??= effectOf(net, transition, drawn);
    names[transition] ??= net.transitions.at(transition)!.name;
  });
  return {
    title,
    begin: begin / 1e9,
    times: times && times.map((time) => time - begin),
    fired: [...firings],
    start: [...tokensIn(net, drawn, from.entries())],
    effects,
    names,
    sentences: [...numbers.keys()],
    told,
    turns,
    length: beside.length ?? null,
    world: beside.world ?? null,
    plots: beside.plots ?? null,
    running: running.changes,
  };
}

/** The behaviours of the subsystems of the drawing: those with a token inside. */
function runningOn(net: NetModel, drawn: Drawn, from: Marking) {
  const pages = new Map<number, number>();
  for (const page of drawn.subsystems) {
    const { layer, subsystem } = net.page(page);
    // The page of a group of behaviours follows that of its subsystem.
    if (layer === "subsystem" && subsystem !== null && !pages.has(subsystem)) pages.set(subsystem, page);
  }
  const tokens = new Map<number, Map<string, number>>();
  const put = (place: number, count: number): number | null => {
    if (count === 0) return null;
    const { subsystem, page } = net.places.at(place)!;
    if (subsystem === null || !pages.has(subsystem)) return null;
    const behaviour = net.behaviourName(page);
    if (behaviour === undefined) return null;
    const inside = tokens.get(subsystem) ?? new Map<string, number>();
    tokens.set(subsystem, inside.set(behaviour, (inside.get(behaviour) ?? 0) + count));
    return subsystem;
  };
  const changes: Film["running"] = [];
  const shown = new Map<number, string>();
  const look = (subsystem: number, after: number) => {
    const now = [...(tokens.get(subsystem) ?? [])].find(([, count]) => count > 0)?.[0] ?? "";
    if ((shown.get(subsystem) ?? "") === now) return;
    shown.set(subsystem, now);
    changes.push([after, pages.get(subsystem)!, now]);
  };
  from.forEach((count, place) => put(place, count));
  for (const subsystem of pages.keys()) look(subsystem, 0);
  return {
    changes,
    fire(transition: number, after: number) {
      const { inputs, outputs } = net.transitions.at(transition)!;
      const touched = [
        ...inputs.map(({ place, weight }) => put(place, -weight)),
        ...outputs.map(({ place, weight }) => put(place, weight)),
      ];
      for (const subsystem of new Set(touched)) if (subsystem !== null) look(subsystem, after);
    },
  };
}

function effectOf(net: NetModel, transition: number, drawn: Drawn): [number, number][] {
  const { inputs, outputs } = net.transitions.at(transition)!;
  return tokensIn(net, drawn, [
    ...inputs.map(({ place, weight }): [number, number] => [place, -weight]),
    ...outputs.map(({ place, weight }): [number, number] => [place, weight]),
  ]);
}

/** The sum of tokens of each place of the drawing, and inside each of its pages; without those that are zero. */
function tokensIn(net: NetModel, drawn: Drawn, tokens: Iterable<[place: number, tokens: number]>): [number, number][] {
  const sums = new Map<number, number>();
  const add = (key: number, count: number) => sums.set(key, (sums.get(key) ?? 0) + count);
  for (const [place, count] of tokens) {
    if (count === 0) continue;
    if (drawn.places.has(place)) add(place, count);
    for (let page = net.places.at(place)!.page; page !== null; page = net.page(page).parent)
      if (drawn.pages.has(page) && net.page(page).layer !== "system") add(-1 - page, count);
  }
  return [...sums].filter(([, count]) => count !== 0);
}
