import { useEffect } from "react";
import { ConflictDialog } from "../panels/text/conflict_dialog";
import { ConnectionBanner } from "../panels/connection_banner";
import { LineBar } from "../panels/line/line_bar";
import { Problems } from "../panels/problems";
import { Search } from "../panels/search";
import { StartPage } from "../panels/start_page";
import { Toolbar } from "../panels/toolbar";
import { RemovalDialog } from "../panels/forms/removal_dialog";
import { RenameDialog } from "../panels/forms/rename_dialog";
import { TrustDialog } from "../panels/trust_dialog";
import { Boundary } from "../panels/boundary";
import { Dock } from "./dock";
import { useStore, useStudio } from "../hooks/use";
import { shortcutOf, type ShortcutOf } from "../model/shortcuts";
import { Guide, TourOffer } from "../panels/help/guide";

export function App() {
  const studio = useStudio();
  const theme = useStore(studio.view, (view) => view.theme);
  const searching = useStore(studio.view, (view) => view.searching);
  useEffect(() => {
    document.documentElement.dataset.theme = theme;
  }, [theme]);
  const busy = useStore(studio.draft.store, (draft) => draft.editing || draft.checking);
  // An empty project has nothing to show in panels yet.
  const byHand = useStore(studio.guide.store, (all) => all.byHand);
  const blank = useStore(studio.draft.store, ({ loaded, text, unreadable }) => loaded && text.trim() === "" && !unreadable);
  const beginning = blank && !byHand;
  useShortcuts();
  return (
    <div className="app" aria-busy={busy}>
      <Toolbar />
      <LineBar />
      <ConnectionBanner />
      <TourOffer />
      <Boundary>{beginning ? <StartPage /> : <Dock />}</Boundary>
      {!beginning && <Problems />}
      {searching && <Search />}
      <ConflictDialog />
      <RenameDialog />
      <RemovalDialog />
      <TrustDialog />
      <Guide />
    </div>
  );
}

/** Keys that have the same meaning everywhere on the page. */
function useShortcuts(): void {
  const studio = useStudio();
  useEffect(() => {
    const key = (event: KeyboardEvent) => {
      const actions: Record<ShortcutOf<"everywhere">, () => void> = {
        search: () => studio.view.set({ searching: true }),
        save: () => void studio.draft.save(),
        undo: () => void studio.editor.undo(),
        redo: () => void studio.editor.redo(),
        help: () => studio.guide.open(true),
      };
      const pressed = shortcutOf("everywhere", event);
      if (!pressed || isField(event.target, pressed)) return;
      event.preventDefault();
      actions[pressed]();
    };
    window.addEventListener("keydown", key);
    return () => window.removeEventListener("keydown", key);
  }, [studio]);
}

/** In a text field, the keys for undo and letters belong to the field. */
function isField(target: EventTarget | null, pressed: ShortcutOf<"everywhere">): boolean {
  const types =
    target instanceof HTMLInputElement || target instanceof HTMLTextAreaElement || target instanceof HTMLSelectElement;
  if (pressed === "undo" || pressed === "redo") return types && !(target instanceof HTMLSelectElement);
  return pressed === "help" && (types || (target instanceof HTMLElement && target.isContentEditable));
}
