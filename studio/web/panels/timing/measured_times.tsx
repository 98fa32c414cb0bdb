import { useEffect, useState } from "react";
import { useStore, useStudio } from "../../hooks/use";
import { goesOn } from "../../live/run/runner_state";
import type { MeasuredChain, TimedChain, Timing } from "../../model/protocol";
import { measuredOf, saidTimes, worstOf } from "../../model/measured_times";
import { chainKey, shownTime } from "../../model/timing";
import type { Shown, TimedRun } from "../../model/timed_run";
import { recordingOf } from "../events/recording_of";
import { AgeHistogram } from "./age_histogram";
import { RunDrawing } from "./run_drawing";

/** The recording that is open, or that of the run that has ended; null: there is none. */
function useRecording(): string | null {
  const studio = useStudio();
  const open = useStore(studio.recordings.store, (all) => all.open[0]?.name ?? null);
  const { outcome, state } = useStore(studio.runner.store, (all) => all);
  return open ?? (outcome && !goesOn(state) ? recordingOf(outcome.recording) : null);
}

/** The name that the user has given to a recording. */
function useTitle(name: string | null): string {
  const list = useStore(useStudio().recordings.store, (all) => all.list);
  return list.find((one) => one.name === name)?.notes?.title || (name ?? "");
}

/** The times of a chain in the recording that is open, beside its bounds. */
export function MeasuredTimes({ found, chain }: { found: Timing; chain: TimedChain }) {
  const studio = useStudio();
  const recording = useRecording();
  const title = useTitle(recording);
  const { chains, busy, problem, recording: asked } = useStore(studio.measured.store, (all) => all);
  const keys = found.chains.map(chainKey).join("\n");
  useEffect(() => void studio.measured.look(recording, keys), [studio, recording, keys]);
  if (recording === null || asked !== recording) return null;
  const measured = chains && measuredOf(chains, chain);
  return (
    <>
      <h3>Measured</h3>
      <p className="faint">In the recording {title}.</p>
      {busy && (
        <p className="faint" role="status">
          Measuring…
        </p>
      )}
      {problem && <p className="problem-hint">{problem}</p>}
      {chains && !measured && <p className="faint">The recording has no such chain.</p>}
      {measured && <OfChain key={chainKey(chain)} measured={measured} chain={chain} recording={recording} />}
    </>
  );
}

interface OfChainProps {
  measured: MeasuredChain;
  chain: TimedChain;
  recording: string;
}

function OfChain({ measured, chain, recording }: OfChainProps) {
  const [worst, open] = useState<Shown | null>(null);
  if (measured.age.count === 0)
    return <p className="faint">Nothing could be measured: {measured.not_measured ?? "no command reflects a reading"}.</p>;
  const above = (["age", "reaction"] as const).some((one) => {
    const [most, bound] = [measured[one].most_ns, chain[one].at_most_ns];
    return most !== undefined && bound !== null && most > bound;
  });
  return (
    <>
      {(["reaction", "age"] as const).map((of) => (
        <OfTime
          key={of}
          of={of}
          {...{ measured, chain, recording }}
          isOpen={worst === of}
          onOpen={(shown) => open(shown ? of : null)}
        />
      ))}
      {above && (
        <p className="problem-hint">
          A time is above its bound: a call took longer than its `takes`, a thread had to wait for a processor, something failed,
          or the recording is of another version of the specification.
        </p>
      )}
      {measured.withheld > 0 && (
        <p className="faint">
          {measured.withheld.toLocaleString("en")} calls of the last subsystem gave no command: they had failed, or the safe
          command held.
        </p>
      )}
    </>
  );
}

function OfTime(props: OfChainProps & { of: Shown; isOpen: boolean; onOpen: (shown: boolean) => void }) {
  const { measured, chain, of, recording, isOpen, onOpen } = props;
  const studio = useStudio();
  const times = measured[of];
  const bound = chain[of].at_most_ns;
  const run = worstOf(times);
  const show = async () => {
    if (!run) return;
    onOpen(true);
    const path = run.hops.length > 0 ? [run.hops[0]!.from, ...run.hops.map(({ to }) => to)] : measured.path;
    studio.measured.mark({ recording, run, path, shown: of });
    // The shortest time that the timeline offers: the run is as wide as it can be.
    studio.watched.set({ seconds: run.to_ns - run.from_ns < 1e9 ? 1 : 3 });
    await studio.goTo({ recording, time: run.from_ns });
  };
  const close = () => {
    onOpen(false);
    studio.measured.mark(null);
  };
  const name = of === "age" ? "Age" : "Reaction";
  return (
    <div className="measured">
      <h4>{name}</h4>
      <AgeHistogram times={times} bound={bound} name={name} />
      <p className="faint">{saidTimes(times, bound)}.</p>
      {run && (
        <div className="buttons">
          <button aria-expanded={isOpen} onClick={() => void (isOpen ? close() : show())}>
            {isOpen ? "Hide" : "Show"} the longest {of}: {shownTime(run.to_ns - run.from_ns)}
          </button>
        </div>
      )}
      {run && isOpen && <WorstCase {...{ of, run, measured, recording }} />}
    </div>
  );
}

/** The worst case of a recording: the run, and its moment in the recording. */
function WorstCase({ of, run, measured, recording }: { of: Shown; run: TimedRun; measured: MeasuredChain; recording: string }) {
  const studio = useStudio();
  const replay = useStore(studio.recordings.store, (all) => all.open.find(({ name }) => name === recording) ?? null);
  return (
    <section className="worst-run" aria-label={`The longest ${of} in the recording`}>
      <h4>
        The longest {of}, from {(run.from_ns / 1e9).toFixed(3)} s to {(run.to_ns / 1e9).toFixed(3)} s
      </h4>
      {measured.chains > 1 && <p className="faint">{measured[of].worst?.chain}</p>}
      {replay ? <FollowedRun {...{ run, measured, of, replay }} /> : <RunDrawing run={run} path={measured.path} shown={of} />}
      <div className="buttons">
        <button disabled={!replay} onClick={() => replay?.seek(run.from_ns)}>
          To its beginning
        </button>
        <button disabled={!replay} onClick={() => replay?.seek(run.to_ns)}>
          To its end
        </button>
      </div>
    </section>
  );
}

type Replay = ReturnType<ReturnType<typeof useStudio>["recordings"]["store"]["get"]>["open"][number];

function FollowedRun({ run, measured, of, replay }: { run: TimedRun; measured: MeasuredChain; of: Shown; replay: Replay }) {
  const now = useStore(replay.store, ({ time }) => time);
  return <RunDrawing run={run} path={measured.path} shown={of} now={now} onSeek={(time) => replay.seek(time)} />;
}
