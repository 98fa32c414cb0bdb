import { useStore, useStudio } from "../../hooks/use";
import { longestOf, measuredOf, saidMeasured } from "../../model/measured_chains";
import type { TimedChain } from "../../model/protocol";

/** The longest time that the run has measured so far, beside the bound, with its share of the bound as a bar. */
export function MeasuredTime({ chain, what }: { chain: TimedChain; what: "age" | "reaction" }) {
  const studio = useStudio();
  const measured = useStore(studio.runner.store, ({ measured }) => measured);
  const longest = longestOf(measuredOf(chain, measured), what);
  if (!longest) return null;
  const share = longest.proved_ns === null ? 0 : Math.min(1, longest.longest_ns / longest.proved_ns);
  return (
    <span className={`measured-time ${longest.exceeds ? "exceeds" : ""}`} title="The longest one of the run so far">
      {saidMeasured(longest, chain[what].at_most_ns)}
      {longest.proved_ns !== null && (
        <span className="measured-share" aria-hidden="true">
          <span style={{ width: `${share * 100}%` }} />
        </span>
      )}
    </span>
  );
}
