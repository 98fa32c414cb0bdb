import { useStore, useStudio } from "../../hooks/use";
import type { TimedBound, TimedChain, TimedChange, Timing } from "../../model/protocol";
import type { Structure } from "../../model/structure/structure";
import { shownBound } from "../../model/timing";
import { editsOf, saidChange } from "../../model/timing_edits";

interface ChangesProps {
  structure: Structure;
  found: Timing;
  chain: TimedChain;
  /** The bounds are those of the text that is shown. */
  fresh: boolean;
}

/** Changes beyond these help less. */
const most = 4;

/** The single changes that make the times of a chain smaller, each computed, and the edits that make them. */
export function HelpfulChanges({ structure, found, chain, fresh }: ChangesProps) {
  const studio = useStudio();
  const { changes, seeking } = useStore(studio.timing.store, (all) => all);
  const text = useStore(studio.draft.store, (draft) => draft.text);
  const mine = changes && changes.chain === chain.name && changes.text === text ? changes.found : null;
  if (!mine)
    return (
      <div className="buttons">
        <button disabled={seeking || !fresh} onClick={() => void studio.timing.seek(chain.name)}>
          {seeking ? "Computing…" : "Find what helps most"}
        </button>
      </div>
    );
  return (
    <>
      <h3>What helps most</h3>
      {mine.length === 0 && <p className="faint">No single change of a rate, a mode or a processor helps.</p>}
      <ol className="helpful" aria-label="Changes that help">
        {mine.slice(0, most).map((change, at) => (
          <li key={at}>
            <p>
              <strong>{saidChange(change)}</strong>
            </p>
            <p className="faint">
              Reaction <Change from={chain.reaction} to={change.reaction_ns} />, age{" "}
              <Change from={chain.age} to={change.age_ns} />
            </p>
            <Apply change={change} structure={structure} found={found} />
          </li>
        ))}
      </ol>
      {mine.length > 0 && (
        <p className="faint">Other chains can get slower, and a subsystem that waits can stop others: verify again.</p>
      )}
    </>
  );
}

const Change = ({ from, to }: { from: TimedBound; to: number | null }) => (
  <span>
    {shownBound(from.at_most_ns)} → {shownBound(to)}
  </span>
);

function Apply({ change, structure, found }: { change: TimedChange; structure: Structure; found: Timing }) {
  const studio = useStudio();
  const edits = editsOf(change, structure, found);
  if (!edits) return <p className="faint">Write it into the text by hand.</p>;
  return (
    <div className="buttons">
      <button aria-label={`Apply: ${saidChange(change)}`} onClick={() => void studio.change(edits)}>
        Apply
      </button>
    </div>
  );
}
