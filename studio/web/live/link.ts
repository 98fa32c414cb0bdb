import { panelNames, viewNames, type ViewState } from "../model/view_state";

/** The moment of a recording, in nanoseconds of the run's clock. */
export interface Moment {
  recording: string;
  time: number;
}

/** The part of the page's state that its address holds: `#view=structure&at=robot.control&recording=run.trec&t=1.5`. */
export interface Linked extends Partial<Pick<ViewState, "view" | "panel" | "selected">> {
  moment?: Moment;
}

/** The part of an address after the #, without unknown keys. */
export function readLink(hash: string): Linked {
  const given = new URLSearchParams(hash.replace(/^#/, ""));
  const view = viewNames.find((one) => one === given.get("view"));
  const panel = panelNames.find((one) => one === given.get("panel"));
  const selected = given.get("at");
  const recording = given.get("recording");
  const seconds = Number(given.get("t") ?? "0");
  const moment = recording ? { recording, time: Number.isFinite(seconds) ? Math.round(seconds * 1e9) : 0 } : undefined;
  return {
    ...(view ? { view } : {}),
    ...(panel ? { panel } : {}),
    ...(selected ? { selected } : {}),
    ...(moment ? { moment } : {}),
  };
}

export function linkTo({
  view,
  panel,
  selected,
  moment,
}: Linked & Required<Pick<Linked, "view" | "panel" | "selected">>): string {
  const link = new URLSearchParams({ view, panel });
  if (selected) link.set("at", selected);
  if (moment) {
    link.set("recording", moment.recording);
    link.set("t", String(Number((moment.time / 1e9).toFixed(9))));
  }
  return `#${link.toString()}`;
}
