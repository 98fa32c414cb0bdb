import { useStore, useStudio } from "../../hooks/use";
import { longestOf, chainOfRun, saidMeasured } from "../../model/ages_of_run";
import type { TimedChain } from "../../model/protocol";

/** The longest time that the run has measured so far, beside the bound, with its share of the bound as a bar. */
export function TimeOfRun({ chain, what }: { chain: TimedChain; what: "age" | "reaction" }) {
  const studio = useStudio();
  const measured = useStore(studio.runner.store, ({ measured }) => measured);
  const longest = longestOf(chainOfRun(chain, measured), what);
  if (!longest) return null;
  const share = longest.proved_ns === null ? 0 : Math.min(1, longest.longest_ns / longest.proved_ns);
  return (
    <span className={`time-of-run ${longest.exceeds ? "exceeds" : ""}`} title="The longest one of the run so far">
      {saidMeasured(longest, chain[what].at_most_ns)}
      {longest.proved_ns !== null && (
        <span className="share-of-bound" aria-hidden="true">
          <span style={{ width: `${share * 100}%` }} />
        </span>
      )}
    </span>
  );
}
