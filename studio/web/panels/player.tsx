import { useStore, useStudio } from "../app/use";
import { Icon } from "./icons";

/** Below the drawing while something is stepped through: back, forward, let it run, to any position. */
export function Player() {
  const studio = useStudio();
  const recording = useStore(studio.recordings.store, (all) => all.open);
  return recording === null ? <StepPlayer /> : <RecordingPlayer />;
}

const clock = (nanoseconds: number) => (nanoseconds / 1e9).toFixed(2);

function RecordingPlayer() {
  const studio = useStudio();
  const { open, time, first, last, playing, speed } = useStore(studio.recordings.store, (all) => all);
  const { recordings } = studio;
  return (
    <div className="player" role="group" aria-label={`Recording ${open}`}>
      <span className="title">{open}</span>
      <button className="icon" aria-label="Back to the last firing" onClick={() => recordings.step(-1)}>
        <Icon name="back" />
      </button>
      <button
        className="icon"
        aria-label={playing ? "Pause" : "Play"}
        onClick={() => (time >= last && recordings.seek(first), recordings.play(!playing))}
      >
        <Icon name={playing ? "pause" : "play"} />
      </button>
      <button className="icon" aria-label="To the next firing" onClick={() => recordings.step(1)}>
        <Icon name="forward" />
      </button>
      <input
        type="range"
        aria-label="Time"
        aria-valuetext={`${clock(time)} seconds`}
        min={first}
        max={Math.max(first + 1, last)}
        step="any"
        value={time}
        onChange={(event) => recordings.seek(Number(event.target.value))}
      />
      <span className="position">
        {clock(time)} / {clock(last)} s
      </span>
      <select aria-label="Speed" value={speed} onChange={(event) => recordings.setSpeed(Number(event.target.value))}>
        {[0.1, 0.5, 1, 2, 10, 100].map((one) => (
          <option key={one} value={one}>
            {one} ×
          </option>
        ))}
      </select>
      <button onClick={() => recordings.close()}>Close</button>
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
      <button className="icon" aria-label="To the beginning" onClick={() => player.seek(0)}>
        <Icon name="first" />
      </button>
      <button className="icon" aria-label="Step back" disabled={play.position === 0} onClick={() => player.back()}>
        <Icon name="back" />
      </button>
      <button className="icon" aria-label={play.running ? "Pause" : "Let it run"} onClick={() => player.run(!play.running)}>
        <Icon name={play.running ? "pause" : "play"} />
      </button>
      <button className="icon" aria-label="Step forward" disabled={play.position >= play.length} onClick={() => player.forward()}>
        <Icon name="forward" />
      </button>
      <button className="icon" aria-label="To the end" onClick={() => player.seek(play.length)}>
        <Icon name="last" />
      </button>
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
