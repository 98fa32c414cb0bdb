import { useStore, useStudio } from "../../hooks/use";
import type { TimedChain, TimedSubsystem, Timing } from "../../model/protocol";
import { findThing, sharersOf, withoutIndex, type Agent, type Structure, type Subsystem } from "../../model/structure/structure";
import { set } from "../../model/text/edits";
import { chainKey, chainName, chainTitle, saidChain, shownRate } from "../../model/timing";
import { Budget } from "./budget";
import { HelpfulChanges } from "./helpful_changes";
import { LimitFields } from "./limit_fields";
import { MeasuredTimes } from "./measured_times";
import { RateSlider } from "./rate_slider";
import { TakesFields } from "./takes_fields";

/** A subsystem of a chain, in the answer of the server and in the text. */
export interface OnChain {
  timed: TimedSubsystem;
  subsystem: Subsystem;
  agent: Agent;
}

interface DetailsProps {
  structure: Structure;
  found: Timing;
  chain: TimedChain;
  /** The bounds are those of the text that is shown. */
  fresh: boolean;
}

/** One chain: its bounds in words, and the rates and times of its subsystems. */
export function ChainDetails({ structure, found, chain, fresh }: DetailsProps) {
  const studio = useStudio();
  const { tried, other } = useStore(studio.timing.store, (all) => all);
  const members = chain.path.flatMap((path): OnChain[] => {
    const timed = found.subsystems.find((one) => one.path === path);
    const thing = findThing(structure, withoutIndex(path));
    return timed && thing?.kind === "subsystem" ? [{ timed, subsystem: thing.of, agent: thing.agent }] : [];
  });
  // The parts are those of the chain that was asked for.
  const steps = found.steps && stepsAreOf(found.steps, chain) ? found.steps : null;
  const changed = members.filter(({ subsystem }) => tried.has(subsystem.path));
  const then = other?.chains.find((one) => chainKey(one) === chainKey(chain));
  const write = async () => {
    const edits = changed.map(({ subsystem }) => {
      const period = tried.get(subsystem.path)!;
      return set(subsystem.yaml, "rate", period === 0 ? "" : shownRate(period));
    });
    if (await studio.change(edits)) for (const { subsystem } of changed) studio.timing.try(subsystem.path, undefined);
  };
  return (
    <section aria-label={chainName(chain)}>
      <h2>{chainName(chain)}</h2>
      {chain.named && <p className="path">{chainTitle(chain.path)}</p>}
      <p>{saidChain(chain)}</p>
      {chain.exact && <p className="faint">Some run takes so long: no bound can be smaller.</p>}
      <LimitFields structure={structure} found={found} chain={chain} />
      {steps && (
        <>
          <h3>Where the time goes</h3>
          <Budget steps={steps} other={tried.size > 0 ? (other?.steps ?? null) : null} />
        </>
      )}
      {!chain.why && <HelpfulChanges structure={structure} found={found} chain={chain} fresh={fresh} />}
      <MeasuredTimes found={found} chain={chain} />
      <h3>Rates</h3>
      {members.map(({ timed, subsystem, agent }) => (
        <div key={timed.path} className="on-chain">
          <RateSlider timed={timed} path={subsystem.path} tried={tried.get(subsystem.path)} />
          <TakesFields structure={structure} subsystem={subsystem} />
          <SharedBy structure={structure} agent={agent} />
        </div>
      ))}
      <div className="tried" role="status">
        {changed.length > 0 && then && (
          <p>
            With {changed.map(({ subsystem }) => `${subsystem.path} at ${shownRate(tried.get(subsystem.path)!)}`).join(", ")}:{" "}
            {saidChain(then)}
          </p>
        )}
      </div>
      {changed.length > 0 && (
        <div className="buttons">
          <button className="primary" disabled={!fresh} onClick={() => void write()}>
            Write the new rate{changed.length > 1 && "s"}
          </button>
          <button onClick={() => studio.timing.forget()}>Back to the present rate{changed.length > 1 && "s"}</button>
        </div>
      )}
    </section>
  );
}

const stepsAreOf = ({ age }: NonNullable<Timing["steps"]>, { path }: TimedChain) =>
  age.every(({ subsystem }) => path.includes(subsystem));

function SharedBy({ structure, agent }: { structure: Structure; agent: Agent }) {
  const sharers = sharersOf(structure, agent);
  if (sharers.length < 2) return null;
  return <p className="faint">The same for {sharers.map(({ name }) => name).join(", ")}: they share their subsystems.</p>;
}
