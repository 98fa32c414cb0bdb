import type { MarkedRun } from "../../live/measured";
import type { Track } from "../../live/run/track";
import { inMiddle } from "../../model/net/labels";
import { Timeline } from "../../model/run/timeline";
import type { Colours, Size } from "../world/painted";
import { drawMarkedRun } from "./draw_marked_run";

const axis = 18;
const last = 4;
/** Pixels of a lane: in a lower one, its texts would touch those of its neighbours. */
const lanes = { least: 20, most: 34 };
/** Pixels of a letter, about. */
const letter = 6.3;

/** The width of the names of lanes: as long as they are, and a third of the picture at most. */
function namesWidth({ timeline }: Track, width: number): number {
  const longest = timeline.lanes.reduce((most, { path }) => Math.max(most, path.length), 0);
  return Math.max(70, Math.min(longest * letter + 14, width * 0.34));
}

/** The height that all lanes need. */
export const heightOfAll = ({ timeline }: Track) => timeline.lanes.length * lanes.least + axis;

const laneHeight = ({ timeline }: Track, height: number) =>
  Math.min(lanes.most, Math.max(lanes.least, (height - axis) / Math.max(1, timeline.lanes.length)));

/** The lane at a distance from the upper edge of the picture, of which so many pixels are scrolled away. */
export function laneAt(track: Track, y: number, height: number, scrolled: number): Timeline["lanes"][number] | undefined {
  return y < height - axis ? track.timeline.lanes[Math.floor((y + scrolled) / laneHeight(track, height))] : undefined;
}

/**
 * The shown time span: the last seconds; in a recording, the span around the shown time.
 */
function shownTime(track: Track, seconds: number): { start: number; end: number } {
  const length = seconds * 1e9;
  const end = track.end > track.now ? Math.min(track.end, track.now + length / 2) : track.now;
  return { start: Math.max(end, length) - length, end: Math.max(end, length) };
}

/** The time at a distance from the left edge of the timeline. */
export function timeAt(track: Track, seconds: number, x: number, width: number): number {
  const { start, end } = shownTime(track, seconds);
  const names = namesWidth(track, width);
  return start + Math.min(1, Math.max(0, (x - names) / (width - names - last))) * (end - start);
}

/** One lane per subsystem: its behaviours as bands with their names, and its firings as ticks. */
export function drawTimeline(
  context: CanvasRenderingContext2D,
  size: Size,
  colours: Colours,
  { track, seconds, scrolled, marked }: { track: Track; seconds: number; scrolled: number; marked: MarkedRun | null },
): void {
  const { timeline } = track;
  const { start, end } = shownTime(track, seconds);
  const names = namesWidth(track, size.width);
  const x = (time: number) => names + ((time - start) / (end - start)) * (size.width - names - last);
  const height = laneHeight(track, size.height);
  context.font = "11px system-ui, 'DejaVu Sans', sans-serif";
  context.textBaseline = "middle";
  drawAxis(context, size, colours, start, end, { x, names });
  context.save();
  context.beginPath();
  context.rect(0, 0, size.width, size.height - axis);
  context.clip();
  const first = Math.floor(scrolled / height);
  const seen = timeline.lanes.slice(first, first + Math.ceil(size.height / height) + 1);
  seen.forEach((lane, at) => {
    const y = (first + at) * height - scrolled;
    context.fillStyle = colours.text;
    context.fillText(shortened(lane.path, Math.floor((names - 12) / letter)), 6, y + height / 2, names - 10);
    drawBands(context, colours, lane, Math.min(end, track.end), start, x, y, height);
    drawTicks(context, colours, lane.firings, start, x, y + height - 5, size.width);
  });
  if (marked) {
    const lane = (subsystem: string) => timeline.lanes.findIndex(({ path }) => path === subsystem);
    const y = (subsystem: string) => (lane(subsystem) < 0 ? undefined : (lane(subsystem) + 0.5) * height - scrolled);
    context.beginPath();
    context.rect(names, 0, size.width - names, size.height - axis);
    context.clip();
    drawMarkedRun(context, colours, marked, { x, y, height: size.height - axis });
  }
  context.restore();
  if (track.end <= track.now) return;
  context.fillStyle = colours.text;
  context.fillRect(x(track.now) - 0.75, 0, 1.5, size.height - axis);
}

/** A path of so many letters, in which the agent and the subsystem can both be recognised. */
export function shortened(path: string, letters: number): string {
  if (path.length <= letters) return path;
  const dot = path.indexOf(".");
  if (dot < 0) return inMiddle(path, letters);
  const [agent, rest] = [path.slice(0, dot), path.slice(dot + 1)];
  const half = Math.floor((letters - 1) / 2);
  const forRest = Math.min(rest.length, Math.max(half, letters - 1 - agent.length));
  return `${inMiddle(agent, letters - 1 - forRest)}.${inMiddle(rest, forRest)}`;
}

function drawAxis(
  context: CanvasRenderingContext2D,
  size: Size,
  colours: Colours,
  start: number,
  end: number,
  { x, names }: { x: (time: number) => number; names: number },
): void {
  const step = stepFor((end - start) / 1e9, size.width - names - last, 6);
  context.strokeStyle = colours.line;
  context.fillStyle = colours.faint;
  for (let second = Math.ceil(start / 1e9 / step) * step; second <= end / 1e9; second += step) {
    const at = Math.round(x(second * 1e9)) + 0.5;
    context.beginPath();
    context.moveTo(at, 0);
    context.lineTo(at, size.height - axis);
    context.stroke();
    context.textAlign = at > size.width - 16 ? "right" : "center";
    context.fillText(`${Number(second.toFixed(3))} s`, Math.min(at, size.width - 2), size.height - axis / 2);
  }
  context.textAlign = "left";
}

/** Seconds between two numbers of a time axis: at most so many numbers, and none touches another. */
export const stepFor = (seconds: number, pixels: number, most: number) =>
  niceStep(seconds / Math.max(1, Math.min(most, pixels / 44)));

export function niceStep(rough: number): number {
  const power = 10 ** Math.floor(Math.log10(rough));
  const part = rough / power;
  return power * (part <= 1 ? 1 : part <= 2 ? 2 : part <= 5 ? 5 : 10);
}

/** The darkness of the bands of a lane's first, second, … behaviour. */
const shades = [0.14, 0.4, 0.26, 0.52];

function drawBands(
  context: CanvasRenderingContext2D,
  colours: Colours,
  { segments, behaviours }: Timeline["lanes"][number],
  end: number,
  start: number,
  x: (time: number) => number,
  y: number,
  height: number,
): void {
  for (let at = segments.length - 1; at >= 0; at -= 1) {
    const { start: from, behaviour } = segments[at]!;
    const to = Math.min(segments[at + 1]?.start ?? end, end);
    if (to < start) break;
    if (!behaviour || from > end) continue;
    const left = x(Math.max(from, start));
    const width = Math.max(1, x(to) - left);
    context.fillStyle = colours.accent;
    context.globalAlpha = shades[behaviours.indexOf(behaviour) % shades.length]!;
    context.fillRect(left, y + 3, width, height - 9);
    context.globalAlpha = 1;
    context.fillRect(left, y + 3, 1.5, height - 9);
    context.fillStyle = colours.text;
    if (width > 7 * behaviour.length + 8) context.fillText(behaviour, left + 5, y + height / 2 - 1.5, width - 8);
  }
}

function drawTicks(
  context: CanvasRenderingContext2D,
  colours: Colours,
  firings: readonly number[],
  start: number,
  x: (time: number) => number,
  y: number,
  width: number,
): void {
  context.fillStyle = colours.faint;
  let last = -1;
  for (let at = Timeline.from(firings, start); at < firings.length; at += 1) {
    const pixel = Math.round(x(firings[at]!));
    if (pixel === last || pixel > width) continue;
    context.fillRect(pixel, y, 1, 3);
    last = pixel;
  }
}
