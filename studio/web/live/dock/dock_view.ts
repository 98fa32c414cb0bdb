import type { PanelName, ViewState } from "../../model/view_state";
import type { Dock } from "./dock";
import type { Store } from "../store";

/**
 * Keeps the panel of the address and the button of the text in step with the dock. A panel that a part of the page asks for by
 * `view.set({ panel })` is opened; the panel that the user chooses becomes `view.panel`.
 */
export function followDock(view: Store<ViewState>, dock: Dock): void {
  let known = { panel: view.get().panel, text: view.get().text };
  dock.store.subscribe(() => {
    const { shown, chosen, seen } = dock.store.get();
    if (!shown) return;
    known = { panel: chosen as PanelName, text: seen.includes("text") };
    const now = view.get();
    if (now.panel !== known.panel || now.text !== known.text) view.set(known);
  });
  view.subscribe(() => {
    const { panel, text } = view.get();
    const before = known;
    if (!dock.store.get().shown || (panel === before.panel && text === before.text)) return;
    known = { panel, text };
    if (panel !== before.panel) dock.open(panel);
    else if (text) dock.open("text");
    else dock.close("text");
  });
}
