import { NetCanvas, type DrawnPane } from "../canvas/net/net_canvas";
import { StructureCanvas } from "../canvas/structure_canvas";
import { ComparisonBar } from "../panels/run/comparison";
import { CoverageLegend } from "../panels/run/coverage";
import { FilmButton } from "../panels/film/film_button";
import { FleetPage } from "../panels/fleet/fleet_page";
import { PaneHead } from "../panels/pane_head";
import { usePaneTitle } from "../panels/pane_title";
import { Player } from "../panels/run/player";
import { StartPage } from "../panels/start_page";
import { useStore, useStudio } from "../hooks/use";

/** The panel in the middle: it shows the system. */
export function Centre() {
  const studio = useStudio();
  const { project, problem } = useStore(studio.project, (all) => all);
  const view = useStore(studio.view, (all) => all.view);
  const loaded = useStore(studio.draft.store, (draft) => draft.loaded);
  const blank = useStore(studio.draft.store, (draft) => draft.text.trim() === "");
  const unreadable = useStore(studio.draft.store, (draft) => draft.unreadable);
  const panes = useStore(studio.scene.store, (all) => all.panes);
  const sameTime = useStore(studio.scene.store, (all) => all.sameTime);
  if (problem && !project) return <Empty title="The server could not be asked" text={problem} />;
  if (!loaded) return <Empty title="Opening…" text="" />;
  if (blank && unreadable)
    return <Empty title={`${project?.file ?? "The file"} cannot be read`} text={`${unreadable}. It stays as it is.`} />;
  if (blank) return <StartPage />;
  const beside = panes.length > 1;
  // The controls of the first pane are in the line of the run, below the toolbar.
  const players = beside ? panes.map((pane, at) => at > 0 && <Player key={pane.id} pane={pane} fixed={sameTime} />) : [];
  return (
    <div className="centre">
      {view === "fleet" && project && project.processes.length > 0 ? (
        <>
          <FleetPage />
          {players}
        </>
      ) : view === "structure" ? (
        <>
          <StructureCanvas />
          {players}
        </>
      ) : (
        <Nets players={players} />
      )}
    </div>
  );
}

function Nets({ players }: { players: React.ReactNode[] }) {
  const studio = useStudio();
  const title = usePaneTitle();
  const edited = useStore(studio.draft.store, (draft) => draft.net);
  const current = useStore(studio.draft.store, (draft) => draft.current);
  const desk = useStore(studio.desk.shown, (all) => all);
  const panes = useStore(studio.scene.store, (all) => all.panes);
  const beside = panes.length > 1;
  const drawn = panes.flatMap((pane, at): DrawnPane[] => {
    // A run, a game or a recording is drawn with its net at the beginning.
    const net = pane.track?.net ?? (desk.mode === "edit" ? edited : desk.net);
    if (!net) return [];
    const head = beside && <PaneHead pane={pane} title={title(pane)} />;
    return [{ pane, net, title: title(pane), head, foot: players[at], legend: pane.track && <CoverageLegend pane={pane} /> }];
  });
  if (drawn.length === 0)
    return (
      <Empty
        title="No drawing yet"
        text="The specification has errors. They are listed below and marked in the text; the drawing appears when they are gone."
      />
    );
  const old = drawn.find(({ net }) => net !== edited);
  return (
    <>
      {old && (
        <div className="strip">The text changed since; this is the net that {old.pane.id === "run" ? "runs" : "is played"}.</div>
      )}
      {!current && !old && (
        <div className="strip warning">The specification has errors: this is the drawing of the last version without.</div>
      )}
      <NetCanvas panes={drawn} between={beside && <ComparisonBar />} film={<FilmButton />} />
    </>
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
