import { useEffect, useRef } from "react";
import { useStore, useStudio } from "../../hooks/use";
import { clashesIn, mergeLines } from "../../model/text/merge";
import { WordLines } from "./word_lines";

/** The file changed on disk where this page changed it, too: the user decides which of these lines to keep. */
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
      <p>
        It changed these lines as you did. All other changes of both are kept. Nothing is lost either way: undo brings your text
        back.
      </p>
      {conflict && <Clashes base={conflict.base} mine={mine} theirs={conflict.text} />}
      <div className="buttons">
        <button onClick={() => studio.draft.resolve("theirs")}>Take the lines on disk</button>
        <button className="primary" onClick={() => studio.draft.resolve("mine")}>
          Keep mine
        </button>
      </div>
    </dialog>
  );
}

/** The lines that both changed; the words that differ are marked. */
export function Clashes({ base, mine, theirs }: { base: string; mine: string; theirs: string }) {
  return (
    <pre className="difference" tabIndex={0} aria-label="Differences">
      {clashesIn(mergeLines(base, mine, theirs)).map((clash) => (
        <div key={clash.line}>
          <div className="where">line {clash.line}</div>
          <WordLines
            old={{ sign: "mine │ ", className: "mine", lines: clash.mine }}
            fresh={{ sign: "disk │ ", className: "theirs", lines: clash.theirs }}
          />
        </div>
      ))}
    </pre>
  );
}
