import { useEffect, useState } from "react";
import { useStore, useStudio } from "../../hooks/use";
import type { RunnerState } from "../../live/run/runner_state";
import { activeTransitions } from "../../model/net/game";
import { stuckText } from "../../model/run/event_log";
import { reason } from "../pane_title";

/** The state of what the line shows: a word, and a colour with a sign of its own. */
export interface LineState {
  tone: "building" | "running" | "paused" | "stuck" | "failed" | "emergency" | "ended";
  word: string;
  /** The reason in words; may be empty. */
  why: string;
}

const look_ms = 1000;

/**
 * Why the run that this page follows cannot go on: nothing can fire, whatever conditions say; or the runtime has found
 * that some subsystems wait for each other for ever. Empty: it can.
 */
function useStuck(): string {
  const { runner } = useStudio();
  const { state, kind, run } = useStore(runner.store, (all) => all);
  const [stuck, setStuck] = useState("");
  const watched = (state === "running" || state === "paused") && kind !== "deployment";
  useEffect(() => {
    setStuck("");
    if (!watched) return;
    let before = -1;
    const timer = setInterval(() => {
      const { track, stage } = runner;
      if (!track) return;
      const stands = track.firings === before && track.firings > 0;
      before = track.firings;
      const dead = stands && activeTransitions(track.net, stage.marking).length === 0;
      setStuck(track.log.stuck?.text ?? (dead ? "nothing can fire" : ""));
    }, look_ms);
    return () => clearInterval(timer);
  }, [runner, watched, run]);
  return stuck;
}

/** The reason of the emergency stop of the system of this page; null: there is none. */
function useEmergency(): string | null {
  const studio = useStudio();
  const name = useStore(studio.project, (all) => all.project?.name);
  return useStore(
    studio.emergency.store,
    ({ controllers }) => controllers.find(({ system, emergency }) => system === name && emergency !== null)?.emergency ?? null,
  );
}

const words: Record<RunnerState["state"], LineState> = {
  idle: { tone: "ended", word: "", why: "" },
  building: { tone: "building", word: "Building", why: "" },
  running: { tone: "running", word: "Running", why: "" },
  paused: { tone: "paused", word: "Paused", why: "" },
  ended: { tone: "ended", word: "Ended", why: "" },
  failed: { tone: "failed", word: "Failed", why: "" },
};

export function useRunState(): LineState {
  const { runner } = useStudio();
  const { state, kind, why } = useStore(runner.store, (all) => all);
  const stuck = useStuck();
  const emergency = useEmergency();
  const goesOn = state === "running" || state === "paused";
  if (goesOn && kind !== "simulate" && emergency !== null) return { tone: "emergency", word: "Emergency stop", why: emergency };
  if (goesOn && stuck) return { tone: "stuck", word: "Stuck", why: stuck };
  if (why.includes(stuckText)) return { tone: "stuck", word: "Stuck", why: reason(why) };
  return { ...words[state], why: reason(why) };
}
