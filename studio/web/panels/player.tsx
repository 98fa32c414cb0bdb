import { useStore, useStudio } from "../app/use";
import { Icon } from "./icons";

/** Below the drawing while something is stepped through: back, forward, let it run, to any position. */
export function Player() {
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
      <input type="range" aria-label="Position" min={0} max={Math.max(1, play.length)} value={play.position} onChange={(event) => player.seek(Number(event.target.value))} />
      <span className="position">
        {play.position} / {play.length}
      </span>
      <button onClick={() => player.stop()}>Close</button>
    </div>
  );
}
