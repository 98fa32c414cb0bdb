import { useVirtualizer } from "@tanstack/react-virtual";
import { useEffect, useRef, useState, type KeyboardEvent } from "react";
import { useStore } from "../../hooks/use";
import type { Replay } from "../../live/run/replay";
import { Store } from "../../live/store";
import { breakable } from "../../model/net/labels";
import { eventKinds, type EventLog, type LogEvent, type LogRow } from "../../model/run/event_log";
import type { FiringRow } from "../../model/protocol";
import { count } from "../../model/sorted";
import { clock } from "../plots/clock";

type Entry = LogEvent | FiringRow;
const timeOf = (entry: Entry) => ("kind" in entry ? entry.t : entry[0]);

const still = new Store({ time: Infinity });
const kindTitle = (kind: LogRow["kind"]) => (kind === "firing" ? "Firing" : eventKinds[kind]);

/**
 * The entries, drawn as far as they can be seen. Arrow keys move the chosen one; Enter and a click lead to its place and its
 * time.
 */
export function EventList({
  log,
  rows,
  replay,
  go,
}: {
  log: EventLog;
  rows: readonly Entry[];
  replay: Replay | null;
  go: (row: LogRow) => void;
}) {
  const frame = useRef<HTMLDivElement>(null);
  const [chosen, setChosen] = useState<Entry | null>(null);
  const time = useStore<{ time: number }, number>(
    replay ? (replay.store as unknown as Store<{ time: number }>) : still,
    (all) => all.time,
  );
  const passed = count(rows, (entry) => timeOf(entry) <= time);
  const list = useVirtualizer({
    count: rows.length,
    getScrollElement: () => frame.current,
    estimateSize: () => 24,
    overscan: 12,
  });
  const [atEnd, setAtEnd] = useState(true);
  // A log that grows is followed at its end; that of a recording, at its time.
  useEffect(() => {
    if (replay || !atEnd || rows.length === 0) return;
    list.scrollToIndex(rows.length - 1, { align: "end" });
  }, [rows, replay, atEnd, list]);
  useEffect(() => {
    if (replay && passed > 0) list.scrollToIndex(passed - 1, { align: "auto" });
  }, [replay, passed, list]);
  const at = chosen === null ? -1 : rows.indexOf(chosen);
  const move = (to: number) => {
    const next = Math.min(rows.length - 1, Math.max(0, to));
    setChosen(rows[next] ?? null);
    setAtEnd(false);
    list.scrollToIndex(next, { align: "auto" });
  };
  const key = (event: KeyboardEvent) => {
    const from = at < 0 ? Math.max(0, passed - 1) : at;
    const moves: Record<string, number> = {
      ArrowDown: at < 0 ? from : from + 1,
      ArrowUp: at < 0 ? from : from - 1,
      PageDown: from + 10,
      PageUp: from - 10,
      Home: 0,
      End: rows.length - 1,
    };
    const to = moves[event.key];
    if (to !== undefined) move(to);
    else if (event.key === "Enter" && at >= 0) go(log.row(rows[at]!));
    else return;
    event.preventDefault();
  };
  return (
    <div
      ref={frame}
      className="event-list"
      role="listbox"
      tabIndex={0}
      aria-label="Events"
      aria-activedescendant={at >= 0 ? `event-${at}` : undefined}
      onKeyDown={key}
      onScroll={({ currentTarget: { scrollTop, scrollHeight, clientHeight } }) =>
        setAtEnd(scrollHeight - scrollTop - clientHeight < 40)
      }
    >
      {rows.length === 0 && <p className="pane-empty">No such events yet.</p>}
      <div style={{ height: list.getTotalSize(), position: "relative" }} role="presentation">
        {list.getVirtualItems().map(({ index, start }) => {
          const row = log.row(rows[index]!);
          const choose = () => {
            setChosen(rows[index]!);
            go(row);
          };
          return (
            <div
              key={index}
              id={`event-${index}`}
              ref={list.measureElement}
              data-index={index}
              role="option"
              aria-selected={index === at}
              aria-setsize={rows.length}
              aria-posinset={index + 1}
              className={`event ${row.kind} ${row.level}${index >= passed ? " future" : ""}${replay && index === passed - 1 ? " now" : ""}`}
              style={{ transform: `translateY(${start}px)` }}
              onClick={choose}
            >
              <span className="at">{clock(row.t)}</span>
              <span className="kind">{kindTitle(row.kind)}</span>
              <span className="text">
                {row.who && <span className="who">{breakable(row.who)}</span>} {breakable(row.text)}
              </span>
            </div>
          );
        })}
      </div>
    </div>
  );
}
