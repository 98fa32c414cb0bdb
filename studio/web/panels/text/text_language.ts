import {
  acceptCompletion,
  autocompletion,
  completionStatus,
  moveCompletionSelection,
  selectedCompletion,
  type Completion,
  type CompletionContext,
  type CompletionResult,
} from "@codemirror/autocomplete";
import type { EditorState, Extension, Text } from "@codemirror/state";
import { EditorView, hoverTooltip, keymap, type Tooltip } from "@codemirror/view";
import { shortcuts } from "../../model/shortcuts";
import type { LanguageAnswer, LanguageQuestion, Proposal, TextPosition } from "../../model/protocol";

/** Asks the server about the present text of the editor. */
export type Ask = (question: LanguageQuestion) => Promise<LanguageAnswer>;

const kinds: Record<Proposal["kind"], string> = {
  key: "property",
  word: "keyword",
  type: "type",
  name: "variable",
  example: "constant",
};

export function placeOf(doc: Text, at: number): TextPosition {
  const line = doc.lineAt(at);
  return { line: line.number - 1, character: at - line.from };
}

/** A text that was edited in the meantime may be shorter. */
export function offsetOf(doc: Text, place: TextPosition): number {
  const line = doc.line(Math.min(place.line + 1, doc.lines));
  return Math.min(line.from + place.character, line.to);
}

async function question(ask: Ask, state: EditorState, at: number, what: LanguageQuestion["ask"]): Promise<LanguageAnswer | null> {
  try {
    return await ask({ text: state.doc.toString(), ...placeOf(state.doc, at), ask: what });
  } catch {
    return null; // The connection shows that the server is gone.
  }
}

/** The words, `code` and **strong** of a short Markdown text as elements. */
export function shown(markdown: string): HTMLElement {
  const all = document.createElement("div");
  all.className = "meaning";
  for (const paragraph of markdown.split(/\n{2,}/)) {
    const block = all.appendChild(document.createElement("p"));
    for (const part of paragraph.split(/(`[^`]*`|\*\*[^*]*\*\*)/)) {
      if (part.startsWith("`")) block.appendChild(document.createElement("code")).textContent = part.slice(1, -1);
      else if (part.startsWith("**")) block.appendChild(document.createElement("strong")).textContent = part.slice(2, -2);
      else block.append(part);
    }
  }
  return all;
}

function completionOf(one: Proposal): Completion {
  return {
    label: one.label,
    apply: one.insert,
    type: kinds[one.kind],
    detail: one.detail,
    ...(one.documentation ? { info: () => shown(one.documentation) } : {}),
  };
}

/** Enter begins a new line until a proposal was chosen by the arrows; Tab takes the first. */
function accept(view: EditorView): boolean {
  if (completionStatus(view.state) !== "active") return false;
  if (!selectedCompletion(view.state)) moveCompletionSelection(true)(view);
  return acceptCompletion(view);
}

/** Completion, the meaning of a word under the pointer, and F12 to its definition. */
export function language(ask: Ask): Extension {
  const complete = async (context: CompletionContext): Promise<CompletionResult | null> => {
    // Proposals appear while a word is typed, and after a sign that a name follows; otherwise on request.
    if (!context.explicit && !context.matchBefore(/[A-Za-z_]\w*|[.:[{>] ?/)) return null;
    const answer = await question(ask, context.state, context.pos, "completion");
    const first = answer?.proposals[0];
    if (!answer || !first) return null;
    const { doc } = context.state;
    return {
      from: offsetOf(doc, first.from),
      to: offsetOf(doc, first.to),
      options: answer.proposals.map(completionOf),
      validFor: /^\w*$/,
    };
  };
  const hover = async (view: EditorView, at: number): Promise<Tooltip | null> => {
    const meaning = (await question(ask, view.state, at, "meaning"))?.meaning;
    if (!meaning) return null;
    const { doc } = view.state;
    return {
      pos: offsetOf(doc, meaning.from),
      end: offsetOf(doc, meaning.to),
      above: true,
      create: () => ({ dom: shown(meaning.text) }),
    };
  };
  const goToDefinition = (view: EditorView): boolean => {
    const { state } = view;
    void question(ask, state, state.selection.main.head, "definition").then((answer) => {
      if (!answer?.definition) return;
      const anchor = offsetOf(view.state.doc, answer.definition);
      view.dispatch({ selection: { anchor }, effects: EditorView.scrollIntoView(anchor, { y: "center" }) });
    });
    return true;
  };
  return [
    autocompletion({ override: [complete], maxRenderedOptions: 50, interactionDelay: 0, selectOnOpen: false }),
    hoverTooltip(hover),
    keymap.of([
      { key: shortcuts.text.accept.keys[0], run: accept },
      { key: shortcuts.text.definition.keys[0], run: goToDefinition },
    ]),
  ];
}
