import { lazy, Suspense, useEffect } from "react";
import { NetCanvas } from "../canvas/net_canvas";
import { StructureCanvas } from "../canvas/structure_canvas";
import { ConflictDialog } from "../panels/conflict_dialog";
import { ConnectionBanner } from "../panels/connection_banner";
import { Player } from "../panels/player";
import { Problems } from "../panels/problems";
import { Search } from "../panels/search";
import { SidePanel } from "../panels/side_panel";
import { Toolbar } from "../panels/toolbar";
import { Watch } from "../panels/watch";
import { Boundary } from "./boundary";
import { Split } from "./split";
import { useStore, useStudio } from "./use";

const TextPane = lazy(() => import("../panels/text_pane"));

export function App() {
  const studio = useStudio();
  const theme = useStore(studio.view, (view) => view.theme);
  const text = useStore(studio.view, (view) => view.text);
  const searching = useStore(studio.view, (view) => view.searching);
  useEffect(() => {
    document.documentElement.dataset.theme = theme;
  }, [theme]);
  useShortcuts();
  return (
    <div className="app">
      <Toolbar />
      <ConnectionBanner />
      <Split
        left={
          text ? (
            <Suspense fallback={<div className="pane-empty">Loading the text…</div>}>
              <TextPane />
            </Suspense>
          ) : null
        }
        right={
          <Boundary>
            <SidePanel />
          </Boundary>
        }
      >
        <Boundary>
          <Centre />
        </Boundary>
      </Split>
      <Watch />
      <Problems />
      {searching && <Search />}
      <ConflictDialog />
    </div>
  );
}

function Centre() {
  const studio = useStudio();
  const { project, problem } = useStore(studio.project, (all) => all);
  const edited = useStore(studio.draft.store, (draft) => draft.net);
  const shown = useStore(studio.stage.shown, (all) => all);
  // What plays or runs is drawn as it was when it began.
  const net = shown.mode === "edit" ? edited : shown.net;
  const view = useStore(studio.view, (all) => all.view);
  const current = useStore(studio.draft.store, (draft) => draft.current);
  const loaded = useStore(studio.draft.store, (draft) => draft.loaded);
  if (problem && !project) return <Empty title="The server could not be asked" text={problem} />;
  if (!loaded) return <Empty title="Opening…" text="" />;
  return (
    <main className="centre">
      {view === "structure" ? (
        <StructureCanvas />
      ) : net === null ? (
        <Empty
          title="No drawing yet"
          text="The specification has errors. They are listed below and marked in the text; the drawing appears when they are gone."
        />
      ) : (
        <>
          {net !== edited && (
            <div className="strip">
              The text changed since; this is the net that {shown.mode === "live" ? "runs" : "is played"}.
            </div>
          )}
          {!current && net === edited && (
            <div className="strip warning">The specification has errors: this is the drawing of the last version without.</div>
          )}
          <NetCanvas net={net} />
        </>
      )}
      <Player />
    </main>
  );
}

function Empty({ title, text }: { title: string; text: string }) {
  return (
    <div className="empty">
      <h2>{title}</h2>
      <p>{text}</p>
    </div>
  );
}

/** Keys that mean the same everywhere on the page. */
function useShortcuts(): void {
  const studio = useStudio();
  useEffect(() => {
    const key = (event: KeyboardEvent) => {
      if (!(event.ctrlKey || event.metaKey)) return;
      const actions: Record<string, () => void> = {
        k: () => studio.view.set({ searching: true }),
        s: () => void studio.draft.save(),
        z: () => (event.shiftKey ? studio.draft.redo() : studio.draft.undo()),
        y: () => studio.draft.redo(),
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

/** In a text field, undo is the field's. */
const isField = (target: EventTarget | null, key: string) =>
  target instanceof HTMLInputElement && "zy".includes(key.toLowerCase());
