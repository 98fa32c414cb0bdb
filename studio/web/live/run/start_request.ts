import type { StartRequest } from "../../model/protocol";
import type { Wishes } from "./runner_state";

/** The number in a field; NaN: it holds none. */
export const numberIn = (text: string) => (text.trim() === "" ? NaN : Number(text));

/** The request for a run as the form asks for it. `tracks`: the floors that its world can have. */
export function startRequest(
  { kind, track, time, seed, speed, all }: Wishes,
  tracks: readonly string[],
  paused: boolean,
): StartRequest {
  const simulated = kind === "simulate";
  return {
    kind: simulated ? "simulate" : "run",
    paused,
    ...(time ? { for: time } : {}),
    ...(tracks.includes(track) ? { track } : {}),
    ...(all ? { values: "all" as const } : {}),
    ...(simulated ? { seed: numberIn(seed), speed: numberIn(speed) } : {}),
  };
}
