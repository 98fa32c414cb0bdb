import { useEffect, useRef } from "react";
import { useStore, useStudio } from "../../hooks/use";
import type { Replay } from "../../live/replay";
import type { Pane } from "../../live/scene";
import type { Track } from "../../live/track";
import { clock } from "../plots/clock";
import { IconButton } from "../icons";
import { stateTitles } from "../pane_title";

/**
 * The controls below a drawing with steps: back, forward, run, and any position.
 * `beside`: there is another pane.
 */
export function Player({ pane, beside, fixed }: { pane: Pane; beside: boolean; fixed: boolean }) {
  if (pane.replay) return <RecordingPlayer replay={pane.replay} beside={beside} fixed={fixed} />;
  if (pane.track) return beside ? <RunBar track={pane.track} /> : null;
  return <StepPlayer />;
}

/** The controls of the only pane, as wide as the window: a long recording needs the width. */
export function WholePlayer() {
  const studio = useStudio();
  const panes = useStore(studio.scene.store, (all) => all.panes);
  const loaded = useStore(studio.draft.store, (draft) => draft.loaded);
  const only = panes.length === 1 ? panes[0] : undefined;
  if (!loaded || !only) return null;
  return (
    <div className="whole-player">
      <Player key={only.id} pane={only} beside={false} fixed={false} />
    </div>
  );
}

function RecordingPlayer({ replay, beside, fixed }: { replay: Replay; beside: boolean; fixed: boolean }) {
  const studio = useStudio();
  const { time, playing, speed, loading } = useStore(replay.store, (all) => all);
  const { name, first, last } = replay;
  return (
    <div className="player" role="group" aria-label={`Recording ${name}`}>
      {!beside && (
        <span className="title" title={name}>
          {name}
        </span>
      )}
      <IconButton name="back" label="Back to the last firing" disabled={fixed} onClick={() => replay.step(-1)} />
      <IconButton
        name={playing ? "pause" : "play"}
        label={playing ? "Pause" : "Play"}
        disabled={fixed}
        onClick={() => replay.play(!playing)}
      />
      <IconButton name="forward" label="To the next firing" disabled={fixed} onClick={() => replay.step(1)} />
      <input
        type="range"
        aria-label="Time"
        aria-valuetext={`${clock(time)} seconds`}
        min={first}
        max={Math.max(first + 1, last)}
        step="any"
        value={time}
        disabled={fixed}
        onChange={(event) => replay.seek(Number(event.target.value))}
      />
      <span className="position">
        {clock(time)}
        <span className="whole"> / {clock(last)} s</span>
        {replay.lacksBeginning && (
          <span title="Its limit has dropped what was before. tessera simulate --record-limit none keeps everything.">
            {" "}
            from {clock(first)} s on
          </span>
        )}
        {replay.cut && <span title="The controller was killed, or is still running"> cut off</span>}
        {loading && <span role="status"> loading…</span>}
      </span>
      <select
        aria-label="Speed"
        value={speed}
        disabled={fixed}
        onChange={(event) => replay.store.set({ speed: Number(event.target.value) })}
      >
        {[0.1, 0.5, 1, 2, 10, 100].map((one) => (
          <option key={one} value={one}>
            {one} ×
          </option>
        ))}
      </select>
      {!beside && <button onClick={() => studio.recordings.close(replay)}>Close</button>}
    </div>
  );
}

/** The most important controls of a run beside another pane. */
function RunBar({ track }: { track: Track }) {
  const studio = useStudio();
  const { state, kind } = useStore(studio.runner.store, (all) => all);
  const position = useRef<HTMLSpanElement>(null);
  useEffect(() => {
    const tell = () => {
      if (position.current) position.current.textContent = `${clock(track.now)} s`;
    };
    tell();
    const timer = setInterval(tell, 100);
    return () => clearInterval(timer);
  }, [track]);
  const paused = state === "paused";
  return (
    <div className="player" role="group" aria-label="The run">
      {kind !== "run" && kind !== "deployment" && (paused || state === "running") && (
        <IconButton
          name={paused ? "play" : "pause"}
          label={paused ? "Resume the run" : "Pause the run"}
          onClick={() => void studio.runner.control({ command: paused ? "resume" : "pause" })}
        />
      )}
      <span className="faint">{stateTitles[state]}</span>
      <span className="spring" />
      <span ref={position} className="position" />
    </div>
  );
}

function StepPlayer() {
  const studio = useStudio();
  const play = useStore(studio.play.store, (all) => all);
  if (play.what === "nothing") return null;
  const { play: player } = studio;
  return (
    <div className="player" role="group" aria-label={play.title}>
      <span className="title">{play.title.replaceAll("_", " ")}</span>
      <IconButton name="first" label="To the beginning" onClick={() => player.seek(0)} />
      <IconButton name="back" label="Step back" disabled={play.position === 0} onClick={() => player.back()} />
      <IconButton
        name={play.running ? "pause" : "play"}
        label={play.running ? "Pause" : "Play"}
        onClick={() => player.run(!play.running)}
      />
      <IconButton name="forward" label="Step forward" disabled={play.position >= play.length} onClick={() => player.forward()} />
      <IconButton name="last" label="To the end" onClick={() => player.seek(play.length)} />
      <input
        type="range"
        aria-label="Position"
        min={0}
        max={Math.max(1, play.length)}
        value={play.position}
        onChange={(event) => player.seek(Number(event.target.value))}
      />
      <span className="position">
        {play.position} / {play.length}
      </span>
      <button onClick={() => player.stop()}>Close</button>
    </div>
  );
}
