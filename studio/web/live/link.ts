import type { PanelName, View, ViewState } from "./studio";

/** What an address says: `#view=structure&panel=verify&at=robot.control`. */
export type Linked = Partial<Pick<ViewState, "view" | "panel" | "selected">>;

const views: readonly View[] = ["net", "structure"];
const panels: readonly PanelName[] = ["inspect", "verify", "play", "run", "recordings"];

/** The part of an address after the #, with what is not known left out. */
export function readLink(hash: string): Linked {
  const given = new URLSearchParams(hash.replace(/^#/, ""));
  const view = views.find((one) => one === given.get("view"));
  const panel = panels.find((one) => one === given.get("panel"));
  const selected = given.get("at");
  return { ...(view ? { view } : {}), ...(panel ? { panel } : {}), ...(selected ? { selected } : {}) };
}

export function linkTo({ view, panel, selected }: Required<Linked>): string {
  return `#${new URLSearchParams({ view, panel, ...(selected ? { at: selected } : {}) }).toString()}`;
}
