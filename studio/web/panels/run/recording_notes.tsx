import { useState } from "react";
import { useStore, useStudio } from "../../hooks/use";
import type { Replay } from "../../live/run/replay";
import type { Notes, RecordingInfo } from "../../model/protocol";
import { clock } from "../plots/clock";

const none: Notes = { title: "", text: "", marks: [], revision: "", problem: "" };

/** The limits of the server, in bytes of UTF-8. */
const longest = { title: 200, text: 10_000, mark: 500 };
const bytes = (text: string) => new TextEncoder().encode(text).length;

/** The name, the text and the marks that the user gives to a recording. */
export function RecordingNotes({ recording, replay }: { recording: RecordingInfo; replay: Replay | null }) {
  const studio = useStudio();
  const known = recording.notes ?? none;
  // The typed text stays when the notes change elsewhere.
  const [typed, setTyped] = useState<Partial<Pick<Notes, "title" | "text">>>({});
  const [mark, setMark] = useState("");
  const [problem, setProblem] = useState("");
  const keep = async (change: Partial<Pick<Notes, "title" | "text" | "marks">>) => {
    const { title, text, marks, revision } = { ...known, ...typed, ...change };
    const wrong =
      bytes(title) > longest.title
        ? `A name has at most ${longest.title} bytes.`
        : bytes(text) > longest.text
          ? `A note has at most ${longest.text} bytes.`
          : marks.some((one) => bytes(one.text) > longest.mark)
            ? `A mark has at most ${longest.mark} bytes.`
            : "";
    const said = wrong || (await studio.recordings.saveNotes(recording.name, { title, text, marks: [...marks], revision }));
    setProblem(said);
    if (said === "") setTyped({});
    return said === "";
  };
  if (known.problem) return <p className="problem-hint">{known.problem}</p>;
  const title = typed.title ?? known.title;
  const text = typed.text ?? known.text;
  const addMark = async () => {
    if (!replay || mark.trim() === "") return;
    const marks = [...known.marks, { t: Math.round(replay.track.now), text: mark.trim() }].sort((a, b) => a.t - b.t);
    if (await keep({ marks })) setMark("");
  };
  const field = recording.name;
  return (
    <div className="recording-notes">
      <label htmlFor={`title-${field}`}>Name</label>
      <input
        id={`title-${field}`}
        type="text"
        value={title}
        onChange={({ target }) => setTyped({ ...typed, title: target.value })}
        onBlur={() => title !== known.title && void keep({})}
        onKeyDown={({ key }) => key === "Enter" && title !== known.title && void keep({})}
      />
      <label htmlFor={`text-${field}`}>Note</label>
      <textarea
        id={`text-${field}`}
        rows={3}
        value={text}
        onChange={({ target }) => setTyped({ ...typed, text: target.value })}
        onBlur={() => text !== known.text && void keep({})}
      />
      {replay && (
        <div className="recording-mark">
          <input
            type="text"
            aria-label="Text of the mark"
            placeholder={`what happens at ${clock(replay.track.now)} s`}
            value={mark}
            onChange={({ target }) => setMark(target.value)}
            onKeyDown={({ key }) => key === "Enter" && void addMark()}
          />
          <MarkButton replay={replay} disabled={mark.trim() === ""} onClick={() => void addMark()} />
        </div>
      )}
      {problem && (
        <p className="problem-hint" role="alert">
          {problem}
        </p>
      )}
      <ul aria-label={`Marks of ${known.title || recording.name}`}>
        {known.marks.map(({ t, text: said }, at) => (
          <li key={`${t} ${said}`}>
            <button className="quiet" disabled={!replay} title="Shows this moment" onClick={() => replay?.seek(t)}>
              <span className="faint">{clock(t)} s</span> {said}
            </button>
            <button
              className="quiet"
              aria-label={`Remove the mark ${said}`}
              onClick={() => void keep({ marks: known.marks.filter((_, one) => one !== at) })}
            >
              ×
            </button>
          </li>
        ))}
      </ul>
    </div>
  );
}

/** Its text has the shown time. */
function MarkButton({ replay, disabled, onClick }: { replay: Replay; disabled: boolean; onClick: () => void }) {
  const time = useStore(replay.store, (all) => all.time);
  return (
    <button disabled={disabled} onClick={onClick}>
      Mark {clock(time)} s
    </button>
  );
}
