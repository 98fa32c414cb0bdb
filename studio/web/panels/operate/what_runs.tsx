import { useEffect, useState } from "react";
import { useStore, useStudio } from "../../hooks/use";
import { goesOn } from "../../live/runner_state";
import type { RunListed } from "../../model/protocol";

const kindTitles: Record<RunListed["kind"], string> = {
  simulate: "simulation",
  run: "in real time",
  attach: "a controller that was started elsewhere",
  deployment: "all processes",
};

/** The runs and controllers that can be operated, while nothing is. A run that begins meanwhile is followed; nothing is operated by that. */
export function WhatRuns() {
  const studio = useStudio();
  const { state, panels, others, problem, kind } = useStore(studio.runner.store, (all) => all);
  const connected = useStore(studio.connection.store, (all) => all.state === "open");
  const active = goesOn(state);
  const controllers = useControllers(!active && connected);
  const next = others.length === 1 ? others[0]!.run : null;
  useEffect(() => {
    if (!active && next !== null) void studio.followRun(next);
  }, [studio, active, next]);
  const told = problem && (
    <p className="problem-hint" role="alert">
      {problem}
    </p>
  );
  if (active && (panels.length > 0 || state === "building")) return <>{told}</>;
  if (active)
    return (
      <div className="what-runs">
        {told}
        <p>
          {kind === "deployment"
            ? "A page operates no deployed system: use `tessera panel` in a terminal."
            : "This run has no panel: its drivers take no inputs of an operator."}
        </p>
      </div>
    );
  return (
    <div className="what-runs">
      {told}
      <p>Start a run in the studio, or a controller in a terminal. This page follows it as soon as it runs.</p>
      <ul>
        {others.map(({ run, kind: other }) => (
          <li key={run}>
            <button onClick={() => void studio.followRun(run)}>
              Run {run}, {kindTitles[other]}
            </button>
          </li>
        ))}
        {controllers.map((socket) => (
          <li key={socket}>
            <button onClick={() => void studio.run({ kind: "attach", socket })}>{socket.replace(/\.sock$/, "")}</button>
          </li>
        ))}
      </ul>
    </div>
  );
}

/** The controllers that listen on this computer, looked for every two seconds. */
function useControllers(wanted: boolean): readonly string[] {
  const studio = useStudio();
  const [found, setFound] = useState<readonly string[]>([]);
  useEffect(() => {
    if (!wanted) return setFound([]);
    let over = false;
    const look = () =>
      studio.api.controllers().then(
        (all) => !over && setFound(all),
        () => undefined, // the bar reports a server that is gone
      );
    void look();
    const timer = setInterval(() => void look(), 2000);
    return () => {
      over = true;
      clearInterval(timer);
    };
  }, [studio, wanted]);
  return found;
}
