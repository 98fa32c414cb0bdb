import { useEffect } from "react";
import { useStore, useStudio } from "../hooks/use";

/** Reports that the server is gone, and the reaction of the page. */
export function ConnectionBanner() {
  const studio = useStudio();
  const { state, attempt } = useStore(studio.connection.store, (all) => all);
  const notice = useStore(studio.draft.store, (draft) => draft.notice);
  useEffect(() => {
    if (!notice) return;
    const timer = setTimeout(() => studio.draft.store.set({ notice: "" }), 5000);
    return () => clearTimeout(timer);
  }, [notice, studio]);
  return (
    <>
      {state === "lost" && (
        <div className="strip warning" role="alert">
          The server does not answer. What you edit is kept in this tab; trying again{attempt > 1 ? ` (${attempt})` : ""}…
        </div>
      )}
      {state === "refused" && (
        <div className="strip error" role="alert">
          The server was started anew and has a new address: open the one that <code>tessera studio</code> printed. What you
          edited is kept in this tab.
        </div>
      )}
      <div className="toast-place" aria-live="polite">
        {notice && <div className="toast">{notice}</div>}
      </div>
    </>
  );
}
