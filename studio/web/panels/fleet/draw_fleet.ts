import type { Floor } from "../../live/api";
import type { Poses } from "../../live/world";
import { count } from "../../model/sorted";
import { fromAbove, type Paths, type Robot } from "../../model/run/robots";
import { boundsOf, drawFloor, drawRobot, drawScale } from "../world/draw_world";
import type { Colours, Size } from "../world/painted";

/** Colours whose neighbours differ clearly, on light and on dark backgrounds. */
export const colourOf = (robot: number) => `hsl(${Math.round(205 + robot * 137.5) % 360} 62% 48%)`;

/** Points further apart in time than this (in ns) are not joined by a line. */
const apart = 1e9;
/** More robots have no names at their positions: the names would hide each other. */
const mostNamed = 16;

/** The largest number of points drawn of all paths together. */
const mostPoints = 20_000;

export interface FleetShown {
  robots: readonly Robot[];
  poses: Poses;
  paths: Paths;
  now: number;
  floor: Floor | null;
  /** The highlighted body; -1: none. */
  followed: number;
}

/** Several robots from above, with their paths up to now, x to the right and y up. */
export function drawFleet(context: CanvasRenderingContext2D, size: Size, colours: Colours, shown: FleetShown): void {
  const { robots, poses, paths, now, floor, followed } = shown;
  const here = robots.map(({ body }) => fromAbove(poses, body));
  const { points, times } = paths;
  const sampled = Math.ceil(points.length / 200);
  const seen = points.flatMap((point, at) =>
    at % sampled === 0 ? paths.robots.map((_, robot) => ({ x: point[2 * robot]!, y: point[2 * robot + 1]! })) : [],
  );
  const box = boundsOf([...here, ...seen], floor);
  const scale = Math.min((size.width - 40) / (box.right - box.left), (size.height - 40) / (box.top - box.bottom));
  const x = (at: number) => size.width / 2 + (at - (box.left + box.right) / 2) * scale;
  const y = (at: number) => (size.height - 10) / 2 - (at - (box.top + box.bottom) / 2) * scale;
  context.font = "11px system-ui, 'DejaVu Sans', sans-serif";
  drawFloor(context, floor, x, y, scale);
  const driven = count(times, (time) => time <= now);
  const every = Math.ceil((driven * paths.robots.length) / mostPoints);
  paths.robots.forEach((_, robot) => {
    context.strokeStyle = colourOf(robot);
    context.lineWidth = 1.2;
    context.globalAlpha = 0.75;
    context.beginPath();
    for (let at = 0; at < driven; at += every) {
      const point = points[at]!;
      const [px, py] = [x(point[2 * robot]!), y(point[2 * robot + 1]!)];
      if (at > 0 && times[at]! - times[at - every]! < apart * every) context.lineTo(px, py);
      else context.moveTo(px, py);
    }
    context.stroke();
  });
  context.globalAlpha = 1;
  const named = robots.filter(({ agent }) => agent).length <= mostNamed;
  robots.forEach(({ name, agent, body }, robot) => {
    const at = here[robot]!;
    const [px, py] = [x(at.x), y(at.y)];
    if (!agent) {
      context.fillStyle = colours.faint;
      context.fillRect(px - 2.5, py - 2.5, 5, 5);
      return;
    }
    drawRobot(context, colourOf(robot), px, py, at.heading);
    if (body === followed) {
      context.strokeStyle = colours.text;
      context.lineWidth = 1.5;
      context.beginPath();
      context.arc(px, py, 12, 0, 2 * Math.PI);
      context.stroke();
    }
    if (!named && body !== followed) return;
    const text = cut(name, 18);
    const wide = context.measureText(text).width;
    context.fillStyle = colours.text;
    context.fillText(text, Math.min(Math.max(2, px + 10), size.width - wide - 2), Math.max(11, py - 8));
  });
  drawScale(context, size, colours, scale);
}

/** The beginning and the end of a long name: a fleet's names differ at their ends. */
export function cut(name: string, most: number): string {
  if (name.length <= most) return name;
  const end = Math.ceil((most - 1) / 2);
  return `${name.slice(0, most - 1 - end)}…${name.slice(-end)}`;
}
