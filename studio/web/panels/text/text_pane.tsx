import { defaultKeymap } from "@codemirror/commands";
import { yaml } from "@codemirror/lang-yaml";
import { bracketMatching, HighlightStyle, indentOnInput, syntaxHighlighting } from "@codemirror/language";
import { lintGutter, setDiagnostics } from "@codemirror/lint";
import { highlightSelectionMatches, search, searchKeymap } from "@codemirror/search";
import { EditorState, type Text } from "@codemirror/state";
import { drawSelection, EditorView, highlightActiveLine, highlightActiveLineGutter, keymap, lineNumbers } from "@codemirror/view";
import { tags } from "@lezer/highlight";
import { useEffect, useRef } from "react";
import { useStore, useStudio } from "../../hooks/use";
import type { Diagnostic } from "../../model/protocol";
import { shortcuts } from "../../model/shortcuts";
import { splice } from "../../model/text/merge";
import { language } from "./text_language";

const colours = HighlightStyle.define([
  { tag: [tags.propertyName, tags.definition(tags.propertyName)], class: "tok-key" },
  { tag: tags.comment, class: "tok-comment" },
  { tag: [tags.string, tags.special(tags.string)], class: "tok-string" },
  { tag: [tags.number, tags.bool, tags.keyword], class: "tok-number" },
  { tag: [tags.punctuation, tags.separator, tags.squareBracket, tags.brace], class: "tok-punctuation" },
]);

/**
 * The specification as text. The text and the drawing are two views of the same
 * draft, which also handles undo.
 */
export default function TextPane() {
  const studio = useStudio();
  const host = useRef<HTMLDivElement>(null);
  const view = useRef<EditorView | null>(null);
  const text = useStore(studio.draft.store, (draft) => draft.text);
  const diagnostics = useStore(studio.draft.store, (draft) => draft.diagnostics);
  const line = useStore(studio.view, (all) => all.line);
  const file = useStore(studio.project, (all) => all.project?.file ?? "spec.yaml");

  useEffect(() => {
    const edited = EditorView.updateListener.of((update) => {
      if (update.docChanged) studio.draft.edit(update.state.doc.toString(), "typing");
    });
    const undo = keymap.of([
      ...shortcuts.everywhere.undo.keys.map((key) => ({
        key,
        run: () => (void studio.editor.undo(), true),
        preventDefault: true,
      })),
      ...shortcuts.everywhere.redo.keys.map((key) => ({
        key,
        run: () => (void studio.editor.redo(), true),
        preventDefault: true,
      })),
    ]);
    const extensions = [
      lineNumbers(),
      lintGutter(),
      highlightActiveLine(),
      highlightActiveLineGutter(),
      drawSelection(),
      indentOnInput(),
      bracketMatching(),
      highlightSelectionMatches(),
      search({ top: true }),
      yaml(),
      syntaxHighlighting(colours),
      undo,
      language((question) => studio.api.language(question)),
      keymap.of([...searchKeymap, ...defaultKeymap]),
      EditorView.contentAttributes.of({ "aria-label": "Text of the specification" }),
      edited,
    ];
    const made = new EditorView({
      parent: host.current!,
      state: EditorState.create({ doc: studio.draft.store.get().text, extensions }),
    });
    made.scrollDOM.tabIndex = 0;
    made.scrollDOM.setAttribute("aria-label", "Scrolled text");
    made.scrollDOM.setAttribute("role", "region");
    view.current = made;
    mark(made, studio.draft.store.get().diagnostics);
    return () => made.destroy();
  }, [studio]);

  useEffect(() => {
    const editor = view.current;
    // Not the text that was drawn: an effect may run late, and would take back what came since, even the whole file.
    const now = studio.draft.store.get().text;
    if (!editor || editor.state.doc.toString() === now) return;
    const { from, to, insert } = splice(editor.state.doc.toString(), now);
    // The beginning of the line, since a change far to the right would hide that of all others.
    const begin = editor.state.doc.lineAt(from).from;
    editor.dispatch({ changes: { from, to, insert }, effects: EditorView.scrollIntoView(begin, { y: "nearest", yMargin: 60 }) });
  }, [studio, text]);

  useEffect(() => {
    if (view.current) mark(view.current, diagnostics);
  }, [diagnostics]);

  useEffect(() => {
    const editor = view.current;
    if (!editor || !line || line.line > editor.state.doc.lines) return;
    const { from } = editor.state.doc.line(line.line);
    editor.dispatch({ selection: { anchor: from }, effects: EditorView.scrollIntoView(from, { y: "center" }) });
  }, [line]);

  return (
    <div className="text-pane">
      <div className="pane-title">{file}</div>
      <div ref={host} className="editor" data-testid="editor" />
    </div>
  );
}

function mark(editor: EditorView, diagnostics: readonly Diagnostic[]): void {
  const { doc } = editor.state;
  const marks = diagnostics.map((one) => {
    const from = offset(doc, one.line, one.column);
    const to = Math.max(offset(doc, one.end_line || one.line, one.end_column || one.column), from);
    const severity = one.severity === "error" || one.severity === "warning" ? one.severity : ("info" as const);
    return {
      from,
      to: to === from ? Math.min(from + 1, doc.length) : to,
      severity,
      message: `${one.message}${one.hint ? `\n${one.hint}` : ""}`,
      source: one.code,
    };
  });
  editor.dispatch(setDiagnostics(editor.state, marks));
}

/** Lines and columns count from 1; a text that was edited in the meantime may be shorter. */
function offset(doc: Text, line: number, column: number): number {
  if (line < 1) return 0;
  const at = doc.line(Math.min(line, doc.lines));
  return Math.min(at.from + Math.max(0, column - 1), at.to);
}
