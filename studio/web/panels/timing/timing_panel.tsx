import { useEffect } from "react";
import { useStore, useStudio } from "../../hooks/use";
import { useStructure } from "../../hooks/use_structure";
import { chainKey, shownChain } from "../../model/timing";
import { ChainDetails } from "./chain_details";
import { ChainTable } from "./chain_table";

/** How old a command can be: all chains, the parts of one, and what other rates would give. */
export default function TimingPanel() {
  const studio = useStudio();
  const structure = useStructure();
  const { found, text: known, other, chosen, problem, busy } = useStore(studio.timing.store, (all) => all);
  const current = useStore(studio.draft.store, (draft) => draft.current);
  const text = useStore(studio.draft.store, (draft) => draft.text);
  const checking = useStore(studio.draft.store, (draft) => draft.checking);
  useEffect(() => {
    if (current) studio.timing.look();
  }, [studio, current, text]);
  const chain = shownChain(found, chosen);
  return (
    <div className="timing" aria-busy={busy}>
      <p className="faint">
        How old the reading is that a command acts on (age), and how long an event waits for the first command that reflects it
        (reaction). Both are computed for the worst case, before the robot runs.
      </p>
      {problem && <p className="problem-hint">{problem}</p>}
      {!current && !checking && found && (
        <p className="problem-hint">The specification has errors; these times are of the text before.</p>
      )}
      {!current && !checking && !found && <p className="faint">A specification with errors has no times.</p>}
      {current && !found && !problem && (
        <p className="faint" role="status">
          Computing…
        </p>
      )}
      {found && found.chains.length === 0 && (
        <p className="faint">
          There is no chain yet: it leads from a receptor over channels to an effector, in each agent through its control
          subsystem.
        </p>
      )}
      {found && found.chains.length > 0 && <ChainTable found={found} other={other} chosen={chain} />}
      {found && chain && (
        <ChainDetails key={chainKey(chain)} structure={structure} found={found} chain={chain} fresh={known === text} />
      )}
    </div>
  );
}
