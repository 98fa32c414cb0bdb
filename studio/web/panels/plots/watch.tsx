import { useLayoutEffect, useRef } from "react";
import { useStore, useStudio } from "../../hooks/use";
import type { Track } from "../../live/run/track";
import { TimelineLanes } from "./timeline_lanes";
import { usePaneTitle } from "../pane_title";
import { ValueList } from "./value_list";
import { WorldPane } from "../world/world_pane";

/** The run or recording of each pane, with the one beside it. */
function useWatched() {
  const studio = useStudio();
  const { panes, sameTime } = useStore(studio.scene.store, (all) => all);
  const title = usePaneTitle();
  const watched = panes.filter(({ track }) => track !== null);
  return watched.map((pane, at) => ({
    id: pane.id,
    label: watched.length > 1 ? title(pane) : "Run",
    /** Its title, if there are two. */
    title: watched.length > 1 ? title(pane) : "",
    track: pane.track!,
    replay: pane.replay,
    /** Whether its time is that of the pane beside it. */
    fixed: sameTime && at === 1,
    beside: watched[1 - at]?.track ?? null,
  }));
}

/** Behaviours and firings over time, of each run or recording that is shown. */
export function Timelines() {
  const studio = useStudio();
  const seconds = useStore(studio.watched, (all) => all.seconds);
  const marked = useStore(studio.measured.store, (all) => all.marked);
  return (
    <div className="watches">
      {useWatched().map(({ id, label, title, track, replay, fixed }) => (
        <section key={id} className="watch-pane timeline" aria-label={`Timeline of ${label}`}>
          <div className="watch-title">
            {title && <h2 title={title}>{title}</h2>}
            <Facts track={track} />
            <span className="spring" />
            <select
              aria-label="Time shown"
              value={seconds}
              onChange={(event) => studio.watched.set({ seconds: Number(event.target.value) })}
            >
              {[1, 3, 10, 60, 600].map((choice) => (
                <option key={choice} value={choice}>
                  {choice < 60 ? `${choice} s` : `${choice / 60} min`}
                </option>
              ))}
            </select>
          </div>
          <TimelineLanes
            track={track}
            seconds={seconds}
            marked={marked && marked.recording === replay?.name ? marked : null}
            onSeek={replay && !fixed ? (time) => replay.seek(time) : undefined}
          />
        </section>
      ))}
    </div>
  );
}

/** The values of each run or recording that is shown. */
export function ValueLists() {
  const studio = useStudio();
  const seconds = useStore(studio.watched, (all) => all.seconds);
  return (
    <div className="watches">
      {useWatched().map(({ id, label, title, track, replay }) => (
        <section key={id} className="watch-pane values" aria-label={`Values of ${label}`}>
          {title && (
            <div className="watch-title">
              <h2 title={title}>{title}</h2>
            </div>
          )}
          <ValueList track={track} seconds={seconds} none={replay ? "This recording holds no values" : "No values yet"} />
        </section>
      ))}
    </div>
  );
}

/** The world of each run or recording that is shown. */
export function Worlds() {
  return (
    <div className="watches">
      {useWatched().map(({ id, label, title, track, replay, beside }) => (
        <section key={id} className="watch-world" aria-label={`World of ${label}`}>
          <WorldPane
            title={title}
            track={track}
            beside={beside}
            none={`${replay ? "This recording holds no path" : "No path"} of a single robot`}
          />
        </section>
      ))}
    </div>
  );
}

/** Counts that change all the time; a screen reader does not announce them. */
function Facts({ track }: { track: Track }) {
  const studio = useStudio();
  const { state } = useStore(studio.runner.store, (all) => all);
  const ref = useRef<HTMLSpanElement>(null);
  // A run that is shown as paused has the counts of its pause.
  useLayoutEffect(() => {
    const tell = () => {
      const dropped = track.dropped > 0 ? ` (${track.dropped.toLocaleString("en")} only counted)` : "";
      if (ref.current)
        ref.current.textContent = `${(track.now / 1e9).toFixed(2)} s · ${track.firings.toLocaleString("en")} firings${dropped}`;
    };
    tell();
    const timer = setInterval(tell, 100);
    return () => clearInterval(timer);
  }, [track, state]);
  const sampled = "The run fires faster than can be sent: some firings are counted and not drawn one by one";
  return <span ref={ref} className="facts" data-testid="run-facts" title={sampled} />;
}
