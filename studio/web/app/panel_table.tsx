import { lazy, type ComponentType } from "react";
import { useHasWorld, useStore, useStudio } from "../hooks/use";
import type { Places } from "../model/dock/ready_layouts";
import type { PanelName } from "../model/view_state";
import { InspectPanel } from "../panels/inspect_panel";
import { PlotPanel, usePlot } from "../panels/plots/plot_panel";
import { Timelines, ValueLists, Worlds } from "../panels/plots/watch";
import { Narratives } from "../panels/narratives";
import { PlayPanel } from "../panels/run/play_panel";
import { RecordingsPanel } from "../panels/run/recordings_panel";
import { RunPanel } from "../panels/run/run_panel";
import { Scrolled } from "../panels/scrolled";
import { VerifyPanel } from "../panels/verify_panel";
import { Centre } from "./centre";

const CodePanel = lazy(() => import("../panels/forms/code_panel"));
const EventPanel = lazy(() => import("../panels/events/event_panel"));
const TimingPanel = lazy(() => import("../panels/timing/timing_panel"));
const TextPane = lazy(() => import("../panels/text/text_pane"));

export interface Panel extends Places {
  name: PanelName;
  component: ComponentType;
  /** Whether its component stays while another tab is in front of it. */
  stays?: boolean;
  /** A hook: whether it has something to show. A panel that has not is not on the page. */
  useContent?: () => boolean;
}

/** Whether a run or a recording is shown. */
const useTrack = () => useStore(useStudio().scene.store, ({ panes }) => panes.some(({ track }) => track !== null));

/** The same in a project with a simulated world. */
function useWorld(): boolean {
  const [track, world] = [useTrack(), useHasWorld()];
  return track && world;
}

/** Whether a verification has found a run that violates a property. */
const useNarrative = () =>
  useStore(useStudio().verifier.store, ({ verdicts }) => verdicts.some((one) => one.narrative && one.verdict === "violated"));

const scrolled = (Content: ComponentType) =>
  function ScrolledPanel() {
    return (
      <Scrolled>
        <Content />
      </Scrolled>
    );
  };

const Element = scrolled(InspectPanel);
const Verify = scrolled(VerifyPanel);
const Play = scrolled(PlayPanel);
const Run = scrolled(RunPanel);
const Recordings = scrolled(RecordingsPanel);

/** All panels of the page, in the order of their tabs: `edit`, `debug` and `operate` say where they stand in these layouts. */
export const panelTable: readonly Panel[] = [
  { name: "drawing", title: "Drawing", component: Centre, stays: true, edit: "centre", debug: "centre", operate: "centre" },
  {
    name: "text",
    title: "Text",
    component: TextPane,
    stays: true,
    edit: "left",
    debug: "left",
    operate: "left",
    closed: ["operate"],
  },
  { name: "code", title: "C++", component: CodePanel, edit: "left", debug: "left", operate: "left", closed: ["operate"] },
  {
    name: "inspect",
    title: "Element",
    component: Element,
    edit: "right",
    debug: "right",
    operate: "middle",
    closed: ["operate"],
  },
  { name: "verify", title: "Verify", component: Verify, edit: "right", debug: "right", operate: "right", closed: ["operate"] },
  {
    name: "timing",
    title: "Timing",
    component: scrolled(TimingPanel),
    edit: "right",
    debug: "right",
    operate: "right",
    closed: ["edit", "debug", "operate"],
  },
  { name: "play", title: "Play", component: Play, edit: "right", debug: "right", operate: "right", closed: ["operate"] },
  { name: "run", title: "Run", component: Run, edit: "right", debug: "right", operate: "right" },
  { name: "recordings", title: "Recordings", component: Recordings, edit: "right", debug: "right", operate: "right" },
  {
    name: "narrative",
    title: "Narrative",
    component: Narratives,
    useContent: useNarrative,
    edit: "below",
    debug: "below",
    operate: "below",
    closed: ["edit", "debug", "operate"],
  },
  {
    name: "timeline",
    title: "Timeline",
    component: Timelines,
    useContent: useTrack,
    edit: "below",
    debug: "below",
    operate: "below",
  },
  {
    name: "events",
    title: "Events",
    component: EventPanel,
    useContent: useTrack,
    edit: "below",
    debug: "corner",
    operate: "below",
  },
  {
    name: "values",
    title: "Values",
    component: ValueLists,
    useContent: useTrack,
    edit: "middle",
    debug: "middle",
    operate: "corner",
  },
  { name: "plots", title: "Plots", component: PlotPanel, useContent: usePlot, edit: "below", debug: "below", operate: "below" },
  { name: "world", title: "World", component: Worlds, useContent: useWorld, edit: "end", debug: "end", operate: "end" },
];
