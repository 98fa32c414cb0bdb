import { useEffect, useState } from "react";
import { useStore, useStudio } from "../../hooks/use";
import type { RecordingInfo } from "../../model/protocol";
import { recordingsWith } from "../../model/run/recording_search";
import { RecordingNotes } from "./recording_notes";
import { SweepPanel } from "./sweep_panel";

/** From so many recordings on, they can be searched. */
const many = 2;

/** The recordings of runs, to be opened alone, beside the run, or two side by side; and many runs at once. */
export function RecordingsPanel() {
  const studio = useStudio();
  const { list, open, problem } = useStore(studio.recordings.store, (all) => all);
  const { state, shown } = useStore(studio.runner.store, (all) => all);
  const [words, setWords] = useState("");
  const [noted, setNoted] = useState<string | null>(null);
  useEffect(() => void studio.recordings.refresh(), [studio, state]);
  const names = open.map((replay) => replay.name);
  const show = (name: string, keep: number) => {
    // The net is the drawing that shows two runs.
    if (keep > 0) studio.view.set({ view: "net" });
    void studio.replay(name, keep);
  };
  const titleOf = (name: string) => list.find((one) => one.name === name)?.notes?.title || name;
  const found = recordingsWith(list, words);
  return (
    <>
      <h2 className="visually-hidden">Recordings</h2>
      {problem && <p className="problem-hint">{problem}</p>}
      {list.length === 0 && !problem && <p className="faint">Nothing was recorded yet: every run leaves a recording.</p>}
      {list.length > 0 && shown && <p className="faint">A recording is shown beside the run.</p>}
      {list.length >= many && (
        <input
          type="search"
          aria-label="Recordings whose name or note has"
          placeholder="find by name, note or mark"
          value={words}
          onChange={({ target }) => setWords(target.value)}
        />
      )}
      {list.length > 0 && found.length === 0 && <p className="faint">No recording has these words.</p>}
      <ul className="recordings">
        {found.map((one) => (
          <li key={one.name}>
            <button aria-pressed={names.includes(one.name)} onClick={() => show(one.name, 0)}>
              <span className="name">{titleOf(one.name)}</span>
              <span className="faint">{factsOf(one)}</span>
              {one.notes?.text && <span className="faint">{one.notes.text.split("\n")[0]!.slice(0, 120)}</span>}
            </button>
            {!shown && names.length > 0 && names[0] !== one.name && (
              <button
                className="beside"
                aria-label={`Show ${titleOf(one.name)} beside ${titleOf(names[0]!)}`}
                title="Side by side with what is shown"
                onClick={() => show(one.name, 1)}
              >
                Beside
              </button>
            )}
            <button
              className="beside"
              aria-expanded={noted === one.name}
              aria-label={`Notes of ${titleOf(one.name)}`}
              title="Its name, a note, and marks at moments"
              onClick={() => setNoted(noted === one.name ? null : one.name)}
            >
              Notes
            </button>
            {noted === one.name && <RecordingNotes recording={one} replay={open.find(({ name }) => name === one.name) ?? null} />}
          </li>
        ))}
      </ul>
      <SweepPanel />
    </>
  );
}

function factsOf({ name, bytes, modified, duration, notes }: RecordingInfo): string {
  const size = bytes < 1e6 ? `${Math.ceil(bytes / 1000)} kB` : `${(bytes / 1e6).toFixed(1)} MB`;
  const when = new Date(modified).toLocaleString("en-GB", { dateStyle: "medium", timeStyle: "short" });
  const marks = notes && notes.marks.length > 0 ? [`${notes.marks.length} ${notes.marks.length === 1 ? "mark" : "marks"}`] : [];
  return [`${duration.toFixed(1)} s`, size, when, ...marks, ...(notes?.title ? [name] : [])].join(" · ");
}
