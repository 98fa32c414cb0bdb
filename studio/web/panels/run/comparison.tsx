import { useStore, useStudio } from "../../hooks/use";
import type { Difference } from "../../model/run/timeline";
import { clock } from "../plots/clock";

const missing = {
  left: "the left one has not come so far",
  right: "the right one has ended by then",
  part: "the left one is shown at another time; with the same time both are compared",
  sampled: "this run was too fast to be compared; its recording can be",
};

/** If there are more differences than this, only their number is shown. */
const most = 6;

/** The bar between two panes: whether they show the same time, and the subsystems that differ. */
export function ComparisonBar() {
  const studio = useStudio();
  const { sameTime, comparison } = useStore(studio.scene.store, (all) => all);
  return (
    <div className="comparison" role="group" aria-label="Comparison">
      <label className="switch" title="The right one shows the moment that the left one shows">
        <input type="checkbox" role="switch" checked={sameTime} onChange={(event) => studio.scene.lock(event.target.checked)} />{" "}
        Same time
      </label>
      {comparison && (
        <span className="faint moment" data-testid="compared-at">
          At {clock(comparison.time)} s
        </span>
      )}
      {comparison?.missing && <span className="faint">{missing[comparison.missing]}</span>}
      {comparison && !comparison.missing && <Differences all={comparison.differences} />}
    </div>
  );
}

function Differences({ all }: { all: readonly Difference[] }) {
  const studio = useStudio();
  if (all.length === 0) return <span className="faint">all subsystems do the same</span>;
  return (
    <ul className="differences" aria-label="Subsystems that differ">
      {all.slice(0, most).map(({ path, behaviours: [left, right] }) => (
        <li key={path}>
          <button className="quiet" title="Left, and right" onClick={() => studio.flyTo(path)}>
            <span className="path">{path}</span> {left || "nothing"} <span className="faint">≠</span> {right || "nothing"}
          </button>
        </li>
      ))}
      {all.length > most && <li className="faint">and {all.length - most} more</li>}
    </ul>
  );
}
