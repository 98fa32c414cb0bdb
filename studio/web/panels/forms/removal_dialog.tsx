import { useEffect, useRef } from "react";
import { useStore, useStudio } from "../../hooks/use";

/** Before a removal that also removes or changes other parts. */
export function RemovalDialog() {
  const studio = useStudio();
  const removal = useStore(studio.elements.store, (all) => all.removal);
  const ref = useRef<HTMLDialogElement>(null);
  useEffect(() => {
    if (removal) ref.current?.showModal();
    else ref.current?.close();
  }, [removal]);
  return (
    <dialog ref={ref} className="dialog" aria-labelledby="removal-title" onClose={() => studio.elements.agree(false)}>
      {removal && (
        <>
          <h2 id="removal-title">Remove {removal.what}?</h2>
          <p>This removes or changes these lines, also of what needs it:</p>
          <pre tabIndex={0} aria-label="Changed lines">
            {removal.lines.join("\n")}
          </pre>
          <p className="faint">Undo takes it back.</p>
          <div className="buttons">
            <button onClick={() => studio.elements.agree(false)}>Keep it</button>
            <button autoFocus className="primary" onClick={() => studio.elements.agree(true)}>
              Remove all of it
            </button>
          </div>
        </>
      )}
    </dialog>
  );
}
