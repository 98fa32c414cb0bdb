import { useDeferredValue, useEffect, useMemo, useState } from "react";
import { useStore, useStudio } from "../../hooks/use";
import type { Pane } from "../../live/scene";
import type { Track } from "../../live/run/track";
import { showPlace } from "../../live/show_place";
import { eventKinds, filtered, type EventKind, type LogFilter, type LogRow } from "../../model/run/event_log";
import { clock } from "../plots/clock";
import { EventList } from "./event_list";
import { recordingOf } from "./recording_of";

const kindNames = Object.keys(eventKinds) as EventKind[];
/** Milliseconds between two looks at a log that grows. */
const pause = 250;

/** A different number whenever the log has changed; at most four times a second. */
function useVersion(track: Track): number {
  const [version, setVersion] = useState(track.log.version);
  useEffect(() => {
    const look = () => setVersion(track.log.version);
    look();
    const timer = setInterval(look, pause);
    return () => clearInterval(timer);
  }, [track]);
  return version;
}

/** The log of what is shown: of the run, or of the recording. */
export default function EventPanel() {
  const studio = useStudio();
  const panes = useStore(studio.scene.store, (all) => all.panes);
  const [chosen, setChosen] = useState(0);
  const tracked = panes.filter(({ track }) => track !== null);
  const pane = tracked[Math.min(chosen, tracked.length - 1)];
  if (!pane?.track) return <p className="pane-empty">Events are listed while a run or a recording is shown.</p>;
  return (
    <div className="event-panel">
      {tracked.length > 1 && (
        <select aria-label="Events of" value={tracked.indexOf(pane)} onChange={(event) => setChosen(Number(event.target.value))}>
          {tracked.map((one, at) => (
            <option key={one.id} value={at}>
              {one.replay ? one.replay.name : "The run"}
            </option>
          ))}
        </select>
      )}
      <Log key={pane.track.id} pane={pane} track={pane.track} />
    </div>
  );
}

function Log({ pane, track }: { pane: Pane; track: Track }) {
  const studio = useStudio();
  const version = useVersion(track);
  const [off, setOff] = useState<ReadonlySet<EventKind>>(new Set());
  const [firings, setFirings] = useState(false);
  const [of, setOf] = useState("");
  const [typed, setTyped] = useState("");
  const text = useDeferredValue(typed.trim().toLowerCase());
  const part = useDeferredValue(of.trim());
  const rows = useMemo(() => {
    const filter: LogFilter = { kinds: new Set(kindNames.filter((kind) => !off.has(kind))), firings, of: part, text };
    // The log is changed in place: `version` says when.
    return version < 0 ? [] : filtered(track.log, filter);
  }, [track, version, off, firings, part, text]);
  const paths = useMemo(() => pathsOf(track), [track]);
  const there = useMemo(
    () => (version < 0 ? new Set<EventKind>() : new Set(track.log.events.map(({ kind }) => kind))),
    [track, version],
  );
  const toggle = (kind: EventKind) => {
    const next = new Set(off);
    if (!next.delete(kind)) next.add(kind);
    setOff(next);
  };
  const go = (row: LogRow) => {
    if (row.place) showPlace(studio, row.place);
    if (pane.replay) pane.replay.seek(row.t);
  };
  return (
    <>
      <div className="event-filter">
        <input
          type="text"
          aria-label="Text in the events"
          placeholder="filter"
          value={typed}
          onChange={(event) => setTyped(event.target.value)}
        />
        <input
          type="text"
          aria-label="Agent or subsystem"
          placeholder="subsystem"
          list={`paths-${track.id}`}
          value={of}
          onChange={(event) => setOf(event.target.value)}
        />
        <datalist id={`paths-${track.id}`}>
          {paths.map((path) => (
            <option key={path} value={path} />
          ))}
        </datalist>
        <div className="event-kinds" role="group" aria-label="Kinds of events">
          {kindNames
            .filter((kind) => there.has(kind) || off.has(kind))
            .map((kind) => (
              <button key={kind} className={`kind-toggle ${kind}`} aria-pressed={!off.has(kind)} onClick={() => toggle(kind)}>
                {eventKinds[kind]}
              </button>
            ))}
          <button
            className="kind-toggle firing"
            aria-pressed={firings}
            title="Each firing of a transition, also those within behaviours"
            onClick={() => setFirings(!firings)}
          >
            Each firing
          </button>
        </div>
      </div>
      <Missing pane={pane} track={track} firings={firings} />
      <EventList log={track.log} rows={rows} replay={pane.replay} go={go} />
    </>
  );
}

/** The things that the log does not have. */
function Missing({ pane, track, firings }: { pane: Pane; track: Track; firings: boolean }) {
  const studio = useStudio();
  const outcome = useStore(studio.runner.store, (all) => all.outcome);
  const { lost, firings: known } = track.log;
  const dropped = pane.replay ? 0 : track.dropped;
  const said: string[] = [];
  if (lost.events > 0) said.push(`The ${lost.events} oldest events are no longer kept.`);
  if (lost.notices > 0) said.push(`${lost.notices} older notices of the controller are left out.`);
  if (firings && lost.firings > 0) said.push(`The ${lost.firings} oldest firings are no longer kept.`);
  if (dropped > 0) said.push(`${dropped} firings came too fast to be listed one by one; the recording has them all.`);
  const { replay } = pane;
  if (replay && !(replay.isHere(replay.first) && replay.isHere(replay.last)))
    said.push(
      `Firings from ${clock(known[0]?.[0] ?? 0)} s to ${clock(track.known)} s are loaded. Go to another time to load others.`,
    );
  const recording = pane.id === "run" && outcome ? recordingOf(outcome.recording) : null;
  return (
    <>
      {said.length > 0 && <p className="event-missing faint">{said.join(" ")}</p>}
      {recording !== null && (
        <p className="event-missing">
          <button className="link" onClick={() => void studio.replay(recording, 0).then(() => studio.runner.show(false))}>
            Open the recording of this run
          </button>{" "}
          to go to the time of an event.
        </p>
      )}
    </>
  );
}

/** The agents and the subsystems, without those of a crowd beyond a thousand. */
function pathsOf(track: Track): string[] {
  const subsystems = track.timeline.lanes.map(({ path }) => path).slice(0, 1000);
  return [...new Set(subsystems.flatMap((path) => [path.split(".")[0]!, path]))];
}
