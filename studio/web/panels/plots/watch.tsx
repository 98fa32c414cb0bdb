import { useLayoutEffect, useRef, useState } from "react";
import { useHasWorld, useStore, useStudio } from "../../hooks/use";
import type { Replay } from "../../live/replay";
import type { Track } from "../../live/track";
import { drawTimeline, timeAt } from "./draw_timeline";
import { Painted } from "../world/painted";
import { PlotPanel } from "./plot_panel";
import { usePaneTitle } from "../pane_title";
import { ValueList } from "./value_list";
import { WorldPane } from "../world/world_pane";

/** The panels below the drawing during a run or replay: timeline, values, and the world from above. */
export function Watches() {
  const studio = useStudio();
  const { panes, sameTime } = useStore(studio.scene.store, (all) => all);
  const [seconds, setSeconds] = useState(10);
  const title = usePaneTitle();
  const watched = panes.filter(({ track }) => track !== null);
  const hasPlot = useStore(studio.plots.store, ({ plots, active }) => plots.length > 1 || plots[active]!.signals.length > 0);
  if (watched.length === 0) return null;
  return (
    <>
      {hasPlot && <PlotPanel />}
      <div className={`watches${watched.length > 1 ? " two" : ""}`}>
        {watched.map((pane, at) => (
          <Watch
            key={pane.id}
            label={watched.length > 1 ? title(pane) : "Run"}
            track={pane.track!}
            replay={pane.replay}
            seconds={seconds}
            onSeconds={setSeconds}
            fixed={sameTime && at === 1}
            beside={watched[1 - at]?.track ?? null}
          />
        ))}
      </div>
    </>
  );
}

interface WatchProps {
  label: string;
  track: Track;
  replay: Replay | null;
  seconds: number;
  onSeconds: (seconds: number) => void;
  /** Whether its time is that of the pane beside it. */
  fixed: boolean;
  beside: Track | null;
}

function Watch({ label, track, replay, seconds, onSeconds, fixed, beside }: WatchProps) {
  const hasWorld = useHasWorld();
  return (
    <section className={`watch${hasWorld ? "" : " without-world"}`} aria-label={label}>
      <div className="watch-pane timeline">
        <div className="watch-title">
          <h2>Timeline</h2>
          <Facts track={track} />
          <span className="spring" />
          <select aria-label="Time shown" value={seconds} onChange={(event) => onSeconds(Number(event.target.value))}>
            {[1, 3, 10, 60, 600].map((choice) => (
              <option key={choice} value={choice}>
                {choice < 60 ? `${choice} s` : `${choice / 60} min`}
              </option>
            ))}
          </select>
        </div>
        <Painted
          label="Behaviours and firings of each subsystem over time"
          draw={(context, size, colours) => drawTimeline(context, size, colours, track, seconds)}
          of={() => `${track.id} ${track.now} ${track.firings} ${seconds}`}
          onPick={replay && !fixed ? (x, width) => replay.seek(timeAt(track, seconds, x, width)) : undefined}
        />
      </div>
      <div className="watch-pane values">
        <div className="watch-title">
          <h2>Values</h2>
        </div>
        <ValueList track={track} seconds={seconds} none={replay ? "This recording holds no values" : "No values yet"} />
      </div>
      {hasWorld && (
        <WorldPane
          track={track}
          beside={beside}
          none={`${replay ? "This recording holds no path" : "No path"} of a single robot`}
        />
      )}
    </section>
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
