/** The state of the page that is no data. */

export const viewNames = ["net", "structure", "fleet"] as const;
export type View = (typeof viewNames)[number];
export const panelNames = [
  "drawing",
  "text",
  "inspect",
  "verify",
  "timing",
  "play",
  "run",
  "recordings",
  "code",
  "narrative",
  "timeline",
  "events",
  "values",
  "plots",
  "world",
] as const;
export type PanelName = (typeof panelNames)[number];

export interface ViewState {
  view: View;
  panel: PanelName;
  text: boolean;
  theme: "light" | "dark";
  /** Whether a map is drawn while a part of the structure is out of sight; null: if there is much space. */
  map: boolean | null;
  /** Path of the selected element. */
  selected: string | null;
  /** Line of the specification to show in the text pane, with a number that makes each request new. */
  line: { line: number; request: number } | null;
  /** Path to fly to, with a number that makes each request new. */
  flight: { path: string; request: number } | null;
  /** Path of an element that the drawing of the structure is to come near to; null: it has done so. */
  near: string | null;
  /** Pages that the user folded or unfolded, against the rule. */
  folds: ReadonlyMap<string, boolean>;
  searching: boolean;
}
