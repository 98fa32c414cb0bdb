import { useEffect } from "react";
import { useStore, useStudio } from "../../hooks/use";
import type { RecordingInfo } from "../../model/protocol";

/** The recordings of runs, to be opened alone, beside the run, or two side by side. */
export function RecordingsPanel() {
  const studio = useStudio();
  const { list, open, problem } = useStore(studio.recordings.store, (all) => all);
  const { state, shown } = useStore(studio.runner.store, (all) => all);
  useEffect(() => void studio.recordings.refresh(), [studio, state]);
  const names = open.map((replay) => replay.name);
  const show = (name: string, keep: number) => void studio.replay(name, keep);
  return (
    <>
      {problem && <p className="problem-hint">{problem}</p>}
      {list.length === 0 && !problem && <p className="faint">Nothing was recorded yet: every run leaves a recording.</p>}
      {list.length > 0 && shown && <p className="faint">A recording is shown beside the run.</p>}
      <ul className="recordings">
        {list.map((one) => (
          <li key={one.name}>
            <button aria-pressed={names.includes(one.name)} onClick={() => show(one.name, 0)}>
              <span className="name">{one.name}</span>
              <span className="faint">{factsOf(one)}</span>
            </button>
            {!shown && names.length > 0 && names[0] !== one.name && (
              <button
                className="beside"
                aria-label={`Show ${one.name} beside ${names[0]}`}
                title="Side by side with what is shown"
                onClick={() => show(one.name, 1)}
              >
                Beside
              </button>
            )}
          </li>
        ))}
      </ul>
    </>
  );
}

function factsOf({ bytes, modified, duration }: RecordingInfo): string {
  const size = bytes < 1e6 ? `${Math.ceil(bytes / 1000)} kB` : `${(bytes / 1e6).toFixed(1)} MB`;
  const when = new Date(modified).toLocaleString("en-GB", { dateStyle: "medium", timeStyle: "short" });
  return [`${duration.toFixed(1)} s`, size, when].join(" · ");
}
