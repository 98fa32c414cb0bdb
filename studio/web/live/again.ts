/** The request that repeats a run from its beginning, and shows it from some time on. */

import type { StartRequest } from "../model/protocol";

/** The default for a simulated run. */
const defaultTime = "600s";

/** at: seconds. A run that has used up its duration gets the same duration again. */
export function againFrom(request: StartRequest, at: number, paused: boolean): StartRequest {
  const end = secondsOf(request.for ?? defaultTime);
  const more = end !== null && at >= end ? { for: `${at + end}s` } : {};
  return { ...request, ...more, paused, skip_to: at };
}

/** null: no duration. */
function secondsOf(text: string): number | null {
  const found = /^\s*([\d.]+)\s*(ns|us|ms|s|min|h)\s*$/.exec(text);
  const units: Record<string, number> = { ns: 1e-9, us: 1e-6, ms: 1e-3, s: 1, min: 60, h: 3600 };
  return found ? Number(found[1]) * units[found[2]!]! : null;
}
