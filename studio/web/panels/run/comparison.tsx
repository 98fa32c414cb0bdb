import { useState } from "react";
import { useStore, useStudio } from "../../hooks/use";
import type { Replay } from "../../live/run/replay";
import { firstDifference, type FirstDifference } from "../../model/run/first_difference";
import { shown } from "../../model/run/series";
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
      <FirstValue />
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

/** Runs in real time never do the same at quite the same moment: so many nanoseconds are no difference. */
const tolerance = 20e6;

/** The first value that both runs do not share, on request: all values of both are compared. */
function FirstValue() {
  const studio = useStudio();
  const { panes } = useStore(studio.scene.store, (all) => all);
  const list = useStore(studio.recordings.store, (all) => all.list);
  const [found, setFound] = useState<{ of: string; first: FirstDifference | null; part: string } | null>(null);
  const [left, right] = panes;
  if (!left?.track || !right?.track) return null;
  const pair = `${left.track.id} ${right.track.id}`;
  const isSimulated = ({ replay }: { replay: Replay | null }) =>
    replay !== null && list.find(({ name }) => name === replay.name)?.clock === "simulated";
  const compare = () => {
    const exact = isSimulated(left) && isSimulated(right);
    const first = firstDifference(left.track!, right.track!, exact ? 0 : tolerance);
    const isPart = panes.some(({ replay }) => replay && !(replay.isHere(replay.first) && replay.isHere(replay.last)));
    setFound({ of: pair, first, part: isPart || left.track!.dropped > 0 ? " (in the parts that are loaded)" : "" });
  };
  const go = ({ path, time }: FirstDifference) => {
    for (const { replay } of panes) replay?.seek(time);
    studio.plots.add({ kind: "value", path });
    studio.dock.open("plots");
  };
  if (found?.of !== pair)
    return (
      <button className="quiet" title="Compares all recorded values of both, and names the first that differs" onClick={compare}>
        First value that differs
      </button>
    );
  const { first, part } = found;
  if (!first) return <span className="faint first-value">all values are the same{part}</span>;
  return (
    <span className="first-value" role="status">
      <span className="path">{first.path}</span> differs first at {clock(first.time)} s: {told(first.values[0])} /{" "}
      {told(first.values[1])}
      {first.iteration !== null && ` in iteration ${first.iteration} of ${first.subsystem}`}
      {part}{" "}
      <button className="quiet" title="Shows this moment, and the value in the plot" onClick={() => go(first)}>
        Go there
      </button>
    </span>
  );
}

const told = (value: unknown) => (value === undefined ? "no value" : shown(value));
