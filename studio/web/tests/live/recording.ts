import type { Recording } from "../../model/protocol";

/** The answer of the server with these members, and otherwise only the consequences of its firings. */
export function recordingOf(known: Partial<Recording> & Pick<Recording, "firings">): Recording {
  const { firings } = known;
  return {
    net_hash: "",
    system: "line_follower",
    subsystems: [],
    marking: null,
    dropped: 0,
    values: {},
    arrivals: {},
    path: [],
    notices: { notices: [], dropped: 0 },
    track: null,
    scene: null,
    lacks_beginning: false,
    cut: false,
    truncated: false,
    first: firings[0]?.[0] ?? null,
    last: firings.at(-1)?.[0] ?? null,
    total: firings.length,
    ...known,
  };
}
