import { useEffect, useState } from "react";
import { useStore, useStudio } from "../../hooks/use";
import type { TimedChain, Timing, WorstRun } from "../../model/protocol";
import { shownTime } from "../../model/timing";
import type { Shown } from "../../model/timed_run";
import { whatIf } from "../../model/tried_times";
import { RunDrawing } from "./run_drawing";

/** The slowest run of a chain that the server finds, drawn over time. */
export function WorstRunOf({ found, chain, text }: { found: Timing; chain: TimedChain; text: string }) {
  const [isOpen, open] = useState(false);
  return (
    <>
      <h3>The slowest run</h3>
      <div className="buttons">
        <button aria-expanded={isOpen} onClick={() => open(!isOpen)}>
          {isOpen ? "Hide the slowest run" : "Show the slowest run"}
        </button>
      </div>
      {isOpen && <Run {...{ found, chain, text }} />}
    </>
  );
}

function Run({ found, chain, text }: { found: Timing; chain: TimedChain; text: string }) {
  const studio = useStudio();
  const [of, choose] = useState<Shown>("reaction");
  const tried = useStore(studio.timing.store, (all) => all.tried);
  const { run, why, busy } = useStore(studio.worst.store, (all) => all);
  useEffect(() => {
    void studio.worst.look({ text, chain: chain.name, of, what_if: whatIf(tried, found.subsystems) });
  }, [studio, text, chain.name, of, tried, found.subsystems]);
  return (
    <section className="worst-run" aria-label="The slowest run" aria-busy={busy}>
      <div className="segmented" role="group" aria-label="Time of the run">
        {(["reaction", "age"] as const).map((one) => (
          <button key={one} aria-pressed={of === one} onClick={() => choose(one)}>
            {one === "age" ? "Age" : "Reaction"}
          </button>
        ))}
      </div>
      <div role="status">
        {busy && <p className="faint">Searching for the slowest run…</p>}
        {!busy && why && <p className="faint">There is no such run: {why}.</p>}
        {!busy && run && (
          <p>
            {tried.size > 0 && "These are the times that are tried. "}
            {saidRun(run, of)}
          </p>
        )}
      </div>
      {!busy && run && <RunDrawing run={run} path={chain.path} shown={of} />}
    </section>
  );
}

/** Whether the run takes as long as is proved. */
function saidRun(run: WorstRun, of: Shown): string {
  const took = shownTime(run.to_ns - run.from_ns);
  if (run.reaches) return `This run takes as long as any can: ${of === "age" ? "an age" : "a reaction"} of ${took}.`;
  return `The longest run found takes ${took}; at most ${shownTime(run.at_most_ns)} is proved.`;
}
