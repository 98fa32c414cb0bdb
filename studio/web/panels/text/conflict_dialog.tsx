import { useEffect, useRef } from "react";
import { useStore, useStudio } from "../../hooks/use";
import { diff } from "../../model/text/merge";

/** The file changed on disk where this page changed it, too: the user decides which version to keep. */
export function ConflictDialog() {
  const studio = useStudio();
  const conflict = useStore(studio.draft.store, (draft) => draft.conflict);
  const mine = useStore(studio.draft.store, (draft) => draft.text);
  const ref = useRef<HTMLDialogElement>(null);
  useEffect(() => {
    if (conflict) ref.current?.showModal();
    else ref.current?.close();
  }, [conflict]);
  return (
    <dialog ref={ref} className="dialog" aria-labelledby="conflict-title" onCancel={(event) => event.preventDefault()}>
      <h2 id="conflict-title">The file was changed by another program</h2>
      <p>It changed the same lines as you did. Nothing is lost either way: undo brings your text back.</p>
      {conflict && <Difference mine={mine} theirs={conflict.text} />}
      <div className="buttons">
        <button onClick={() => studio.draft.resolve("theirs")}>Take the file on disk</button>
        <button className="primary" onClick={() => studio.draft.resolve("mine")}>
          Keep mine
        </button>
      </div>
    </dialog>
  );
}

export function Difference({ mine, theirs }: { mine: string; theirs: string }) {
  const lines = mine.split("\n");
  return (
    <pre className="difference" tabIndex={0} aria-label="Differences">
      {diff(lines, theirs.split("\n")).map((hunk) => (
        <div key={hunk.from}>
          <div className="where">line {hunk.from + 1}</div>
          {lines.slice(hunk.from, hunk.to).map((line, at) => (
            <div key={`m${at}`} className="mine">
              mine │ {line}
            </div>
          ))}
          {hunk.lines.map((line, at) => (
            <div key={`t${at}`} className="theirs">
              disk │ {line}
            </div>
          ))}
        </div>
      ))}
    </pre>
  );
}
