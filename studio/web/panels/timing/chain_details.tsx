import { useEffect, useRef } from "react";
import { useStore, useStudio } from "../../hooks/use";
import type { Edit, TimedChain, TimedSubsystem, Timing } from "../../model/protocol";
import { findThing, sharersOf, withoutIndex, type Agent, type Structure, type Subsystem } from "../../model/structure/structure";
import { set } from "../../model/text/edits";
import { saidTried, takesEdits, type Tried } from "../../model/tried_times";
import { chainKey, chainName, chainTitle, saidChain, shownRate } from "../../model/timing";
import { Budget } from "./budget";
import { HelpfulChanges } from "./helpful_changes";
import { LimitFields } from "./limit_fields";
import { MeasuredTimes } from "./measured_times";
import { RateSlider } from "./rate_slider";
import { TakesFields } from "./takes_fields";
import { TakesSlider } from "./takes_slider";
import { WorstRunOf } from "./worst_run";

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
  const { tried, other, text } = useStore(studio.timing.store, (all) => all);
  const members = chain.path.flatMap((path): OnChain[] => {
    const timed = found.subsystems.find((one) => one.path === path);
    const thing = findThing(structure, withoutIndex(path));
    return timed && thing?.kind === "subsystem" ? [{ timed, subsystem: thing.of, agent: thing.agent }] : [];
  });
  // The parts are those of the chain that was asked for.
  const steps = found.steps && stepsAreOf(found.steps, chain) ? found.steps : null;
  const changed = members.filter(({ subsystem }) => tried.has(subsystem.path));
  const written = triedEdits(structure, members, tried);
  const then = other?.chains.find((one) => chainKey(one) === chainKey(chain));
  const write = async () => {
    if (!written || !(await studio.change(written))) return;
    for (const { subsystem } of changed) studio.timing.try(subsystem.path, { period_ns: undefined, longest_ns: undefined });
  };
  const [details, isTried] = [useRef<HTMLElement>(null), changed.length > 0];
  // The row of what is tried stands over the end of the panel: the slider that was moved must not be below it.
  // Parts above it come and grow when their times arrive.
  useEffect(() => {
    const section = details.current;
    if (!section || !isTried || !then) return;
    const keepInSight = () => {
      const active = document.activeElement;
      if (section.contains(active)) active?.scrollIntoView({ block: "nearest" });
    };
    keepInSight();
    const grown = new ResizeObserver(keepInSight);
    grown.observe(section);
    return () => grown.disconnect();
  }, [isTried, then]);
  const tries = nameOfTried([...tried.values()]);
  return (
    <section ref={details} aria-label={chainName(chain)}>
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
      {!chain.why && <WorstRunOf found={found} chain={chain} text={text} />}
      <h3>Rates and times</h3>
      {members.map(({ timed, subsystem, agent }) => (
        <div key={timed.path} className="on-chain">
          <RateSlider timed={timed} path={subsystem.path} tried={tried.get(subsystem.path)?.period_ns} />
          <TakesSlider timed={timed} path={subsystem.path} tried={tried.get(subsystem.path) ?? {}} />
          <TakesFields structure={structure} subsystem={subsystem} />
          <SharedBy structure={structure} agent={agent} />
        </div>
      ))}
      <div className={changed.length > 0 ? "tried" : ""}>
        <div role="status">
          {changed.length > 0 && then && (
            <p>
              With {changed.map(({ subsystem }) => saidTried(subsystem.path, tried.get(subsystem.path)!)).join("; ")}:{" "}
              {saidChain(then)}
            </p>
          )}
        </div>
        {changed.length > 0 && (
          <div className="buttons">
            <button className="primary" disabled={!fresh || !written} onClick={() => void write()}>
              Write the new {tries}
            </button>
            <button onClick={() => studio.timing.forget()}>Back to the present {tries}</button>
          </div>
        )}
      </div>
      {!written && (
        <p className="problem-hint">A behaviour says in another form what it takes: write its new time into the text by hand.</p>
      )}
    </section>
  );
}

/** The edits that write what is tried; undefined: the text has no place for it. */
function triedEdits(structure: Structure, members: readonly OnChain[], tried: ReadonlyMap<string, Tried>): Edit[] | undefined {
  const edits = members.map(({ subsystem }): Edit[] | undefined => {
    const { period_ns, longest_ns } = tried.get(subsystem.path) ?? {};
    const takes = longest_ns === undefined ? [] : takesEdits(structure, subsystem, longest_ns);
    const rate = period_ns === undefined ? [] : [set(subsystem.yaml, "rate", period_ns === 0 ? "" : shownRate(period_ns))];
    return takes && [...rate, ...takes];
  });
  return edits.includes(undefined) ? undefined : edits.flatMap((one) => one!);
}

/** "rate", "rates", "times" or "rates and times" */
function nameOfTried(tried: readonly Tried[]): string {
  const rates = tried.filter(({ period_ns }) => period_ns !== undefined).length;
  const times = tried.filter(({ longest_ns }) => longest_ns !== undefined).length;
  const many = (count: number, name: string) => (count === 0 ? [] : count === 1 ? [name] : [`${name}s`]);
  return [...many(rates, "rate"), ...many(times, "time")].join(" and ");
}

const stepsAreOf = ({ age }: NonNullable<Timing["steps"]>, { path }: TimedChain) =>
  age.every(({ subsystem }) => path.includes(subsystem));

function SharedBy({ structure, agent }: { structure: Structure; agent: Agent }) {
  const sharers = sharersOf(structure, agent);
  if (sharers.length < 2) return null;
  return <p className="faint">The same for {sharers.map(({ name }) => name).join(", ")}: they share their subsystems.</p>;
}
