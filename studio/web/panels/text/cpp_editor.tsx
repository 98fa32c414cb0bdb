import { autocompletion, closeBrackets, type CompletionContext, type CompletionResult } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap, indentWithTab } from "@codemirror/commands";
import { cpp } from "@codemirror/lang-cpp";
import { bracketMatching, indentOnInput, indentUnit, syntaxHighlighting } from "@codemirror/language";
import { lintGutter, setDiagnostics } from "@codemirror/lint";
import { highlightSelectionMatches, search, searchKeymap } from "@codemirror/search";
import { Compartment, EditorState, Transaction } from "@codemirror/state";
import { drawSelection, EditorView, highlightActiveLine, highlightActiveLineGutter, keymap, lineNumbers } from "@codemirror/view";
import { classHighlighter } from "@lezer/highlight";
import { useEffect, useRef } from "react";
import { pathBefore, type Member } from "../../model/text/cpp_members";
import { splice } from "../../model/text/merge";

/** A message of the compiler at a line and a column of the function, both from 1; column 0: the whole line. */
export interface Mark {
  line: number;
  column: number;
  severity: "error" | "warning";
  text: string;
}

export interface CppEditorProps {
  label: string;
  text: string;
  /** The number of its first line in the file. */
  firstLine: number;
  marks: readonly Mark[];
  /** The place to go to, with a number that makes each request new. */
  place: { line: number; column: number; request: number } | null;
  members: (path: readonly string[]) => readonly Member[];
  onChange: (text: string) => void;
  onSave: () => void;
}

/** A function in C++. */
export default function CppEditor(props: CppEditorProps) {
  const { label, text, firstLine, marks, place } = props;
  const host = useRef<HTMLDivElement>(null);
  const view = useRef<EditorView | null>(null);
  const now = useRef(props);
  now.current = props;
  useEffect(() => {
    const made = new EditorView({
      parent: host.current!,
      state: EditorState.create({ doc: now.current.text, extensions: extensions(() => now.current) }),
    });
    made.scrollDOM.tabIndex = 0;
    view.current = made;
    // Tests read the text there; only the lines that can be seen are in the page.
    Object.assign(host.current!, { editor: made });
    return () => made.destroy();
  }, []);
  useEffect(() => view.current?.dispatch({ effects: placed.reconfigure(placeIn(label, firstLine)) }), [label, firstLine]);
  useEffect(() => {
    const editor = view.current;
    if (!editor || editor.state.doc.toString() === text) return;
    // A change from elsewhere: undo does not take it back.
    editor.dispatch({
      changes: splice(editor.state.doc.toString(), text),
      annotations: Transaction.addToHistory.of(false),
    });
  }, [text]);
  useEffect(() => {
    if (view.current) mark(view.current, marks);
  }, [marks]);
  useEffect(() => {
    const editor = view.current;
    if (!editor || !place) return;
    const anchor = offset(editor.state, place.line, place.column);
    editor.dispatch({ selection: { anchor }, effects: EditorView.scrollIntoView(anchor, { y: "center" }) });
    editor.focus();
  }, [place]);
  return (
    <div
      ref={host}
      className="editor code-editor"
      // Undo and save belong to the function while its text has the focus, and not to the specification.
      onKeyDown={(event) => {
        if ((event.ctrlKey || event.metaKey) && "szy".includes(event.key.toLowerCase())) event.stopPropagation();
      }}
    />
  );
}

/** The line numbers and the name of the text change when the function moves in its file. */
const placed = new Compartment();
const placeIn = (label: string, firstLine: number) => [
  lineNumbers({ formatNumber: (line) => String(line + firstLine - 1) }),
  EditorView.contentAttributes.of({ "aria-label": label, spellcheck: "false" }),
];

function extensions(now: () => CppEditorProps) {
  const { label, firstLine } = now();
  return [
    placed.of(placeIn(label, firstLine)),
    lintGutter(),
    highlightActiveLine(),
    highlightActiveLineGutter(),
    drawSelection(),
    EditorView.lineWrapping, // a new function is one long line, and its empty braces are at the end
    history(),
    indentUnit.of("  "),
    indentOnInput(),
    bracketMatching(),
    closeBrackets(),
    highlightSelectionMatches(),
    search({ top: true }),
    cpp(),
    syntaxHighlighting(classHighlighter),
    autocompletion({ override: [complete(now)], selectOnOpen: false, interactionDelay: 0 }),
    keymap.of([
      { key: "Mod-s", run: () => (now().onSave(), true), preventDefault: true },
      // Tab indents; Escape and then Tab leaves the text.
      ...searchKeymap,
      ...historyKeymap,
      ...defaultKeymap,
      indentWithTab,
    ]),
    EditorView.updateListener.of((update) => {
      if (update.docChanged) now().onChange(update.state.doc.toString());
    }),
  ];
}

/** Names of the subsystem: buffers, memory, parameters, and their fields. */
const complete =
  (now: () => CppEditorProps) =>
  (context: CompletionContext): CompletionResult | null => {
    const line = context.state.doc.lineAt(context.pos);
    const path = pathBefore(line.text.slice(0, context.pos - line.from));
    if (path === null && !context.explicit) return null;
    const options = now().members(path ?? []);
    if (options.length === 0) return null;
    const word = context.matchBefore(/\w*$/);
    return {
      from: word?.from ?? context.pos,
      options: options.map(({ name, kind, detail }) => ({
        label: name,
        type: kind === "value" ? "property" : "function",
        detail,
      })),
      validFor: /^\w*$/,
    };
  };

function offset(state: EditorState, line: number, column: number): number {
  const at = state.doc.line(Math.min(Math.max(line, 1), state.doc.lines));
  return Math.min(at.from + Math.max(column - 1, 0), at.to);
}

function mark(editor: EditorView, marks: readonly Mark[]): void {
  const { state } = editor;
  const all = marks.map(({ line, column, severity, text }) => {
    const from = offset(state, line, column);
    const word = column > 0 ? state.wordAt(from) : null;
    const end = word?.to ?? state.doc.lineAt(from).to;
    return { from, to: Math.max(end, Math.min(from + 1, state.doc.length)), severity, message: text };
  });
  editor.dispatch(setDiagnostics(state, all));
}
