import type { ControlRequest, Notice, Notices } from "../../model/protocol";
import type { EventKind, EventLog, LogEvent } from "../../model/run/event_log";
import type { Emergency } from "../emergency";
import type { Runner } from "./runner";
import type { Connection } from "../stream/connection";
import type { Track } from "./track";

/** The operator's command in words; null: it is not worth an entry, such as a step. */
function commandText({ command, path = "", text, value }: ControlRequest): { who: string; text: string } | null {
  const here = "from this page";
  switch (command) {
    case "pause":
      return { who: "", text: `the run is paused ${here}` };
    case "resume":
      return { who: "", text: `the run is told to go on ${here}` };
    case "stop":
      return { who: "", text: `the run is stopped ${here}` };
    case "speed":
      return { who: "", text: `the run gets the speed ${value === 0 ? "as fast as possible" : `${value} ×`} ${here}` };
    case "set":
      return { who: path.slice(0, Math.max(0, path.lastIndexOf("."))), text: `${path} = ${text} is set ${here}` };
    default:
      return null;
  }
}

/** The log has the commands that the run has taken. */
export function noteCommand(track: Track | null, request: ControlRequest): void {
  const said = commandText(request);
  if (said) track?.log.add({ t: track.end, kind: "operator", ...said });
}

const kinds: Record<Notice["kind"], EventKind> = {
  message: "message",
  fault: "fault",
  overrun: "overrun",
  safe: "device",
  parameter: "parameter",
  end: "run",
};

/** The runtime says in a message that an emergency stop begins or ends (watch/emergency_watch.cpp). */
const isEmergency = /^(EMERGENCY STOP|the emergency stop is over)/;

/** A notice of a recording as an entry of the log. The text of a fault begins with the path of its subsystem. */
function eventOf({ t, kind, who, text, level }: Notice): LogEvent {
  const emergency = kind === "message" && isEmergency.test(text);
  return {
    t,
    kind: emergency ? "emergency" : kinds[kind],
    who,
    text: who && text.startsWith(`${who}.`) ? text.slice(who.length + 1) : text,
    ...(level === "info" ? {} : { level }),
  };
}

/** Puts the notices of a recording into the log. Those that are there already are not added again. */
export function noteNotices(log: EventLog, { notices, dropped }: Notices): void {
  log.addOnce(notices.map(eventOf));
  log.lost.notices = Math.max(log.lost.notices, dropped);
}

/** Writes into the log of the run that is followed what is no firing: notices, pauses, and commands of operators. */
export class RunLog {
  constructor(
    private readonly runner: Runner,
    connection: Connection,
    emergency: Emergency,
  ) {
    connection.on("notices", (event) => {
      if (event.run === runner.store.get().run && runner.track) noteNotices(runner.track.log, event);
    });
    runner.onInfo(({ notices }) => runner.track && noteNotices(runner.track.log, notices));
    let { state } = runner.store.get();
    runner.store.subscribe(() => {
      const now = runner.store.get();
      if (now.state === "paused" && state !== "paused")
        this.note("run", now.why ? `the run is paused: ${now.why}` : "the run is paused");
      if (now.state === "running" && state === "paused") this.note("run", "the run goes on");
      state = now.state;
    });
    let { asked } = emergency.store.get();
    emergency.store.subscribe(() => {
      const now = emergency.store.get();
      if (now.asked !== asked && now.asked !== null)
        this.note(
          "emergency",
          now.asked === "stop" ? "emergency stop from this page" : "reset of an emergency stop from this page",
        );
      asked = now.asked;
    });
  }

  private note(kind: EventKind, text: string): void {
    const { track } = this.runner;
    track?.log.add({ t: track.end, kind, who: "", text });
  }
}
