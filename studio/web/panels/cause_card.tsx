import { useStore, useStudio } from "../hooks/use";
import { stepsOf } from "../live/verifier";
import type { Repair } from "../live/repairs";
import { changedBlocks } from "../model/text/changed_lines";
import { listed, type Cause } from "../model/causes";
import { Story } from "./story";
import { WordLines } from "./text/word_lines";
import { sentence } from "../model/net/labels";
import type { NetModel } from "../model/net/net";

const words = (name: string) => name.replaceAll("_", " ");

/**
 * A cause of violations: the stuck subsystems, in words and in the drawings, the run that leads there, and
 * repairs.
 */
export function CauseCard({ cause, net }: { cause: Cause; net: NetModel | null }) {
  const studio = useStudio();
  const lens = useStore(studio.lens.store, (all) => all.shown);
  const verified = useStore(studio.verifier.store, (all) => all);
  const [first] = cause.verdicts;
  const shown = lens !== null && lens.atEnd === cause.atEnd;
  const withRun = cause.verdicts.map((verdict) => ({ verdict, steps: net && stepsOf(verdict, net) })).find(({ steps }) => steps);
  const showRun = () => {
    if (!net || !withRun?.steps) return;
    studio.play.trace(net, withRun.steps, withRun.verdict.name, withRun.verdict.waits);
    studio.lens.show(net, cause.atEnd, cause.title);
    studio.view.set({ view: "net", panel: "play" });
  };
  return (
    <section className={`cause${cause.warning ? " warning" : ""}`} aria-label={cause.title}>
      <h3>{sentence(cause.title)}</h3>
      <p className="faint">
        {cause.warning ? "A warning: breaks " : "Breaks "}
        {cause.verdicts.map(({ name }) => words(name)).join(", ")}
      </p>
      {cause.atEnd.length > 0 ? (
        <ul className="at-end">
          {cause.atEnd.map(({ text, path }) => (
            <li key={text}>
              <button className="choice" onClick={() => studio.select(path)}>
                {sentence(text)}
              </button>
            </li>
          ))}
        </ul>
      ) : (
        first!.why && cause.dead.length === 0 && <p>{sentence(first!.why)}</p>
      )}
      {cause.dead.length > 0 && cause.atEnd.length > 0 && <p className="faint">Behaviours that never run because of it:</p>}
      {cause.dead.length > 0 && (
        <ul className="at-end" aria-label="Behaviours that never run">
          {cause.dead.map(({ path, line, included }) => (
            <li key={path}>
              <button className="choice" onClick={() => studio.flyTo(path)}>
                {sentence(path)} <span className="faint">{included ?? `line ${line}`}</span>
              </button>
            </li>
          ))}
        </ul>
      )}
      {first!.hint && <p className="faint">{sentence(first!.hint)}</p>}
      {first!.cut_off && <p className="faint">Cut off: {first!.cut_off}.</p>}
      <div className="buttons">
        {cause.atEnd.length > 0 && (
          <button
            aria-pressed={shown}
            onClick={() => (shown ? studio.lens.close() : studio.lens.show(net, cause.atEnd, cause.title))}
          >
            {shown ? "Hide who is stuck" : "Show who is stuck"}
          </button>
        )}
        {withRun?.steps && <button onClick={showRun}>Show the run ({withRun.steps.length} firings)</button>}
      </div>
      {withRun?.verdict.narrative && (
        <details className="story">
          <summary>How it comes to that</summary>
          <Story acts={withRun.verdict.narrative} label="The run in words" />
          <button className="link" onClick={() => studio.dock.open("narrative")}>
            Open it in a panel
          </button>
        </details>
      )}
      <RepairsOf cause={cause} text={verified.text} />
    </section>
  );
}

function RepairsOf({ cause, text }: { cause: Cause; text: string }) {
  const studio = useStudio();
  const repairs = useStore(studio.repairs.store, (all) => all);
  const draft = useStore(studio.draft.store, (all) => all.text);
  const mine = repairs.state !== "idle" && repairs.cause === cause.title && repairs.text === text;
  if (!mine)
    return (
      <div className="buttons">
        <button
          disabled={draft !== text}
          onClick={() => void studio.repairs.find(cause, text, studio.verifier.store.get().verdicts)}
        >
          Find a repair
        </button>
      </div>
    );
  const apply = ({ text: changed }: Repair) => {
    studio.draft.edit(changed, "repair");
    studio.lens.close();
    studio.repairs.forget();
    void studio.verifier.start();
  };
  return (
    <div className="repairs" aria-label="Repairs">
      {repairs.state === "searching" && (
        <p className="faint" role="status">
          Verifying edits: {repairs.tried} so far, {repairs.found.length} of them mend it…
        </p>
      )}
      {repairs.state === "failed" && <p className="problem-hint">{repairs.problem}</p>}
      {repairs.state === "done" && repairs.found.length === 0 && (
        <p className="faint">
          None of {repairs.tried} small edits mends it: it needs another design of the channels or behaviours named above.
        </p>
      )}
      {repairs.found.map((repair) => (
        <div key={repair.text} className="repair">
          <strong>{sentence(repair.title)}</strong>
          <p>{sentence(repair.meaning)}</p>
          <pre tabIndex={0} aria-label="Changed lines">
            {changedBlocks(text, repair.text).map(({ old, fresh }, at) => (
              <WordLines
                key={at}
                old={{ sign: "- ", className: "theirs", lines: old.map((line) => line.trim()) }}
                fresh={{ sign: "+ ", className: "mine", lines: fresh.map((line) => line.trim()) }}
              />
            ))}
          </pre>
          <p className="faint">
            Verified: with it, {listed(repair.mends.map((one) => `“${words(one)}”`))} {repair.mends.length > 1 ? "hold" : "holds"}
            , and nothing else is lost.
          </p>
          <button disabled={draft !== text} onClick={() => apply(repair)}>
            Apply
          </button>
        </div>
      ))}
    </div>
  );
}
