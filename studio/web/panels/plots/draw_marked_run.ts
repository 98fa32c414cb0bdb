import type { MarkedRun } from "../../live/measured";
import type { Colours } from "../world/painted";

interface Places {
  x: (time: number) => number;
  /** The middle of the lane of a subsystem; undefined: it has none. */
  y: (subsystem: string) => number | undefined;
  height: number;
}

/** Draws the way of a value over the lanes of a timeline, from the reading or the event to the command. */
export function drawMarkedRun(
  context: CanvasRenderingContext2D,
  colours: Colours,
  { run, path }: MarkedRun,
  places: Places,
): void {
  const { x, y, height } = places;
  context.save();
  context.fillStyle = colours.accent;
  context.globalAlpha = 0.12;
  context.fillRect(x(run.from_ns), 0, Math.max(2, x(run.to_ns) - x(run.from_ns)), height);
  context.globalAlpha = 1;
  const points = [
    { time: run.from_ns, subsystem: path[0] ?? "" },
    ...run.hops.flatMap(({ from, to, written_ns, read_ns }) => [
      { time: written_ns, subsystem: from },
      { time: read_ns, subsystem: to },
    ]),
    { time: run.to_ns, subsystem: path.at(-1) ?? "" },
  ].flatMap(({ time, subsystem }) => {
    const middle = y(subsystem);
    return middle === undefined ? [] : [{ x: x(time), y: middle }];
  });
  context.strokeStyle = colours.text;
  context.lineWidth = 1.75;
  context.beginPath();
  for (const point of points) context.lineTo(point.x, point.y);
  context.stroke();
  context.fillStyle = colours.text;
  for (const point of points) {
    context.beginPath();
    context.arc(point.x, point.y, 3, 0, 2 * Math.PI);
    context.fill();
  }
  context.restore();
}
