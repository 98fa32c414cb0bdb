import { useEffect, useState } from "react";
import { useStore, useStudio } from "../../hooks/use";
import { showPlace } from "../../live/show_place";
import type { Replay } from "../../live/run/replay";
import type { Track } from "../../live/run/track";
import { breakable } from "../../model/net/labels";
import { sentenceOf, Teller, type Words } from "../../model/run/words";
import { clock } from "../plots/clock";

/** A firing that the line tells, with the values that its condition has read. */
interface Told {
  words: Words;
  values: readonly string[];
  /** Nanoseconds; null: it has no time. */
  t: number | null;
}

/** Firings before the one that is told say why a behaviour was left. */
const before = 4000;
/** Milliseconds between two looks at what runs: nobody reads faster. */
const pause = 250;

function Sentence({ told, standing, empty }: { told: Told | null; standing: boolean; empty: string }) {
  const studio = useStudio();
  if (!told) return <p className="line-words faint">{empty}</p>;
  const { words, values, t } = told;
  const show = () => showPlace(studio, words.place);
  return (
    <p className="line-words" aria-live={standing ? "polite" : "off"}>
      <button className="link" title="Show it in the drawing" onClick={show}>
        <span className="sentence">{breakable(sentenceOf(words))}</span>
        {values.length > 0 && <span className="read"> ({values.join(", ")})</span>}
        {t !== null && <span className="at"> at {clock(t)} s</span>}
      </button>
    </p>
  );
}

/** Looks again after a while, as long as something goes on. */
function useLook<T>(look: () => T, on: boolean, key: unknown): T {
  const [seen, setSeen] = useState(look);
  useEffect(() => {
    const again = () =>
      setSeen((last) => {
        const next = look();
        return JSON.stringify(last) === JSON.stringify(next) ? last : next;
      });
    again();
    if (!on) return;
    const timer = setInterval(again, pause);
    return () => clearInterval(timer);
    // `look` reads the same things that `key` names.
  }, [on, key]);
  return seen;
}

/** While a run goes on: the last change of behaviour. When it stands: the last firing. */
function lastOf(track: Track, stands: boolean): Told | null {
  const { log } = track;
  if (!stands) {
    const event = log.lastTold(Infinity);
    if (!event?.firing) return null;
    return { words: log.teller.words(event.firing.transition, event.firing.ending), values: [], t: event.t };
  }
  const run = log.firings.slice(-before).map(([, transition]) => transition);
  if (run.length === 0) return null;
  const words = log.teller.at(run, run.length - 1);
  // The values of a run that stands are those at its last firing.
  return { words, values: log.teller.values(words, (path) => track.series.at(path, track.now)), t: log.last![0] };
}

export function LastOfRun({ track, stands }: { track: Track; stands: boolean }) {
  // The firings of a step arrive a little before or after the news that the run stands.
  const told = useLook(() => lastOf(track, stands), true, `${track.id} ${stands}`);
  return <Sentence told={told} standing={stands} empty={stands ? "Nothing has fired yet." : "No behaviour has changed yet."} />;
}

function lastOfReplay(replay: Replay, stands: boolean): Told | null {
  const { track } = replay;
  const { teller } = track.log;
  const time = track.now;
  if (!stands) {
    const event = track.log.lastTold(time);
    if (!event?.firing) return null;
    return { words: teller.words(event.firing.transition, event.firing.ending), values: [], t: event.t };
  }
  const rows = replay.fired(before);
  if (rows.length === 0) return null;
  const words = teller.at(
    rows.map(([, transition]) => transition),
    rows.length - 1,
  );
  const [t] = rows.at(-1)!;
  return { words, values: teller.values(words, (path) => track.series.at(path, t)), t };
}

export function LastOfRecording({ replay }: { replay: Replay }) {
  const { playing, time } = useStore(replay.store, (all) => all);
  const told = useLook(() => lastOfReplay(replay, !playing), playing, `${replay.id} ${playing ? "" : time} ${replay.track.id}`);
  return <Sentence told={told} standing={!playing} empty="Nothing has fired yet." />;
}

let tellers: { net: object; teller: Teller } | null = null;

/** For the token game and counterexamples, which have steps and no times. */
export function LastOfPlay() {
  const { play } = useStudio();
  const { position, running } = useStore(play.store, (all) => all);
  const { net, steps } = play;
  if (!net) return null;
  if (tellers?.net !== net) tellers = { net, teller: new Teller(net) };
  const run = steps.slice(Math.max(0, position - before), position);
  const known = run.length > 0 && run.at(-1)! < net.transitions.length;
  const told = known ? { words: tellers.teller.at(run, run.length - 1), values: [], t: null } : null;
  const empty = run.length > 0 ? "No initial condition holds." : "Nothing has fired yet.";
  return <Sentence told={told} standing={!running} empty={empty} />;
}
