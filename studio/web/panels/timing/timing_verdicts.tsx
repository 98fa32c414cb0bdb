import { useStore, useStudio } from "../../hooks/use";
import { chainKey, chainName, isSilent, saidChain, worstFirst } from "../../model/timing";
import { VerdictMark } from "./chain_table";

/** Most chains among the verdicts; the panel Timing has all. */
const most = 6;

/** The chains of the text that was verified, among the verdicts. */
export function TimingVerdicts() {
  const studio = useStudio();
  const { verified, judging, unjudged } = useStore(studio.timing.store, (all) => all);
  if (judging || unjudged)
    return (
      <section className="timing-verdicts" aria-label="Times">
        <h3>Times</h3>
        <p className={unjudged ? "problem-hint" : "faint"} role="status">
          {unjudged ? `They are not known: ${unjudged}` : "Computing how old commands can be…"}
        </p>
      </section>
    );
  if (!verified || verified.chains.length === 0) return null;
  const open = (key: string | null) => {
    studio.timing.choose(key);
    studio.dock.open("timing");
  };
  const silent = isSilent(verified);
  const chains = silent ? [] : worstFirst(verified.chains).slice(0, most);
  return (
    <section className="timing-verdicts" aria-label="Times">
      <h3>Times</h3>
      {chains.map((chain) => (
        <button key={chainKey(chain)} className="choice" onClick={() => open(chainKey(chain))}>
          <VerdictMark chain={chain} />
          <span>
            {chainName(chain)}
            {chain.agents > 1 && <span className="faint"> · {chain.agents.toLocaleString("en")} agents</span>}
            <small>{saidChain(chain)}</small>
          </span>
        </button>
      ))}
      {silent && <p className="faint">Nothing bounds how old a command can be: {verified.chains[0]!.why}.</p>}
      {chains.length < verified.chains.length && (
        <button className="link" onClick={() => open(null)}>
          {silent ? "Open the panel Timing" : `All ${verified.chains.length} chains`}
        </button>
      )}
    </section>
  );
}
