import { useEffect, useRef } from "react";
import { useStore, useStudio } from "../hooks/use";

/** Before the first run in a folder that came from elsewhere. */
export function TrustDialog() {
  const studio = useStudio();
  const asking = useStore(studio.trust.store, (all) => all.asking);
  const problem = useStore(studio.trust.store, (all) => all.problem);
  const folder = useStore(studio.project, (all) => all.project?.folder ?? "");
  const ref = useRef<HTMLDialogElement>(null);
  useEffect(() => {
    if (asking) ref.current?.showModal();
    else ref.current?.close();
  }, [asking]);
  return (
    <dialog ref={ref} className="dialog trust" aria-labelledby="trust-title" onClose={() => void studio.trust.answer(false)}>
      <h2 id="trust-title">Do you trust the authors of this folder?</h2>
      <p className="mono">{folder}</p>
      <p>
        A run compiles the C++ in it and executes it with your rights: <code>src/</code> and <code>project.cmake</code>. To look
        at the system, to edit and to verify it executes nothing.
      </p>
      {problem && <p className="problem-hint">{problem}</p>}
      <div className="buttons">
        <button autoFocus onClick={() => void studio.trust.answer(false)}>
          Do not run it
        </button>
        <button className="primary" onClick={() => void studio.trust.answer(true)}>
          Trust it and run
        </button>
      </div>
    </dialog>
  );
}
