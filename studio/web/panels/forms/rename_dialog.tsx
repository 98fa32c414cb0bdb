import { useEffect, useRef } from "react";
import { useStore, useStudio } from "../../hooks/use";
import type { FileRenamed } from "../../model/protocol";

const linesOf = (lines: readonly number[]) => `${lines.length === 1 ? "line" : "lines"} ${[...new Set(lines)].join(", ")}`;

/** Before a rename that changes other files than the specification. */
export function RenameDialog() {
  const studio = useStudio();
  const renaming = useStore(studio.draft.store, (draft) => draft.renaming);
  const ref = useRef<HTMLDialogElement>(null);
  useEffect(() => {
    if (renaming) ref.current?.showModal();
    else ref.current?.close();
  }, [renaming]);
  return (
    <dialog ref={ref} className="dialog rename" aria-labelledby="rename-title" onClose={() => studio.editor.agree(false)}>
      {renaming && <Asked name={renaming.name} files={renaming.files} />}
    </dialog>
  );
}

/** name: the new one. */
function Asked({ name, files }: { name: string; files: readonly FileRenamed[] }) {
  const studio = useStudio();
  const changed = files.filter(({ lines }) => lines.length > 0);
  const unsure = files.filter(({ unsure }) => unsure.length > 0);
  return (
    <>
      <h2 id="rename-title">Change the name everywhere?</h2>
      <p>
        The new name is {name}. The specification{changed.length > 0 ? " and these files are saved together:" : " is saved."}
      </p>
      <ul>
        {changed.map(({ file, lines }) => (
          <li key={file}>
            <span className="mono">{file}</span>: {linesOf(lines)}
          </li>
        ))}
      </ul>
      {unsure.length > 0 && (
        <>
          <p>Only a compiler can tell whether these are the same name. They are not changed:</p>
          <ul>
            {unsure.map(({ file, unsure }) => (
              <li key={file}>
                <span className="mono">{file}</span>: {linesOf(unsure)}
              </li>
            ))}
          </ul>
        </>
      )}
      <p className="faint">Undo takes all of it back.</p>
      <div className="buttons">
        <button onClick={() => studio.editor.agree(false)}>Keep the old name</button>
        <button autoFocus className="primary" onClick={() => studio.editor.agree(true)}>
          Rename everywhere
        </button>
      </div>
    </>
  );
}
