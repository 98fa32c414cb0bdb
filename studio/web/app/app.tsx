import { useEffect } from "react";
import { ConflictDialog } from "../panels/text/conflict_dialog";
import { ConnectionBanner } from "../panels/connection_banner";
import { LineBar } from "../panels/line/line_bar";
import { Problems } from "../panels/problems";
import { Search } from "../panels/search";
import { Toolbar } from "../panels/toolbar";
import { RenameDialog } from "../panels/forms/rename_dialog";
import { TrustDialog } from "../panels/trust_dialog";
import { Boundary } from "./boundary";
import { Dock } from "./dock";
import { useStore, useStudio } from "../hooks/use";

export function App() {
  const studio = useStudio();
  const theme = useStore(studio.view, (view) => view.theme);
  const searching = useStore(studio.view, (view) => view.searching);
  useEffect(() => {
    document.documentElement.dataset.theme = theme;
  }, [theme]);
  const busy = useStore(studio.draft.store, (draft) => draft.editing || draft.checking);
  useShortcuts();
  return (
    <div className="app" aria-busy={busy}>
      <Toolbar />
      <LineBar />
      <ConnectionBanner />
      <Boundary>
        <Dock />
      </Boundary>
      <Problems />
      {searching && <Search />}
      <ConflictDialog />
      <RenameDialog />
      <TrustDialog />
    </div>
  );
}

/** Keys that have the same meaning everywhere on the page. */
function useShortcuts(): void {
  const studio = useStudio();
  useEffect(() => {
    const key = (event: KeyboardEvent) => {
      if (!(event.ctrlKey || event.metaKey)) return;
      const actions: Record<string, () => void> = {
        k: () => studio.view.set({ searching: true }),
        s: () => void studio.draft.save(),
        z: () => void (event.shiftKey ? studio.editor.redo() : studio.editor.undo()),
        y: () => void studio.editor.redo(),
      };
      const action = actions[event.key.toLowerCase()];
      if (!action || isField(event.target, event.key)) return;
      event.preventDefault();
      action();
    };
    window.addEventListener("keydown", key);
    return () => window.removeEventListener("keydown", key);
  }, [studio]);
}

/** In a text field, the keys for undo belong to the field. */
const isField = (target: EventTarget | null, key: string) =>
  (target instanceof HTMLInputElement || target instanceof HTMLTextAreaElement) && "zy".includes(key.toLowerCase());
