import { useEffect } from "react";
import { useStore, useStudio } from "../app/use";
import type { RecordingInfo } from "../live/protocol";

/** What runs left behind, to be looked at again. */
export function RecordingsPanel() {
  const studio = useStudio();
  const { list, open, problem } = useStore(studio.recordings.store, (all) => all);
  const state = useStore(studio.runner.store, (all) => all.state);
  useEffect(() => void studio.recordings.refresh(), [studio, state]);
  return (
    <>
      {problem && <p className="problem-hint">{problem}</p>}
      {list.length === 0 && !problem && <p className="faint">Nothing was recorded yet: every run leaves a recording.</p>}
      <ul className="recordings">
        {list.map((one) => (
          <li key={one.name}>
            <button aria-pressed={open === one.name} onClick={() => void studio.recordings.open(one.name)}>
              <span className="name">{one.name}</span>
              <span className="faint">{factsOf(one)}</span>
            </button>
          </li>
        ))}
      </ul>
    </>
  );
}

function factsOf({ bytes, modified, duration }: RecordingInfo): string {
  const size = bytes < 1e6 ? `${Math.ceil(bytes / 1000)} kB` : `${(bytes / 1e6).toFixed(1)} MB`;
  const date = new Date(typeof modified === "number" && modified < 1e11 ? modified * 1000 : modified);
  const when = Number.isNaN(date.getTime()) ? "" : date.toLocaleString("en-GB", { dateStyle: "medium", timeStyle: "short" });
  const seconds =
    duration === undefined || duration === null ? "" : `${(duration > 1e7 ? duration / 1e9 : duration).toFixed(1)} s`;
  return [seconds, size, when].filter(Boolean).join(" · ");
}
