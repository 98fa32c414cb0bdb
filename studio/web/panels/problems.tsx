import { useState } from "react";
import { useStore, useStudio } from "../hooks/use";

/** The complaints of the parser, and their positions. */
export function Problems() {
  const studio = useStudio();
  const diagnostics = useStore(studio.draft.store, (draft) => draft.diagnostics);
  const checking = useStore(studio.draft.store, (draft) => draft.checking);
  const net = useStore(studio.draft.store, (draft) => draft.net);
  const [chosen, setChosen] = useState<boolean | null>(null);
  const errors = diagnostics.filter((one) => one.severity === "error").length;
  const warnings = diagnostics.filter((one) => one.severity === "warning").length;
  const notes = diagnostics.length - errors - warnings;
  // Notes alone do not take the space of the drawing.
  const open = chosen ?? errors + warnings > 0;
  const problems = [count(errors, "error"), count(warnings, "warning")].filter(Boolean).join(", ") || "No problems";
  const go = (line: number) => {
    studio.view.set({ text: true });
    studio.showLine(line);
  };
  return (
    <footer className="problems">
      <div className="status">
        <button
          className="quiet"
          aria-expanded={open && diagnostics.length > 0}
          onClick={() => setChosen(!open)}
          data-testid="problem-count"
        >
          <span className={`dot ${errors ? "error" : warnings ? "warning" : "good"}`} />
          {notes > 0 ? `${problems}, ${count(notes, "note")}` : problems}
        </button>
        <span className="faint">{checking ? "checking…" : ""}</span>
        <span className="spring" />
        {net && (
          <span className="faint">
            {net.places.length} places · {net.transitions.length} transitions · {net.pages.length} pages
          </span>
        )}
      </div>
      {open && diagnostics.length > 0 && (
        <ul className="problem-list" aria-label="Problems">
          {diagnostics.map((one, at) => (
            <li key={at}>
              <button className="problem" onClick={() => go(one.line)}>
                <span className={`dot ${one.severity}`} />
                <span className="where">
                  {/* The message names the line of an included file. */}
                  {one.line > 0 && `${one.line}:${one.column}`}
                </span>
                <span className="what">
                  {one.message}
                  {one.hint && <span className="hint"> — {one.hint}</span>}
                </span>
                <span className="code">{one.code}</span>
              </button>
            </li>
          ))}
        </ul>
      )}
    </footer>
  );
}

const count = (number: number, what: string) => (number === 0 ? "" : `${number} ${what}${number === 1 ? "" : "s"}`);
