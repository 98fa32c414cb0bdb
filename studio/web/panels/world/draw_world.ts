import type { Pose, Track } from "../../live/run/track";
import { niceStep } from "../plots/draw_timeline";
import type { Colours, Size } from "./painted";

/**
 * The path of the robot over the floor up to the shown time, x to the right and y up, with a scale in metres.
 */
export function drawWorld(context: CanvasRenderingContext2D, size: Size, colours: Colours, track: Track, none: string): void {
  const { path } = track;
  context.font = "11px system-ui, 'DejaVu Sans', sans-serif";
  if (path.length === 0) {
    context.fillStyle = colours.faint;
    context.fillText(none, 10, 20);
    return;
  }
  const box = boundsOf(path, track.floor);
  const scale = Math.min((size.width - 30) / (box.right - box.left), (size.height - 34) / (box.top - box.bottom));
  const x = (at: number) => size.width / 2 + (at - (box.left + box.right) / 2) * scale;
  const y = (at: number) => (size.height - 10) / 2 - (at - (box.top + box.bottom) / 2) * scale;
  drawFloor(context, track.floor, x, y, scale);
  const driven = track.driven;
  drawPath(context, colours, path, driven, x, y);
  const robot = path[Math.max(0, driven - 1)]!;
  drawRobot(context, colours.text, x(robot.x), y(robot.y), robot.heading);
  drawScale(context, size, colours, scale);
}

/** Poses further apart in time than this (in ns) are not joined by a line. */
const apart = 1.5e9;

/** The path so far. The later part of a recording is a faint line. */
function drawPath(
  context: CanvasRenderingContext2D,
  colours: Colours,
  path: readonly Pose[],
  driven: number,
  x: (at: number) => number,
  y: (at: number) => number,
): void {
  const every = Math.max(1, Math.floor(path.length / 4000));
  const line = (from: number, to: number, colour: string) => {
    context.strokeStyle = context.fillStyle = colour;
    context.lineWidth = 1.5;
    context.beginPath();
    let before: Pose | undefined;
    for (let at = from; at < to; at = at === to - 1 ? to : Math.min(at + every, to - 1)) {
      const pose = path[at]!;
      if (before && pose.t - before.t < apart * every) context.lineTo(x(pose.x), y(pose.y));
      else {
        context.moveTo(x(pose.x), y(pose.y));
        context.fillRect(x(pose.x) - 1.25, y(pose.y) - 1.25, 2.5, 2.5);
      }
      before = pose;
    }
    context.stroke();
  };
  line(Math.max(0, driven - 1), path.length, colours.line);
  line(0, driven, colours.accent);
}

/** The picture's lower left corner is the floor's origin. */
export function drawFloor(
  context: CanvasRenderingContext2D,
  floor: Track["floor"],
  x: (at: number) => number,
  y: (at: number) => number,
  scale: number,
): void {
  if (!floor) return;
  const [width, height] = [floor.image.width * floor.metresPerPixel, floor.image.height * floor.metresPerPixel];
  context.save();
  context.globalAlpha = 0.35;
  context.drawImage(floor.image, x(0), y(height), width * scale, height * scale);
  context.restore();
}

export function boundsOf(path: readonly { x: number; y: number }[], floor: Track["floor"]) {
  const box = { left: Infinity, right: -Infinity, bottom: Infinity, top: -Infinity };
  if (floor)
    Object.assign(box, {
      left: 0,
      bottom: 0,
      right: floor.image.width * floor.metresPerPixel,
      top: floor.image.height * floor.metresPerPixel,
    });
  for (const { x, y } of path) {
    box.left = Math.min(box.left, x);
    box.right = Math.max(box.right, x);
    box.bottom = Math.min(box.bottom, y);
    box.top = Math.max(box.top, y);
  }
  // At least half a metre; otherwise a robot that stands still would fill the window.
  if (floor) return box;
  const grow = (low: number, high: number) => Math.max(0, 0.5 - (high - low)) / 2 + 0.05;
  const [across, along] = [grow(box.left, box.right), grow(box.bottom, box.top)];
  return { left: box.left - across, right: box.right + across, bottom: box.bottom - along, top: box.top + along };
}

export function drawRobot(context: CanvasRenderingContext2D, colour: string, x: number, y: number, heading: number): void {
  context.save();
  context.translate(x, y);
  context.rotate(-heading);
  context.beginPath();
  context.moveTo(9, 0);
  context.lineTo(-6, 5.5);
  context.lineTo(-3.5, 0);
  context.lineTo(-6, -5.5);
  context.closePath();
  context.fillStyle = colour;
  context.fill();
  context.restore();
}

export function drawScale(context: CanvasRenderingContext2D, size: Size, colours: Colours, scale: number): void {
  const metres = niceStep(50 / scale);
  const y = size.height - 8.5;
  context.strokeStyle = colours.faint;
  context.fillStyle = colours.faint;
  context.lineWidth = 1;
  context.beginPath();
  context.moveTo(10, y - 3);
  context.lineTo(10, y);
  context.lineTo(10 + metres * scale, y);
  context.lineTo(10 + metres * scale, y - 3);
  context.stroke();
  context.fillText(`${Number(metres.toPrecision(2))} m`, 16 + metres * scale, y + 3);
}
