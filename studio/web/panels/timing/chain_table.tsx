import { useStudio } from "../../hooks/use";
import type { TimedBound, TimedChain, Timing } from "../../model/protocol";
import { chainKey, chainName, shownBound, shownTime, verdictOf, type Verdict } from "../../model/timing";
import { Icon } from "../icons";
import { TableHead } from "../table_head";

const marks = { holds: "check", violated: "cross", unknown: "question", none: "question" } as const;
const spoken: Record<Verdict, string> = {
  holds: "holds",
  violated: "violated",
  unknown: "unknown",
  none: "nothing is asked",
};

/** The sign of a verdict; none: a bound of which nothing is asked. */
export function VerdictMark({ chain }: { chain: TimedChain }) {
  const verdict = verdictOf(chain);
  if (verdict === "none") return <span className="mark-place" role="img" aria-label={spoken.none} />;
  return (
    <span className={`mark ${verdict}`} role="img" aria-label={spoken[verdict]}>
      <Icon name={marks[verdict]} />
    </span>
  );
}

/** Most rows that are shown at once: a table of more is for a search. */
const mostRows = 200;

/** All chains with their bounds, and beside them those for the rates that are tried. */
export function ChainTable({ found, other, chosen }: { found: Timing; other: Timing | null; chosen: TimedChain | null }) {
  const studio = useStudio();
  const others = new Map(other?.chains.map((one) => [chainKey(one), one]));
  return (
    <div className="chain-table">
      <table>
        <caption className="visually-hidden">Chains from a receptor to an effector</caption>
        <TableHead columns={["Chain", "Age", "Reaction"]} />
        <tbody>
          {found.chains.slice(0, mostRows).map((chain) => {
            const key = chainKey(chain);
            const isChosen = chosen !== null && chainKey(chosen) === key;
            return (
              <tr key={key} className={isChosen ? "chosen" : ""}>
                <th scope="row">
                  <button className="chain-name" aria-pressed={isChosen} onClick={() => studio.timing.choose(key)}>
                    <VerdictMark chain={chain} />
                    <span>
                      {chainName(chain)}
                      {chain.agents > 1 && <span className="faint"> · {chain.agents.toLocaleString("en")} agents</span>}
                    </span>
                  </button>
                </th>
                {chain.why ? (
                  <td colSpan={2} className="why">
                    no bound
                  </td>
                ) : (
                  <>
                    <Bound bound={chain.age} other={others.get(key)?.age} />
                    <Bound bound={chain.reaction} other={others.get(key)?.reaction} />
                  </>
                )}
              </tr>
            );
          })}
        </tbody>
      </table>
      {found.chains.length > mostRows && <p className="faint">{found.chains.length - mostRows} more chains are not listed.</p>}
    </div>
  );
}

/** A bound, and the one for the rates that are tried. */
function Bound({ bound, other }: { bound: TimedBound; other: TimedBound | undefined }) {
  const { at_most_ns, asked_ns, answer } = bound;
  const differs = other !== undefined && other.at_most_ns !== at_most_ns;
  return (
    <td className={answer}>
      <span className={differs ? "old" : ""}>{shownBound(at_most_ns)}</span>
      {differs && <strong>{shownBound(other.at_most_ns)}</strong>}
      {asked_ns !== null && <span className="asked-limit">asked: {shownTime(asked_ns)}</span>}
    </td>
  );
}
