import { useRef } from "react";
import type { Track } from "../../live/track";
import { shown, type Samples } from "../../model/run/series";
import { count } from "../../model/sorted";
import { niceStep, stepFor } from "./draw_timeline";
import { Painted, type Colours, type Size } from "../world/painted";

/** The time under the mouse, for all plots; null: the mouse is elsewhere. */
export interface Cursor {
  time: number | null;
}

interface PlotProps {
  path: string;
  unit: string;
  track: Track;
  /** Another run, drawn in a second colour. */
  beside: Track | null;
  seconds: number;
  cursor: Cursor;
  onClose: () => void;
}

const left = 46;
const below = 15;
/** Space above the curves for the names of the behaviours. */
const above = 13;

/** A value over time, with axes, the behaviours of its subsystem as bands, and the same value of another run. */
export function Plot({ path, unit, track, beside, seconds, cursor, onClose }: PlotProps) {
  const ref = useRef<HTMLDivElement>(null);
  const samples = track.series.samples.get(path);
  if (!samples) return null;
  const span = () => ({ start: track.now - seconds * 1e9, end: track.now });
  const move = (x: number) => {
    const { start, end } = span();
    const width = (ref.current?.clientWidth ?? 1) - left;
    cursor.time = x < left ? null : start + ((x - left) / width) * (end - start);
  };
  return (
    <div
      ref={ref}
      className="large-plot"
      onPointerMove={(event) => move(event.clientX - event.currentTarget.getBoundingClientRect().left)}
      onPointerLeave={() => (cursor.time = null)}
    >
      <div className="plot-title">
        <span className="path">{path}</span> {unit && <span className="faint">{unit}</span>}
        <button className="quiet" aria-label={`Remove the plot of ${path}`} onClick={onClose}>
          ×
        </button>
      </div>
      <Painted
        label={`Plot of ${path}${unit ? ` in ${unit}` : ""}`}
        draw={(context, size, colours) => {
          const other = beside?.series.samples.get(path);
          draw(context, size, colours, { track, path, samples, ...(other ? { other } : {}), ...span(), cursor: cursor.time });
        }}
        of={() => `${track.id} ${track.now} ${path} ${seconds} ${cursor.time ?? ""} ${beside?.now ?? ""}`}
      />
    </div>
  );
}

interface Drawn {
  track: Track;
  path: string;
  samples: Samples;
  other?: Samples;
  start: number;
  end: number;
  cursor: number | null;
}

function draw(context: CanvasRenderingContext2D, size: Size, colours: Colours, all: Drawn): void {
  const { samples, other, start, end, cursor } = all;
  const [low, high] = rangeOf([samples, ...(other ? [other] : [])], start, end);
  if (low > high) return;
  const [width, height] = [size.width - left, size.height - below];
  const x = (time: number) => left + ((time - start) / (end - start)) * width;
  const y = (value: number) => height - 4 - ((value - low) / (high - low)) * (height - 8 - above);
  context.font = "10px system-ui, 'DejaVu Sans', sans-serif";
  bands(context, colours, all, x, height);
  axes(context, colours, { low, high, start, end, width, height }, x, y);
  if (other) line(context, other, start, end, colours.faint, x, y);
  line(context, samples, start, end, colours.accent, x, y);
  if (cursor === null || cursor < start) return;
  const value = samples.values[count(samples.times, (time) => time <= cursor) - 1];
  context.fillStyle = colours.text;
  context.fillRect(x(cursor) - 0.5, 0, 1, height);
  if (value === undefined) return;
  context.textAlign = x(cursor) > size.width - 90 ? "right" : "left";
  context.fillText(
    `${shown(value)} at ${(cursor / 1e9).toFixed(2)} s`,
    x(cursor) + (context.textAlign === "right" ? -4 : 4),
    above + 9,
  );
  context.textAlign = "left";
}

function rangeOf(all: readonly Samples[], start: number, end: number): [number, number] {
  let [low, high] = [Infinity, -Infinity];
  for (const { times, values } of all)
    for (let at = Math.max(0, count(times, (time) => time < start) - 1); at < times.length && times[at]! <= end; at += 1) {
      low = Math.min(low, values[at]!);
      high = Math.max(high, values[at]!);
    }
  return high - low < 1e-9 ? [low - 0.5, high + 0.5] : [low, high];
}

function axes(
  context: CanvasRenderingContext2D,
  colours: Colours,
  { low, high, start, end, width, height }: Record<"low" | "high" | "start" | "end" | "width" | "height", number>,
  x: (time: number) => number,
  y: (value: number) => number,
): void {
  context.strokeStyle = colours.line;
  context.fillStyle = colours.faint;
  const step = niceStep((high - low) / 3);
  context.textAlign = "right";
  for (let value = Math.ceil(low / step) * step; value <= high + step / 1e6; value += step) {
    const at = Math.round(y(value)) + 0.5;
    stroke(context, [left, at], [left + width, at]);
    context.fillText(shown(Number(value.toPrecision(6))), left - 4, Math.min(height - 2, at + 3));
  }
  context.textAlign = "center";
  const seconds = stepFor((end - start) / 1e9, width, 5);
  for (let second = Math.ceil(Math.max(0, start / 1e9) / seconds) * seconds; second <= end / 1e9; second += seconds) {
    const at = x(second * 1e9);
    if (at > left + 8 && at < left + width - 12) context.fillText(`${Number(second.toFixed(3))} s`, at, height + below - 4);
  }
  context.textAlign = "left";
  stroke(context, [left + 0.5, 0], [left + 0.5, height]);
}

/** The behaviours of the subsystem to which the value belongs: every second one is shaded. */
function bands(
  context: CanvasRenderingContext2D,
  colours: Colours,
  { track, path, start, end }: Drawn,
  x: (time: number) => number,
  height: number,
): void {
  const lane = track.timeline.lanes.find((one) => path.startsWith(`${one.path}.`));
  lane?.segments.forEach(({ start: from, behaviour }, at) => {
    const to = Math.min(lane.segments[at + 1]?.start ?? end, end);
    if (!behaviour || to < start || from > end) return;
    const begin = x(Math.max(from, start));
    context.fillStyle = colours.accent;
    context.globalAlpha = lane.behaviours.indexOf(behaviour) % 2 === 0 ? 0.06 : 0.16;
    context.fillRect(begin, 0, x(to) - begin, height);
    context.globalAlpha = 1;
    context.fillStyle = colours.faint;
    if (x(to) - begin > behaviour.length * 6 + 6) context.fillText(behaviour, begin + 3, above - 3);
  });
}

function line(
  context: CanvasRenderingContext2D,
  { times, values }: Samples,
  start: number,
  end: number,
  colour: string,
  x: (time: number) => number,
  y: (value: number) => number,
): void {
  const first = Math.max(0, count(times, (time) => time < start) - 1);
  const last = count(times, (time) => time <= end);
  if (first >= last) return;
  context.strokeStyle = colour;
  context.lineWidth = 1.5;
  context.beginPath();
  for (let at = first; at < last; at += 1) {
    // A value holds until the next one, so it is drawn in steps and not in slopes.
    if (at > first) context.lineTo(x(times[at]!), y(values[at - 1]!));
    context.lineTo(Math.max(left, x(times[at]!)), y(values[at]!));
  }
  context.lineTo(x(end), y(values[last - 1]!));
  context.stroke();
  context.lineWidth = 1;
}

function stroke(context: CanvasRenderingContext2D, from: [number, number], to: [number, number]): void {
  context.beginPath();
  context.moveTo(...from);
  context.lineTo(...to);
  context.stroke();
}
