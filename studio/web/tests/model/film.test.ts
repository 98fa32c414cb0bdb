import { describe, expect, it } from "vitest";
import { filmPage } from "../../panels/film/film_page";
import { drawnIn, filmName, filmOf, type Drawn } from "../../model/run/film";
import { initialMarking, runningBehaviours, Walk } from "../../model/net/game";
import { activeTransitions } from "../../model/net/game";
import { sentenceOf, Teller } from "../../model/run/words";
import { lineFollower } from "./line_follower";

const net = lineFollower();
const indices = ({ length }: { length: number }) => Array.from({ length }, (_, at) => at);

/** So many firings of the token game, drawn by a rule. */
function played(length: number): number[] {
  const walk = new Walk(net);
  while (walk.position < length) {
    const active = activeTransitions(net, walk.marking);
    walk.choose(active[(walk.position * 7) % active.length]!);
  }
  return walk.steps;
}

const firings = played(300);
const everything: Drawn = {
  places: new Set(indices(net.places)),
  pages: new Set(indices(net.pages)),
  subsystems: [...indices(net.pages)],
};
const scenes = { title: "a run", from: initialMarking(net), firings, times: firings.map((_, at) => 5e9 + at * 1e7), begin: 5e9 };

const colours = {
  accent: "#123",
  runs: "#456",
  background: "#fff",
  surface: "#fff",
  text: "#000",
  soft: "#555",
  line: "#ddd",
  isDark: false,
};

describe("a film", () => {
  it("shows the marking of every moment, the pages with tokens inside, and what runs", () => {
    const film = filmOf(scenes, net, everything);
    const walk = new Walk(net, firings);
    const tokens = new Map(film.start);
    const running = new Map<number, string>();
    for (let at = 0; ; at += 1) {
      for (const [after, page, behaviour] of film.running) if (after === at) running.set(page, behaviour);
      indices(net.places).forEach((place) => expect(tokens.get(place) ?? 0).toBe(walk.marking[place]));
      for (const index of indices(net.pages)) {
        if (net.page(index).layer === "system") continue;
        let inside = 0;
        indices(net.places).forEach((flat) => {
          for (let up = net.places.at(flat)!.page; up !== null; up = net.page(up).parent)
            if (up === index) inside += walk.marking[flat]!;
        });
        expect(tokens.get(-1 - index) ?? 0).toBe(inside);
      }
      const now = runningBehaviours(net, walk.marking);
      for (const page of running.keys()) expect(net.page(page).layer).toBe("subsystem");
      for (const page of net.subsystemPages()) expect(running.get(page) ?? "").toBe(now.get(net.page(page).subsystem!) ?? "");
      if (at === firings.length) break;
      for (const [place, change] of film.effects[film.fired[at]!]!) tokens.set(place, (tokens.get(place) ?? 0) + change);
      expect(walk.forward()).toBe(true);
    }
    expect(film.times!.slice(0, 2)).toEqual([0, 1e7]);
    expect(film.begin).toBe(5);
  });
  it("holds what the drawing shows, and no more", () => {
    const drawn = drawnIn('<svg><g data-place="3"/><g data-page="2"/><text data-running="2"/><g data-place="3"/></svg>');
    expect(drawn).toEqual({ places: new Set([3]), pages: new Set([2]), subsystems: [2] });
    const film = filmOf(scenes, net, drawn);
    for (const changes of Object.values(film.effects)) for (const [place] of changes) expect([3, -3]).toContain(place);
  });
  it("tells each firing in the words of the studio, each sentence once", () => {
    const { sentences, told, turns, fired } = filmOf(scenes, net, everything);
    const teller = new Teller(net);
    expect(told).toHaveLength(fired.length);
    told.forEach((number, at) => expect(sentences[number]).toBe(sentenceOf(teller.at(fired, at))));
    expect(turns).toEqual(fired.flatMap((_, at) => (teller.at(fired, at).kind === "step" ? [] : [at + 1])));
    expect(turns.length).toBeGreaterThan(2);
    expect(new Set(sentences).size).toBe(sentences.length);
  });
  it("is named after its run and its times", () => {
    expect(filmName("run_2026-11-28_19.42.00.tessera", 1.25e9, 9e9)).toBe("run_2026-11-28_19.42.00_1.25s-9s");
    expect(filmName("Deadlock of a/b: robot")).toBe("Deadlock_of_a_b_robot");
  });
  it("is a page that no name can break", () => {
    const page = filmPage(filmOf({ ...scenes, title: '</script><b>&"' }, net, everything), "<svg/>", colours);
    expect(page.match(/<\/script>/g)).toHaveLength(2);
    expect(page).toContain("<title>&#60;/script&#62;&#60;b&#62;&#38;&#34;</title>");
    expect(page).not.toMatch(/https?:/);
  });
});
