import { describe, expect, it } from "vitest";
import { noteNotices } from "../../live/run/run_log";
import { NetModel, type FoldedNet } from "../../model/net/net";
import { eventKinds, EventLog, filtered, type EventKind, type LogFilter } from "../../model/run/event_log";
import json from "./words.json";

const net = new NetModel(json.net as unknown as FoldedNet, "", json.text);
const at = (name: string) => net.transitionByName.get(name)!;
const all: LogFilter = { kinds: new Set(Object.keys(eventKinds) as EventKind[]), firings: false, of: "", text: "" };
const shown = (log: EventLog, filter: Partial<LogFilter> = {}) =>
  filtered(log, { ...all, ...filter }).map((entry) => {
    const { t, kind, who, text } = log.row(entry);
    return `${t} ${kind} ${who}: ${text}`;
  });

function driven(most?: number): EventLog {
  const log = new EventLog(net, most);
  const run = ["robot.control.drive.t1", "robot.control.drive.t5", "robot.control.t_drive_2", "robot.control.ask.t1"];
  run.forEach((name, index) => log.fired([index * 10, at(name)]));
  return log;
}

describe("the log of events", () => {
  it("has the changes of behaviour with what ended the one before, and each firing if asked", () => {
    const log = driven();
    const change = "20 behaviour robot.control: goes on from drive to ask because memory.battery < parameters.tired";
    expect(shown(log)).toEqual([change]);
    expect(shown(log, { firings: true })).toEqual([
      "0 firing robot.control: calls its function drive()",
      "10 firing robot.control: ends drive because memory.battery < parameters.tired",
      change,
      "30 firing robot.control: calls its function ask()",
    ]);
    expect(log.lastTold(Infinity)?.t).toBe(20);
    expect(log.lastTold(15)).toBe(null);
  });

  it("puts later news at their time, and what it has already nowhere", () => {
    const log = driven();
    const notice = { t: 15, kind: "fault", who: "robot.control", text: "robot.control.drive: threw", level: "error" } as const;
    noteNotices(log, { notices: [notice], dropped: 3 });
    noteNotices(log, { notices: [notice], dropped: 0 });
    expect(shown(log, { kinds: new Set(["fault", "behaviour"]) }).map((row) => row.slice(0, 34))).toEqual([
      "15 fault robot.control: drive: thr",
      "20 behaviour robot.control: goes o",
    ]);
    expect(log.lost.notices).toBe(3);
    const many = Array.from({ length: 500 }, (_, index) => ({ ...notice, t: 499 - index, text: `at ${index}` }));
    noteNotices(log, { notices: many, dropped: 0 });
    const times = log.events.map(({ t }) => t);
    expect(times.length).toBe(502);
    expect(times).toEqual([...times].sort((one, other) => one - other));
  });

  it("tells emergency stops and stuck subsystems from other messages", () => {
    const log = new EventLog(net);
    const message = (text: string) => ({ t: 1, kind: "message", who: "", text, level: "error" }) as const;
    const notices = [message("EMERGENCY STOP: an operator"), message("stuck for good: a; b"), message("hello")];
    noteNotices(log, { notices, dropped: 0 });
    expect(log.events.map(({ kind }) => kind)).toEqual(["emergency", "message", "message"]);
    expect(log.stuck?.text).toBe("stuck for good: a; b");
  });

  it("is filtered by kind, by agent or subsystem, and by text", () => {
    const log = driven();
    log.add({ t: 40, kind: "message", who: "robot.sensor", text: "sees a LINE" });
    expect(shown(log, { kinds: new Set(["message"]) })).toEqual(["40 message robot.sensor: sees a LINE"]);
    expect(shown(log, { of: "robot" }).length).toBe(2);
    expect(shown(log, { of: "robot.sens" })).toEqual([]);
    expect(shown(log, { of: "robot.sensor" }).length).toBe(1);
    expect(shown(log, { text: "line" }).length).toBe(1);
    expect(shown(log, { text: "battery", firings: true }).length).toBe(2);
  });

  it("keeps so many events and firings, and counts those that are gone", () => {
    const log = new EventLog(net, 1000);
    for (let index = 0; index < 5000; index += 1) log.fired([index, at("robot.control.t_drive_2")]);
    expect(log.firings.length).toBeLessThanOrEqual(1000);
    expect(log.events.length + log.lost.events).toBe(5000);
    expect(log.firings.length + log.lost.firings).toBe(5000);
    expect(log.last).toEqual([4999, at("robot.control.t_drive_2")]);
  });
});
