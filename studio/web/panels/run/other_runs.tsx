import { useStore, useStudio } from "../../hooks/use";
import type { RunKind } from "../../model/protocol";
import { stateTitles } from "../pane_title";

const kindTitles: Record<RunKind, string> = {
  simulate: "simulated",
  run: "on the steady clock",
  attach: "started elsewhere",
  deployment: "all processes",
};

/** The runs of the server that this page does not follow: another page has started them, or their net was another. */
export function OtherRuns() {
  const studio = useStudio();
  const others = useStore(studio.runner.store, (all) => all.others);
  if (others.length === 0) return null;
  return (
    <section aria-label="Other active runs">
      <h3>Other active runs</h3>
      <ul className="choice-list">
        {others.map(({ run, kind, state }) => (
          <li key={run}>
            <span>
              Run {run}, {kindTitles[kind]}: {stateTitles[state].toLowerCase()}
            </span>
            <div className="buttons">
              <button aria-label={`Follow run ${run}`} onClick={() => void studio.followRun(run)}>
                Follow
              </button>
              <button
                aria-label={`${kind === "attach" || kind === "deployment" ? "Stop watching" : "Stop"} run ${run}`}
                onClick={() => void studio.runner.stopOther(run)}
              >
                {kind === "attach" || kind === "deployment" ? "Stop watching" : "Stop"}
              </button>
            </div>
          </li>
        ))}
      </ul>
    </section>
  );
}
