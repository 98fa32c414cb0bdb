import { useEffect, useRef, useState } from "react";
import { useStore, useStudio } from "../../hooks/use";
import { goesOn } from "../../live/run/runner_state";
import { Icon, IconButton } from "../icons";
import { clock } from "../plots/clock";
import { LastOfRun } from "./last_firing";
import { useRunState } from "./line_state";
import { StateChip } from "./state_chip";

const kinds = {
  simulate: "Simulation",
  run: "Run in real time",
  attach: "Watched controller",
  deployment: "Watched deployment",
};

/** The controls of the run that this page follows, its state and its last firing. */
export function RunLine() {
  const studio = useStudio();
  const { state, kind, shown, why } = useStore(studio.runner.store, (all) => all);
  const line = useRunState();
  const { track } = studio.runner;
  const active = goesOn(state);
  return (
    <div className="line-part" role="group" aria-label={kinds[kind]}>
      <StateChip {...line} />
      {active && <Controls />}
      {track && <Now />}
      {state === "building" ? (
        <LastLine />
      ) : (line.tone === "failed" || line.tone === "stuck" || line.tone === "emergency" || (state === "paused" && why)) &&
        line.why ? (
        <p className="line-words why">{line.why}</p>
      ) : null}
      {state !== "building" && track && <LastOfRun track={track} stands={state !== "running"} />}
      {active && track && !shown && <button onClick={() => studio.showRun()}>Show the run</button>}
      {!active && <IconButton name="remove" label="Put the run away" onClick={() => studio.runner.close()} />}
    </div>
  );
}

/** The last line of the build: it takes a while. */
function LastLine() {
  const studio = useStudio();
  const line = useStore(studio.runner.store, ({ build }) => build.at(-1) ?? "");
  return <p className="line-words faint">{line || "The controller is made: verified, generated, compiled."}</p>;
}

function Controls() {
  const studio = useStudio();
  const { state, kind, speed } = useStore(studio.runner.store, (all) => all);
  const control = studio.runner.control.bind(studio.runner);
  const paused = state === "paused";
  // On the steady clock, a run cannot be paused.
  const paced = kind !== "run" && kind !== "deployment";
  const watched = kind === "attach" || kind === "deployment";
  return (
    <>
      {paced && (
        <button disabled={state === "building"} onClick={() => void control({ command: paused ? "resume" : "pause" })}>
          <Icon name={paused ? "play" : "pause"} /> {paused ? "Resume" : "Pause"}
        </button>
      )}
      {/* The word stands on the button of the step, which does the same. */}
      <IconButton
        name="stop"
        label={watched ? "Stop watching" : "Stop"}
        title={watched ? "Stop watching: the controller runs on" : "Stop: ends the run"}
        onClick={() => void control({ command: "stop" })}
      />
      {paced && state !== "building" && (
        <>
          <Steps paused={paused} />
          <Speed speed={speed} />
        </>
      )}
    </>
  );
}

function Steps({ paused }: { paused: boolean }) {
  const studio = useStudio();
  const net = useStore(studio.draft.store, (draft) => draft.net);
  const [chosen, setChosen] = useState("");
  const drawn = studio.runner.track?.net ?? net;
  const paths = drawn?.subsystemPages().map((page) => drawn.page(page).path) ?? [];
  const subsystem = paths.includes(chosen) ? chosen : paths[0];
  const hint = paused ? "" : " (while the run is paused)";
  const control = studio.runner.control.bind(studio.runner);
  return (
    <span className="line-steps">
      <button
        disabled={!paused}
        aria-label="Step one firing"
        title={`Step one firing${hint}`}
        onClick={() => void control({ command: "step_firing" })}
      >
        <Icon name="forward" /> Firing
      </button>
      <button
        disabled={!paused}
        aria-label="Step one iteration"
        title={`Step one iteration${subsystem ? ` of ${subsystem}` : ""}${hint}`}
        onClick={() => void control({ command: "step_iteration", ...(subsystem ? { subsystem } : {}) })}
      >
        <Icon name="forward" /> Iteration
      </button>
      {paths.length > 1 && (
        <select
          aria-label="Iteration of"
          title={`Iteration of ${subsystem}`}
          value={subsystem}
          onChange={(event) => setChosen(event.target.value)}
        >
          {paths.map((path) => (
            <option key={path}>{path}</option>
          ))}
        </select>
      )}
    </span>
  );
}

const speeds = [0.1, 0.2, 0.5, 1, 2, 5, 10, 50, 0];

function Speed({ speed }: { speed: number }) {
  const studio = useStudio();
  const all = speeds.includes(speed) ? speeds : [speed, ...speeds];
  return (
    <select
      aria-label="Speed"
      title="Simulated seconds a second"
      value={speed}
      onChange={(event) => void studio.runner.setSpeed(Number(event.target.value))}
    >
      {all.map((one) => (
        <option key={one} value={one}>
          {one === 0 ? "fastest" : `${one} ×`}
        </option>
      ))}
    </select>
  );
}

/** The time of the run. It is written past React, since it changes with every frame. */
function Now() {
  const studio = useStudio();
  const { track } = studio.runner;
  const state = useStore(studio.runner.store, (all) => all.state);
  const position = useRef<HTMLSpanElement>(null);
  useEffect(() => {
    const tell = () => {
      if (position.current && track) position.current.textContent = `${clock(track.now)} s`;
    };
    tell();
    const timer = setInterval(tell, 100);
    return () => clearInterval(timer);
  }, [track, state]);
  return <span ref={position} className="line-time" data-testid="line-time" />;
}
