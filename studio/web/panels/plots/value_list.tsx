import { useEffect, useRef, useState } from "react";
import { useStructure } from "../../hooks/use_structure";
import type { Track } from "../../live/track";
import { csvOf } from "../../model/run/csv";
import { shown, type Samples } from "../../model/run/series";
import { count } from "../../model/sorted";
import { unitOf } from "../../model/text/units";
import { Painted, type Colours, type Size } from "../world/painted";
import { Plot, type Cursor } from "./plot";

interface ValueListProps {
  track: Track;
  /** The run beside it, whose values are drawn in the plots, too. */
  beside: Track | null;
  seconds: number;
  none: string;
}

/** Every value by its path, with its recent curve. A click pins a plot of it, or removes it. */
export function ValueList({ track, beside, seconds, none }: ValueListProps) {
  const [, look] = useState(0);
  const [pinned, setPinned] = useState<readonly string[]>([]);
  const [wanted, setWanted] = useState("");
  const cursor = useRef<Cursor>({ time: null });
  const structure = useStructure();
  useEffect(() => {
    const timer = setInterval(() => look((at) => at + 1), 150);
    return () => clearInterval(timer);
  }, []);
  const { paths } = track.series;
  if (paths.length === 0) return <p className="faint pad">{none}</p>;
  const toggle = (path: string) => setPinned(pinned.includes(path) ? pinned.filter((one) => one !== path) : [...pinned, path]);
  const listed = paths.filter((path) => path.toLowerCase().includes(wanted.trim().toLowerCase()));
  const numbers = (pinned.length > 0 ? pinned : listed).flatMap((path) => {
    const samples = track.series.samples.get(path);
    return samples ? [{ path, samples }] : [];
  });
  return (
    <div className="value-list">
      {pinned.map((path) => (
        <Plot
          key={path}
          path={path}
          unit={unitOf(structure, path)}
          track={track}
          beside={beside}
          seconds={seconds}
          cursor={cursor.current}
          onClose={() => toggle(path)}
        />
      ))}
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
          title={pinned.length > 0 ? "The plotted values over time, as a table" : "The listed numbers over time, as a table"}
          onClick={() => download(csvOf(numbers))}
        >
          CSV
        </button>
      </div>
      <ul>
        {listed.slice(0, 200).map((path) => {
          const samples = track.series.samples.get(path);
          return (
            <li key={path}>
              <button aria-pressed={pinned.includes(path)} onClick={() => toggle(path)} title={path}>
                <span className="path">{path}</span>
                <span className="now">{shown(track.series.at(path, track.now))}</span>
                <span className="spark">
                  {samples && (
                    <Painted
                      every={200}
                      label=""
                      draw={(context, size, colours) => spark(context, size, colours, samples, track.now, seconds)}
                      of={() => `${track.id} ${track.now} ${seconds}`}
                    />
                  )}
                </span>
              </button>
            </li>
          );
        })}
      </ul>
      {listed.length > 200 && <p className="faint pad">and {listed.length - 200} more: filter them</p>}
    </div>
  );
}

function download(text: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type: "text/csv" }));
  link.download = "values.csv";
  link.click();
  URL.revokeObjectURL(link.href);
}

function spark(
  context: CanvasRenderingContext2D,
  size: Size,
  colours: Colours,
  { times, values }: Samples,
  now: number,
  seconds: number,
): void {
  const start = now - seconds * 1e9;
  const first = Math.max(0, count(times, (time) => time < start) - 1);
  const end = count(times, (time) => time <= now);
  let [low, high] = [Infinity, -Infinity];
  for (let at = first; at < end; at += 1) {
    low = Math.min(low, values[at]!);
    high = Math.max(high, values[at]!);
  }
  if (low > high) return;
  if (high - low < 1e-9) [low, high] = [low - 0.5, high + 0.5];
  const room = 2;
  const x = (time: number) => ((time - start) / (now - start)) * size.width;
  const y = (value: number) => size.height - room - ((value - low) / (high - low)) * (size.height - 2 * room);
  context.strokeStyle = colours.accent;
  context.lineWidth = 1;
  context.beginPath();
  for (let at = first; at < end; at += 1) {
    // A value holds until the next one, so it is drawn in steps and not in slopes.
    if (at > first) context.lineTo(x(times[at]!), y(values[at - 1]!));
    context.lineTo(x(times[at]!), y(values[at]!));
  }
  context.lineTo(size.width, y(values[end - 1]!));
  context.stroke();
}
