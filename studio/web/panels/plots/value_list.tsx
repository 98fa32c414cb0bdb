import { useEffect, useState } from "react";
import { useStore, useStudio } from "../../hooks/use";
import type { Track } from "../../live/run/track";
import { curveOf } from "../../model/plots/plotted_runs";
import { isSame, keyOf, titleOf, type Signal } from "../../model/plots/signals";
import { valueAt } from "../../model/plots/statistics";
import { csvOf } from "../../model/run/csv";
import { shown, type Samples } from "../../model/run/series";
import { count } from "../../model/sorted";
import { PathText } from "../../canvas/path_text";
import { Painted, type Colours, type Size } from "../world/painted";
import { dragged } from "./plot_panel";
import { save } from "./save_plot";

interface ValueListProps {
  track: Track;
  seconds: number;
  none: string;
}

/** Rows that are shown at once. */
const most = 200;

/** Every value by its path, with its recent curve. A click, or dragging, adds it to the plot. */
export function ValueList({ track, seconds, none }: ValueListProps) {
  const studio = useStudio();
  const [, look] = useState(0);
  const [wanted, setWanted] = useState("");
  const signals = useStore(studio.plots.store, ({ plots, active }) => plots[active]!.signals);
  useEffect(() => {
    const timer = setInterval(() => look((at) => at + 1), 150);
    return () => clearInterval(timer);
  }, []);
  const { paths } = track.series;
  if (paths.length === 0) return <p className="faint pad">{none}</p>;
  const inputs = track.arrivals.paths;
  const all: Signal[] = [
    ...paths.map((path): Signal => ({ kind: "value", path })),
    ...inputs.flatMap((path): Signal[] => [
      { kind: "age", path },
      { kind: "rate", path },
    ]),
    ...track.timeline.lanes.map(({ path }): Signal => ({ kind: "behaviour", path })),
  ];
  const needle = wanted.trim().toLowerCase();
  const listed = all.filter((one) => titleOf(one).toLowerCase().includes(needle));
  const visible = listed.slice(0, most);
  const numbers = () =>
    listed.flatMap((one) => {
      const curve = curveOf(track, one, 0);
      return curve ? [{ path: titleOf(one), samples: curve.samples }] : [];
    });
  const part = (kinds: readonly string[], title: string, hint: string) => {
    const rows = visible.filter(({ kind }) => kinds.includes(kind));
    if (rows.length === 0) return null;
    return (
      <>
        {title && (
          <h2 className="value-part" title={hint}>
            {title}
          </h2>
        )}
        <ul>
          {rows.map((one) => (
            <ValueRow
              key={keyOf(one)}
              signal={one}
              track={track}
              seconds={seconds}
              plotted={signals.some((each) => isSame(each, one))}
            />
          ))}
        </ul>
      </>
    );
  };
  return (
    <div className="value-list">
      <div className="value-tools">
        <input
          type="text"
          aria-label="Values whose path contains"
          placeholder="filter"
          value={wanted}
          onChange={(event) => setWanted(event.target.value)}
        />
        <button
          className="quiet"
          title="The listed numbers over time, as a table"
          onClick={() => save("values.csv", new Blob([csvOf(numbers())], { type: "text/csv" }))}
        >
          CSV
        </button>
      </div>
      {signals.length === 0 && <p className="faint pad">A click on a row plots it over time.</p>}
      {part(["value"], "", "")}
      {part(
        ["age", "rate"],
        "Age and rate of inputs",
        "Age: the time since the sender wrote the value that the input holds. Rate: new values in the last second.",
      )}
      {part(["behaviour"], "Behaviours", "The behaviour that a subsystem runs, as a band over time")}
      {listed.length > most && <p className="faint pad">and {listed.length - most} more: filter them</p>}
    </div>
  );
}

function ValueRow({ signal, track, seconds, plotted }: { signal: Signal; track: Track; seconds: number; plotted: boolean }) {
  const studio = useStudio();
  const title = titleOf(signal);
  const curve = curveOf(track, signal, 0);
  return (
    <li>
      <button
        aria-pressed={plotted}
        draggable
        title={`${title}: ${plotted ? "remove from" : "add to"} the plot (click, or drag it there)`}
        onClick={() => {
          studio.plots.toggle(signal);
          if (!plotted) studio.dock.open("plots");
        }}
        onDragStart={(event) => {
          event.dataTransfer.setData(dragged, JSON.stringify(signal));
          event.dataTransfer.effectAllowed = "copy";
        }}
      >
        <span className="path">
          <PathText of={title} />
        </span>
        <span className="now">{nowOf(signal, track, curve?.samples)}</span>
        <span className="spark">
          {curve && (
            <Painted
              every={200}
              label=""
              draw={(context, size, colours) => spark(context, size, colours, curve.samples, track.now, seconds, curve.course)}
              of={() => `${track.id} ${track.now} ${track.series.size} ${seconds}`}
            />
          )}
        </span>
      </button>
    </li>
  );
}

function nowOf(signal: Signal, track: Track, samples: Samples | undefined): string {
  if (signal.kind === "value") return shown(track.series.at(signal.path, track.now));
  if (signal.kind === "behaviour") {
    const lane = track.timeline.lanes.find(({ path }) => path === signal.path);
    return lane?.segments[count(lane.segments, ({ start }) => start <= track.now) - 1]?.behaviour ?? "";
  }
  const value = samples ? valueAt(samples, track.now, signal.kind === "age" ? "slope" : "hold") : NaN;
  return Number.isNaN(value) ? "" : `${shown(value)} ${signal.kind === "age" ? "s" : "/s"}`;
}

function spark(
  context: CanvasRenderingContext2D,
  size: Size,
  colours: Colours,
  { times, values }: Samples,
  now: number,
  seconds: number,
  course: "hold" | "slope",
): void {
  const start = now - seconds * 1e9;
  const first = Math.max(0, count(times, (time) => time < start) - 1);
  const end = count(times, (time) => time <= now);
  let [low, high] = [Infinity, -Infinity];
  for (let at = first; at < end; at += 1) {
    low = Math.min(low, values[at]! || (Number.isNaN(values[at]!) ? Infinity : 0));
    high = Math.max(high, values[at]! || (Number.isNaN(values[at]!) ? -Infinity : 0));
  }
  if (low > high) return;
  if (high - low < 1e-9) [low, high] = [low - 0.5, high + 0.5];
  const room = 2;
  const x = (time: number) => ((time - start) / (now - start)) * size.width;
  const y = (value: number) => size.height - room - ((value - low) / (high - low)) * (size.height - 2 * room);
  context.strokeStyle = colours.accent;
  context.lineWidth = 1;
  context.beginPath();
  let before = NaN;
  for (let at = first; at < end; at += 1) {
    const value = values[at]!;
    // A value holds until the next one, so it is drawn in steps and not in slopes; a gap stays one.
    if (!Number.isNaN(before) && course === "hold") context.lineTo(x(times[at]!), y(before));
    if (!Number.isNaN(value) && Number.isNaN(before)) context.moveTo(x(times[at]!), y(value));
    else if (!Number.isNaN(value)) context.lineTo(x(times[at]!), y(value));
    before = value;
  }
  if (!Number.isNaN(before)) context.lineTo(size.width, y(before));
  context.stroke();
}
