import { useMemo } from "react";
import { useStore, useStudio } from "../hooks/use";
import type { Verdict } from "../model/protocol";
import { causesOf } from "../model/causes";
import { sentence } from "../model/net/labels";
import { readStructure } from "../model/structure/structure";
import { CauseCard } from "./cause_card";
import { Term } from "../canvas/term";
import { Icon } from "./icons";
import { TimingVerdicts } from "./timing/timing_verdicts";

/** The question of each property in words. */
const asks: Record<string, string> = {
  safe: "no place ever holds two tokens",
  exclusive_channels: "one side at a time uses a channel's memory",
  deadlock_free: "the system never stops by itself",
  goes_on: "every subsystem goes on for ever",
  channels_flow: "every channel keeps carrying values",
  sound_pages: "every page ends what it began",
  live_behaviours: "every behaviour can run, if only after a failure",
  survives_exceptions: "errors stop nobody else",
  survives_partition: "a cut network stops nobody",
};

export function VerifyPanel() {
  const studio = useStudio();
  const verifier = useStore(studio.verifier.store, (all) => all);
  const text = useStore(studio.draft.store, (draft) => draft.text);
  const current = useStore(studio.draft.store, (draft) => draft.current);
  const causes = useMemo(() => {
    const violated = verifier.verdicts.some(({ verdict }) => verdict === "violated");
    return violated ? causesOf(verifier.verdicts, readStructure(verifier.text).channels) : [];
  }, [verifier.verdicts, verifier.text]);
  const running = verifier.state === "running";
  const old = verifier.verdicts.length > 0 && verifier.text !== text;
  return (
    <div>
      <h2 className="visually-hidden">Verify</h2>
      <div className="buttons" style={{ marginTop: 0 }}>
        {running ? (
          <button onClick={() => studio.verifier.stop()}>Stop</button>
        ) : (
          <button className="primary" disabled={!current} onClick={() => void studio.verifier.start()}>
            Verify
          </button>
        )}
      </div>
      {running && (
        <div role="status">
          <div className="progress">
            <i />
          </div>
          <p className="faint">
            {verifier.property || "reading the net"}
            {verifier.states > 0 && ` · ${verifier.states.toLocaleString("en")} markings`}
            {verifier.rate > 0 && ` · ${Math.round(verifier.rate).toLocaleString("en")}/s`}
          </p>
        </div>
      )}
      {verifier.state === "stopped" && <p className="faint">Stopped before all was known.</p>}
      {verifier.problem && <p className="problem-hint">{verifier.problem}</p>}
      {old && <p className="problem-hint">The specification changed since; these verdicts are of the text before.</p>}
      {verifier.state === "idle" && (
        <p className="faint">
          Proves that nothing can go wrong in the net, or shows the run in which it does. The text is verified as it is here,
          saved or not.
        </p>
      )}
      {causes.map((cause) => (
        <CauseCard key={cause.title} cause={cause} net={verifier.net} />
      ))}
      <div className="verdicts">
        {verifier.verdicts.map((verdict) => (
          <VerdictRow key={verdict.name} verdict={verdict} />
        ))}
      </div>
      {verifier.verdicts.length > 0 && <TimingVerdicts />}
    </div>
  );
}

/** The methods that lead to a verdict. */
const methods: Readonly<Record<string, string>> = {
  circuits: "Circuits: no circle of subsystems in which each waits for the next one can come about.",
  "place invariants": "Place invariants: sums of tokens that no transition changes.",
  "explicit search": "Explicit search: all markings that can be reached were visited.",
};

const marks = { holds: "check", violated: "cross", unknown: "question" } as const;

function VerdictRow({ verdict }: { verdict: Verdict }) {
  const onlyWarns = verdict.verdict === "violated" && verdict.warning;
  return (
    <div className="verdict-row">
      <details className="verdict" open={verdict.verdict === "unknown"}>
        <summary>
          <span className={`mark ${onlyWarns ? "unknown" : verdict.verdict}`} role="img" aria-label={verdict.verdict}>
            <Icon name={marks[verdict.verdict]} />
          </span>
          <span className="name">{verdict.name.replaceAll("_", " ")}</span>
          <span className="method">{onlyWarns ? "violated · a warning" : verdict.verdict}</span>
        </summary>
        <p>{sentence(verdict.asks || asks[verdict.name] || "")}</p>
        {verdict.why && <p>{sentence(verdict.why)}</p>}
        <p title={methods[verdict.method] ?? "How the verdict was found."}>
          By {verdict.method || "nothing yet"} <Term of={verdict.method} />
          {verdict.states ? `, ${verdict.states.toLocaleString("en")} markings` : ""}.
        </p>
        {verdict.meaning && <p>{sentence(verdict.meaning)}</p>}
      </details>
      <Term of={verdict.name} />
    </div>
  );
}
