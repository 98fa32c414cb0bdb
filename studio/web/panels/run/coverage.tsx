import { useStore, useStudio } from "../../hooks/use";
import type { Pane } from "../../live/scene";
import type { Coverage } from "../../model/protocol";

/** Switches the shade of unreached elements on the drawing, and explains it. */
export function CoverageLegend({ pane }: { pane: Pane }) {
  const { coverage } = useStudio();
  const { on, known } = useStore(coverage.store, (all) => all);
  const found = known.get(pane.id);
  return (
    <div className="coverage" role="group" aria-label="Coverage">
      <button className="small" aria-pressed={on} onClick={() => coverage.toggle()}>
        Never reached
      </button>
      {on && (found ? "problem" in found ? <p className="faint">{found.problem}</p> : <Counts of={found} /> : <p>…</p>)}
    </div>
  );
}

function Counts({ of }: { of: Coverage }) {
  const kinds = [
    ["behaviours", of.behaviours],
    ["places", of.places],
    ["transitions", of.transitions],
    ["outcomes of conditions", of.conditions],
  ] as const;
  return (
    <>
      <dl>
        {kinds.map(([name, { reached, all }]) => (
          <div key={name}>
            <dt>{name}</dt>
            <dd>
              {(all - reached).toLocaleString("en")} of {all.toLocaleString("en")}
            </dd>
          </div>
        ))}
      </dl>
      <p>
        <i className="swatch unreached" /> never reached <i className="swatch one-sided" /> fired, but its condition was never
        false
      </p>
      {of.lacks_events && <p className="faint">Events are missing: some of it may have been reached.</p>}
    </>
  );
}
