import { useStore, useStudio } from "../../hooks/use";
import type { Replay } from "../../live/run/replay";
import type { Pane } from "../../live/scene";
import { clock } from "../plots/clock";
import { IconButton } from "../icons";

/** The controls of a recording beside another pane. Those of the first pane are in the line of the run. */
export function Player({ pane, fixed }: { pane: Pane; fixed: boolean }) {
  return pane.replay && <RecordingPlayer replay={pane.replay} beside fixed={fixed} />;
}

/** Back, forward, play, and any time of a recording. beside: there is another pane, and this one has a title. */
export function RecordingPlayer({ replay, beside, fixed }: { replay: Replay; beside: boolean; fixed: boolean }) {
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

/** Steps in both directions, for the token game and for counterexamples. */
export function StepPlayer() {
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
