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

/** Why a run ended, in words; what is not here is words already. */
export const reason = (why: string): string => ({ duration: "the time asked for is over" })[why] ?? why;

/** What a pane shows, in few words. */
export function usePaneTitle(): (pane: Pane) => string {
  const studio = useStudio();
  const state = useStore(studio.runner.store, (all) => all.state);
  return (pane) => pane.replay?.name ?? (pane.id === "run" ? `Run: ${stateTitles[state].toLowerCase()}` : "The text");
}
