import { useStudio } from "../hooks/use";
import type { Pane } from "../live/scene";
import { IconButton } from "./icons";

/** The head above each of two panes: its title, and a button to close it. */
export function PaneHead({ pane, title }: { pane: Pane; title: string }) {
  const studio = useStudio();
  return (
    <header className="pane-head">
      <h2 title={title}>{title}</h2>
      <span className="spring" />
      <IconButton
        name="remove"
        label={`Close ${title}`}
        title={pane.id === "run" && studio.runner.active ? "Put this pane away; the run goes on" : "Put this away"}
        onClick={() => studio.scene.close(pane)}
      />
    </header>
  );
}
