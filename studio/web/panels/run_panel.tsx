import { useCallback, useEffect, useState } from "react";
import { useRunning } from "../app/use_stage";
import { useStore, useStudio } from "../app/use";
import { message } from "../live/draft";
import type { Breakpoint, RunRequest } from "../live/protocol";
import type { NetModel } from "../model/net";
import { Choice, Field } from "./field";
import { Icon } from "./icons";
import { stateTitles } from "./pane_title";

export function RunPanel() {
  const studio = useStudio();
  const runner = useStore(studio.runner.store, (all) => all);
  const active = ["building", "running", "paused"].includes(runner.state);
  return (
    <div className="run-panel">
      {runner.state !== "idle" && (
        <p className={`run-state ${runner.state}`} role="status" data-testid="run-state">
          <span className={`dot ${runner.state === "failed" ? "error" : active ? "good" : ""}`} /> {stateTitles[runner.state]}
          {runner.why && ` — ${runner.why}`}
        </p>
      )}
      {runner.problem && <p className="problem-hint">{runner.problem}</p>}
      {active && !runner.shown && (
        <div className="buttons">
          <button onClick={() => studio.runner.show(true)}>Show it in the drawing</button>
        </div>
      )}
      {active ? <Controls /> : <StartForm />}
      {(runner.state === "running" || runner.state === "paused") && <RunningNow />}
      {runner.outcome && (
        <>
          <h3>Outcome</h3>
          <p className="path">{runner.outcome}</p>
        </>
      )}
      <Breakpoints />
      {runner.build.length > 0 && (
        <details open={runner.state === "building" || runner.state === "failed"}>
          <summary>
            <h3>Build</h3>
          </summary>
          <pre className="build" tabIndex={0} aria-label="Output of the build">
            {runner.build.join("\n")}
          </pre>
        </details>
      )}
    </div>
  );
}

const kinds = [
  { value: "simulate", title: "in the simulated world" },
  { value: "run", title: "on the steady clock, as on the robot" },
  { value: "attach", title: "nothing: watch one that runs already" },
] as const;

/** Controllers that were started elsewhere, to be watched. */
function AttachForm({ kind, onKind }: { kind: RunRequest["kind"]; onKind: (kind: RunRequest["kind"]) => void }) {
  const studio = useStudio();
  const [sockets, setSockets] = useState<readonly string[] | null>(null);
  const [chosen, setChosen] = useState("");
  const [problem, setProblem] = useState("");
  const look = useCallback(
    () =>
      studio.api.controllers().then(
        (found) => (setSockets(found), setProblem("")),
        (error: unknown) => setProblem(message(error)),
      ),
    [studio],
  );
  useEffect(() => void look(), [look]);
  const socket = sockets?.includes(chosen) ? chosen : (sockets?.[0] ?? "");
  return (
    <>
      <Choice label="Run" value={kind} onChange={onKind} choices={kinds} />
      {problem && <p className="problem-hint">{problem}</p>}
      {sockets?.length === 0 && <p className="faint">No controller runs on this machine for this user.</p>}
      {socket && (
        <Choice
          label="Controller"
          value={socket}
          onChange={setChosen}
          choices={sockets!.map((one) => ({ value: one, title: one.replace(/\.sock$/, "") }))}
        />
      )}
      <div className="buttons">
        <button className="primary" disabled={!socket} onClick={() => void studio.runner.start({ kind: "attach", socket })}>
          Watch it
        </button>
        <button onClick={() => void look()}>Look again</button>
      </div>
    </>
  );
}

function StartForm() {
  const studio = useStudio();
  const runner = useStore(studio.runner.store, (all) => all);
  const worlds = useStore(studio.project, (all) => all.project?.worlds ?? []);
  const dirty = useStore(studio.draft.store, (draft) => draft.text !== draft.saved);
  const current = useStore(studio.draft.store, (draft) => draft.current);
  const [kind, setKind] = useState<RunRequest["kind"]>("simulate");
  const [track, setTrack] = useState("");
  const [time, setTime] = useState("60s");
  const [seed, setSeed] = useState("1");
  const [speed, setSpeed] = useState("1");
  const tracks = worlds.flatMap((world) => world.tracks);
  if (kind === "attach") return <AttachForm kind={kind} onKind={setKind} />;
  const start = async (paused: boolean) => {
    // What runs is what is on disk.
    if (dirty && !(await studio.draft.save())) return;
    const simulated = kind === "simulate";
    const request: RunRequest = {
      kind,
      paused,
      ...(time ? { for: time } : {}),
      ...(track ? { track } : {}),
      ...(simulated ? { seed: Number(seed) || 1, speed: Number(speed) || 1 } : {}),
    };
    await studio.runner.start(request);
  };
  return (
    <>
      <Choice label="Run" value={kind} onChange={setKind} choices={kinds} />
      {tracks.length > 0 && (
        <Choice
          label="Track"
          value={track}
          onChange={setTrack}
          choices={[{ value: "", title: "as the specification says" }, ...tracks.map((one) => ({ value: one, title: one }))]}
        />
      )}
      <div className="row">
        <Field label="For" value={time} onChange={setTime} />
        {kind === "simulate" && <Field label="Speed" value={speed} onChange={setSpeed} />}
        {kind === "simulate" && <Field label="Seed" value={seed} onChange={setSeed} />}
      </div>
      <div className="buttons">
        <button className="primary" disabled={!current} onClick={() => void start(false)}>
          {dirty ? "Save and run" : "Run"}
        </button>
        {kind === "simulate" && (
          <button disabled={!current} onClick={() => void start(true)}>
            Start paused
          </button>
        )}
        {runner.state !== "idle" && <button onClick={() => studio.runner.close()}>Close this run</button>}
      </div>
    </>
  );
}

function Controls() {
  const studio = useStudio();
  const { state, kind, speed } = useStore(studio.runner.store, (all) => all);
  const net = useStore(studio.draft.store, (draft) => draft.net);
  const [subsystem, setSubsystem] = useState("");
  const control = studio.runner.control.bind(studio.runner);
  const paused = state === "paused";
  const subsystems = net?.subsystemPages().map((page) => net.page(page).path) ?? [];
  return (
    <>
      <div className="buttons" style={{ marginTop: 0 }}>
        <button disabled={state === "building"} onClick={() => void control({ command: paused ? "resume" : "pause" })}>
          <Icon name={paused ? "play" : "pause"} /> {paused ? "Go on" : "Pause"}
        </button>
        <button onClick={() => void control({ command: "stop" })}>
          <Icon name="stop" /> {kind === "attach" ? "Let go" : "Stop"}
        </button>
      </div>
      {kind !== "run" && (
        <>
          <div className="buttons">
            <button disabled={!paused} onClick={() => void control({ command: "step_firing" })}>
              Step one firing
            </button>
            <button
              disabled={!paused}
              onClick={() =>
                void control({
                  command: "step_iteration",
                  ...(subsystem || subsystems[0] ? { subsystem: subsystem || subsystems[0]! } : {}),
                })
              }
            >
              Step one iteration
            </button>
          </div>
          {subsystems.length > 1 && (
            <Choice
              label="Iteration of"
              value={subsystem || subsystems[0]!}
              onChange={setSubsystem}
              choices={subsystems.map((path) => ({ value: path, title: path }))}
            />
          )}
          <SpeedSlider speed={speed} onChange={(value) => void studio.runner.setSpeed(value)} />
        </>
      )}
    </>
  );
}

function SpeedSlider({ speed, onChange }: { speed: number; onChange: (speed: number) => void }) {
  const exact = (power: number) => Number((10 ** power).toPrecision(2));
  return (
    <div className="field">
      <label htmlFor="speed">
        Speed <strong>{speed} ×</strong>
      </label>
      <input
        id="speed"
        type="range"
        min={-1}
        max={2}
        step={0.1}
        value={Math.log10(speed)}
        onChange={(event) => onChange(exact(Number(event.target.value)))}
      />
    </div>
  );
}

/** What is running now, in one look. */
function RunningNow() {
  const studio = useStudio();
  const running = useRunning(studio.runner.stage);
  return (
    <>
      <h3>Running now</h3>
      <ul className="running-now">
        {[...running].slice(0, 60).map(([path, behaviour]) => (
          <li key={path}>
            <button className="choice" onClick={() => studio.flyTo(`${path}.${behaviour}`)}>
              <span className="path">{path}</span>
              <span className="chip running">{behaviour}</span>
            </button>
          </li>
        ))}
      </ul>
    </>
  );
}

function Breakpoints() {
  const studio = useStudio();
  const breakpoints = useStore(studio.runner.store, (all) => all.breakpoints);
  const net = useStore(studio.draft.store, (draft) => draft.net);
  if (breakpoints.length === 0 || !net) return null;
  return (
    <>
      <h3>Breakpoints</h3>
      <ul className="choice-list">
        {breakpoints.map((breakpoint) => {
          const { path, where } = placeOf(net, breakpoint);
          return (
            <li key={where}>
              <button className="choice" onClick={() => studio.flyTo(path)}>
                {where}
              </button>
              <button
                className="icon"
                aria-label={`Remove the breakpoint at ${where}`}
                onClick={() => studio.runner.toggleBreakpoint(breakpoint)}
              >
                <Icon name="remove" />
              </button>
            </li>
          );
        })}
      </ul>
    </>
  );
}

function placeOf(net: NetModel, breakpoint: Breakpoint): { path: string; where: string } {
  if ("place" in breakpoint) {
    const path = net.places[breakpoint.place]?.name ?? "";
    return { path, where: path };
  }
  if ("transition" in breakpoint) {
    const path = net.transitions[breakpoint.transition]?.name ?? "";
    return { path, where: path };
  }
  const path = net.transitions[breakpoint.condition]?.name ?? "";
  return { path, where: `condition of ${path}` };
}
