import { useEffect, useState } from "react";
import type { Track } from "../live/track";
import { shown, type Samples } from "../model/series";
import { count } from "../model/sorted";
import { Painted, type Colours, type Size } from "./painted";

/** Every value by its path, with its recent course; a click shows a large plot. */
export function ValueList({ track, seconds, none }: { track: Track; seconds: number; none: string }) {
  const [, look] = useState(0);
  const [plotted, setPlotted] = useState<string | null>(null);
  useEffect(() => {
    const timer = setInterval(() => look((at) => at + 1), 150);
    return () => clearInterval(timer);
  }, []);
  const { paths } = track.series;
  const large = plotted === null ? undefined : track.series.samples.get(plotted);
  if (paths.length === 0) return <p className="faint pad">{none}</p>;
  return (
    <div className="value-list">
      {large && (
        <div className="large-plot">
          <Painted
            label={`Plot of ${plotted}`}
            draw={(context, size, colours) => plot(context, size, colours, large, track.now, seconds, true)}
            of={() => `${track.id} ${track.now} ${plotted} ${seconds}`}
          />
        </div>
      )}
      <ul>
        {paths.slice(0, 200).map((path) => {
          const samples = track.series.samples.get(path);
          return (
            <li key={path}>
              <button aria-pressed={plotted === path} onClick={() => setPlotted(plotted === path ? null : path)} title={path}>
                <span className="path">{path}</span>
                <span className="now">{shown(track.series.at(path, track.now))}</span>
                <span className="spark">
                  {samples && (
                    <Painted
                      every={200}
                      label=""
                      draw={(context, size, colours) => plot(context, size, colours, samples, track.now, seconds, false)}
                      of={() => `${track.id} ${track.now} ${seconds}`}
                    />
                  )}
                </span>
              </button>
            </li>
          );
        })}
      </ul>
    </div>
  );
}

function plot(
  context: CanvasRenderingContext2D,
  size: Size,
  colours: Colours,
  { times, values }: Samples,
  now: number,
  seconds: number,
  large: boolean,
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
  const room = large ? 12 : 2;
  const x = (time: number) => ((time - start) / (now - start)) * size.width;
  const y = (value: number) => size.height - room - ((value - low) / (high - low)) * (size.height - 2 * room);
  context.strokeStyle = colours.accent;
  context.lineWidth = large ? 1.5 : 1;
  context.beginPath();
  for (let at = first; at < end; at += 1) {
    // A value holds until the next one, so it is drawn in steps and not in slopes.
    if (at > first) context.lineTo(x(times[at]!), y(values[at - 1]!));
    context.lineTo(x(times[at]!), y(values[at]!));
  }
  context.lineTo(size.width, y(values[end - 1]!));
  context.stroke();
  if (!large) return;
  context.font = "10px system-ui, 'DejaVu Sans', sans-serif";
  context.fillStyle = colours.faint;
  context.fillText(shown(high), 4, 9);
  context.fillText(shown(low), 4, size.height - 3);
}
