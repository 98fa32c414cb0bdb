import { useRunning } from "../../hooks/use_stage";
import { useStore, useStudio } from "../../hooks/use";
import { titleOf } from "../../live/run/breakpoints";
import { goesOn } from "../../live/run/runner_state";
import { sentence } from "../../model/net/labels";
import { Again } from "./again";
import { IconButton } from "../icons";
import { PathText } from "../../canvas/path_text";
import { OtherRuns } from "./other_runs";
import { OperatorPanels } from "./operator_panel";
import { OutcomeOf } from "./outcome";
import { reason, stateTitles } from "../pane_title";
import { ParametersNow } from "./parameters_now";
import { StartForm } from "./start_form";

export function RunPanel() {
  const studio = useStudio();
  const runner = useStore(studio.runner.store, (all) => all);
  const net = useStore(studio.draft.store, (draft) => draft.net);
  const active = goesOn(runner.state);
  const drawn = studio.runner.track !== null || (net?.isNamed(runner.netHash) ?? false);
  return (
    <div className="run-panel">
      <h2 className="visually-hidden">Run</h2>
      {runner.state !== "idle" && (
        <p className={`run-state ${runner.state}`} role="status" data-testid="run-state">
          <span className={`dot ${runner.state === "failed" ? "error" : active ? "good" : ""}`} /> {stateTitles[runner.state]}
          {runner.why && ` — ${reason(runner.why)}`}
        </p>
      )}
      {runner.problem && <p className="problem-hint">{runner.problem}</p>}
      {active && !drawn && <p className="faint">It runs another net than that of the text, so it is not drawn.</p>}
      {active && drawn && !runner.shown && (
        <div className="buttons">
          <button onClick={() => studio.showRun()}>Show it in the drawing</button>
        </div>
      )}
      {!active && <StartForm />}
      <OtherRuns />
      <Again />
      {["running", "paused", "ended", "failed"].includes(runner.state) && runner.shown && <WhoWaits />}
      {(runner.state === "running" || runner.state === "paused") && <OperatorPanels />}
      {(runner.state === "running" || runner.state === "paused") && studio.runner.track !== null && <RunningNow />}
      {(runner.state === "running" || runner.state === "paused") && <ParametersNow />}
      {runner.outcome && <OutcomeOf outcome={runner.outcome} />}
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

/** The subsystems that cannot go on now, and those that they wait for. */
function WhoWaits() {
  const studio = useStudio();
  const { shown, problem } = useStore(studio.lens.store, (all) => all);
  const look = async () => {
    const { track, stage } = studio.runner;
    if (track) await studio.lens.look(track.net, stage.marking);
  };
  return (
    <>
      <div className="buttons">
        <button onClick={() => (shown ? studio.lens.close() : void look())}>{shown ? "Hide who waits" : "Who waits now?"}</button>
      </div>
      {problem && <p className="faint">{problem}</p>}
      {shown && (
        <ul className="at-end">
          {shown.atEnd.map(({ text }) => (
            <li key={text}>{sentence(text)}</li>
          ))}
        </ul>
      )}
    </>
  );
}

/** The behaviours that run now, by subsystem. */
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
              <span className="path">
                <PathText of={path} />
              </span>
              <span className="chip running">
                <PathText of={behaviour} />
              </span>
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
  if (breakpoints.length === 0) return null;
  return (
    <>
      <h3>Breakpoints</h3>
      <ul className="choice-list">
        {breakpoints.map((breakpoint) => {
          const where = titleOf(breakpoint);
          return (
            <li key={where}>
              <button className="choice" onClick={() => studio.flyTo(breakpoint.path)}>
                {where}
              </button>
              <IconButton
                name="remove"
                label={`Remove the breakpoint at ${where}`}
                onClick={() => studio.runner.toggleBreakpoint(breakpoint)}
              />
            </li>
          );
        })}
      </ul>
    </>
  );
}
