import { useStore, useStudio } from "../hooks/use";
import { isUnsaved } from "../live/draft";
import type { View } from "../model/view_state";
import { About } from "./about";
import { Icon, IconButton } from "./icons";

const viewTitles: Record<View, string> = { net: "Net", structure: "Structure", fleet: "Fleet" };

export function Toolbar() {
  const studio = useStudio();
  const project = useStore(studio.project, (all) => all.project);
  const { view, text, theme } = useStore(studio.view, (all) => all);
  const draft = useStore(studio.draft.store, (all) => all);
  const dirty = isUnsaved(draft);
  const views: View[] = project && project.processes.length > 0 ? ["net", "structure", "fleet"] : ["net", "structure"];
  const choose = (next: View) => studio.view.set({ view: next });
  return (
    <header className="toolbar">
      <About />
      <h1 className="project" title={project ? `${project.folder}/${project.file}` : ""}>
        <span className="name">{project?.name ?? "…"}</span>
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
        <Icon name="search" /> Find by path <kbd>Ctrl K</kbd>
      </button>
      <span className="spring" />
      <Verdicts />
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
      <button
        className="icon"
        aria-label="Dark colours"
        aria-pressed={theme === "dark"}
        title="Light or dark"
        onClick={() => studio.view.set({ theme: theme === "dark" ? "light" : "dark" })}
      >
        <Icon name="theme" />
      </button>
      <button className="primary" disabled={!dirty} onClick={() => void studio.draft.save()} title="Save (Ctrl S)">
        Save
      </button>
    </header>
  );
}

/** The result of the last verification of the current text, in a summary. */
function Verdicts() {
  const studio = useStudio();
  const { verdicts, text, state } = useStore(studio.verifier.store, (all) => all);
  const now = useStore(studio.draft.store, (draft) => draft.text);
  if (state === "running") return <span className="faint">verifying…</span>;
  if (verdicts.length === 0 || text !== now) return null;
  const violated = verdicts.filter((one) => one.verdict === "violated" && !one.warning).length;
  const unknown = verdicts.filter((one) => one.verdict === "unknown").length;
  const warnings = verdicts.filter((one) => one.verdict === "violated" && one.warning).length;
  const said = violated > 0 ? `${violated} violated` : unknown > 0 ? `${unknown} unknown` : "verified";
  const besides = violated === 0 && warnings > 0 ? `, ${warnings} ${warnings === 1 ? "warning" : "warnings"}` : "";
  return (
    <button className="quiet" onClick={() => studio.view.set({ panel: "verify" })}>
      <span className={`dot ${violated > 0 ? "error" : unknown > 0 ? "warning" : "good"}`} /> {said + besides}
    </button>
  );
}
