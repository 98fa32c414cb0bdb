import { useStore, useStudio } from "../hooks/use";
import type { Pane } from "../live/scene";

export const stateTitles = {
  idle: "",
  building: "Building the controller…",
  running: "Running",
  paused: "Paused",
  ended: "Ended",
  failed: "Failed",
};

/** The reason for the end of a run in words; other reasons are words already. */
export const reason = (why: string): string => ({ duration: "the time asked for is over" })[why] ?? why;

/** The content of a pane in a few words. */
export function usePaneTitle(): (pane: Pane) => string {
  const studio = useStudio();
  const state = useStore(studio.runner.store, (all) => all.state);
  return (pane) => pane.replay?.name ?? (pane.id === "run" ? `Run: ${stateTitles[state].toLowerCase()}` : "The text");
}
