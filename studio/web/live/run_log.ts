import type { ControlRequest } from "../model/protocol";
import type { Track } from "./track";

/** The operator's command in words; null: it is not worth an entry, such as a step. */
function commandText({ command, path = "", text, value }: ControlRequest): { who: string; text: string } | null {
  const here = "from this page";
  switch (command) {
    case "pause":
      return { who: "", text: `is paused ${here}` };
    case "resume":
      return { who: "", text: `is told to go on ${here}` };
    case "stop":
      return { who: "", text: `is stopped ${here}` };
    case "speed":
      return { who: "", text: `gets the speed ${value === 0 ? "as fast as possible" : `${value} ×`} ${here}` };
    case "set":
      return { who: path.slice(0, Math.max(0, path.lastIndexOf("."))), text: `gets ${path} = ${text} ${here}` };
    default:
      return null;
  }
}

/** The log has the commands that the run has taken. */
export function noteCommand(track: Track | null, request: ControlRequest): void {
  const said = commandText(request);
  if (said) track?.log.add({ t: track.end, kind: "operator", ...said });
}

/** The log has the commands to everything that drives devices. */
export function noteEmergency(track: Track | null, text: string): void {
  track?.log.add({ t: track.end, kind: "emergency", who: "", text });
}
