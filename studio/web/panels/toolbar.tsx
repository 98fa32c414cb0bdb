import { useStore, useStudio } from "../hooks/use";
import { isUnsaved } from "../live/draft";
import type { View } from "../model/view_state";
import { About } from "./about";
import { Icon, IconButton } from "./icons";
import { PathText } from "../canvas/path_text";
import { PanelsMenu } from "./panels_menu";
import { Steps } from "./steps";

const viewTitles: Record<View, string> = { structure: "Structure", net: "Net", fleet: "Fleet" };

export function Toolbar() {
  const studio = useStudio();
  const project = useStore(studio.project, (all) => all.project);
  const { view, text, theme } = useStore(studio.view, (all) => all);
  const draft = useStore(studio.draft.store, (all) => all);
  const dirty = isUnsaved(draft);
  const views: View[] = project && project.processes.length > 0 ? ["structure", "net", "fleet"] : ["structure", "net"];
  const choose = (next: View) => studio.view.set({ view: next });
  return (
    <header className="toolbar">
      <div className="toolbar-row">
        <About />
        <h1 className="project" title={project ? `${project.folder}/${project.file}` : ""}>
          <span className="name">
            <PathText of={project?.name ?? "…"} />
          </span>
          {dirty && <span className="unsaved" title="Not saved yet" aria-label="not saved" role="img" />}
        </h1>
        <div className="segmented" role="tablist" aria-label="View">
          {views.map((name) => (
            <button key={name} role="tab" aria-selected={view === name} onClick={() => choose(name)}>
              {viewTitles[name]}
            </button>
          ))}
        </div>
        <span className="spring" />
        <button className="search-button" onClick={() => studio.view.set({ searching: true })}>
          <Icon name="search" /> <span className="search-text">Find by path</span> <kbd>Ctrl K</kbd>
        </button>
        <span className="spring" />
        <IconButton
          name="undo"
          label="Undo"
          title="Undo (Ctrl Z)"
          disabled={!draft.canUndo && !draft.editing}
          onClick={() => void studio.editor.undo()}
        />
        <IconButton
          name="redo"
          label="Redo"
          title="Redo (Ctrl Shift Z)"
          disabled={!draft.canRedo && !draft.editing}
          onClick={() => void studio.editor.redo()}
        />
        <button
          className="icon"
          aria-label="Text of the specification"
          aria-pressed={text}
          title="Text of the specification"
          onClick={() => studio.view.set({ text: !text })}
        >
          <Icon name="text" />
        </button>
        <PanelsMenu />
        <button
          className="icon"
          aria-label="Dark colours"
          aria-pressed={theme === "dark"}
          title="Light or dark"
          onClick={() => studio.view.set({ theme: theme === "dark" ? "light" : "dark" })}
        >
          <Icon name="theme" />
        </button>
        <IconButton
          name="question"
          label="Help and shortcuts"
          title="Help and shortcuts (?)"
          onClick={() => studio.guide.open(true)}
        />
      </div>
      <Steps />
    </header>
  );
}
