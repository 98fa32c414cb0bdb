import type { Wait } from "../causes";
import { overlap, type Box, type Point } from "../net/geometry";

/** The arrows of a chain of waiting, and the positions of their labels. */

export interface Arrow {
  key: string;
  /** As an SVG path. */
  path: string;
  text: string;
  label: Box;
}

/** A curve of two or three control points, and the direction to the outside of a circle. */
interface Way {
  path: string;
  at: (part: number) => Point;
  out: Point;
}

/** Pixels of a letter of a label and of a line. */
const letter = 7.4;
const line = 15;
/** Possible positions of a label, as parts of its arrow. */
const parts = [0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8, 0.1, 0.9];
/** Parts of an arrow that stay free of labels. */
const samples = Array.from({ length: 31 }, (_, at) => at / 30);
/** Pixels at the rims of a window without labels; the legend and the buttons are below. */
const rim = { side: 6, top: 6, below: 46 };

/**
 * An arrow for each wait between drawn boxes. Its label is beside it, within the window, and covers as little
 * as possible of boxes, names, arrows and other labels.
 *
 * boxes: those of all subsystems involved. unit: the size of a pixel in units of the drawing.
 */
export function arrows(
  waits: readonly Wait[],
  boxes: ReadonlyMap<string, Box>,
  names: readonly Box[],
  window: Box,
  unit: number,
): Arrow[] {
  const ways = waits.flatMap((wait) => {
    const [from, to] = [boxes.get(wait.who), boxes.get(wait.whom)];
    return from && to ? [{ wait, way: from === to ? loop(from, unit) : bent(from, to, unit) }] : [];
  });
  const lines = ways.flatMap(({ way }) => samples.map((part) => grown({ ...way.at(part), width: 0, height: 0 }, 5 * unit)));
  const covered = [...boxes.values(), ...names, ...lines];
  const inside = {
    x: window.x + rim.side * unit,
    y: window.y + rim.top * unit,
    width: window.width - 2 * rim.side * unit,
    height: window.height - (rim.top + rim.below) * unit,
  };
  return ways.map(({ wait: { who, whom, channel, awaited }, way }) => {
    const text = `waits for ${awaited === "value" ? "a value" : awaited === "nothing" ? "it" : `the ${awaited}`}`;
    const size = { width: text.length * letter * unit, height: line * unit };
    const places = parts.flatMap((part) => [1, -1].map((side) => within(inside, beside(way, part, side, size, unit))));
    const label = places.reduce((best, one) => (cost(one, covered) < cost(best, covered) - 1e-9 ? one : best));
    covered.push(label);
    return { key: `${who} ${whom} ${channel}`, path: way.path, text, label };
  });
}

const cost = (label: Box, covered: readonly Box[]) =>
  covered.reduce((sum, one) => {
    const both = overlap(label, one);
    return sum + (both ? both.width * both.height : 0);
  }, 0);

function beside(
  { at, out }: Way,
  part: number,
  side: number,
  { width, height }: Pick<Box, "width" | "height">,
  unit: number,
): Box {
  const point = at(part);
  const [x, y] = [out.x * side, out.y * side];
  return {
    x: point.x + x * (width / 2 + 9 * unit) - width / 2,
    y: point.y + y * (height / 2 + 7 * unit) - height / 2,
    width,
    height,
  };
}

/** The same label, moved into the window. */
function within(window: Box, label: Box): Box {
  const x = Math.max(window.x, Math.min(label.x, window.x + window.width - label.width));
  const y = Math.max(window.y, Math.min(label.y, window.y + window.height - label.height));
  return { ...label, x, y };
}

export const grown = ({ x, y, width, height }: Box, by: number): Box => ({
  x: x - by,
  y: y - by,
  width: width + 2 * by,
  height: height + 2 * by,
});

const middle = ({ x, y, width, height }: Box): Point => ({ x: x + width / 2, y: y + height / 2 });

export function around(boxes: readonly Box[]): Box | undefined {
  if (boxes.length === 0) return undefined;
  const x = Math.min(...boxes.map((box) => box.x));
  const y = Math.min(...boxes.map((box) => box.y));
  const right = Math.max(...boxes.map((box) => box.x + box.width));
  const bottom = Math.max(...boxes.map((box) => box.y + box.height));
  return { x, y, width: right - x, height: bottom - y };
}

/** An arrow between the rims of two boxes, bent to one side, so that those of a circle stay apart. */
function bent(from: Box, to: Box, unit: number): Way {
  const [a, b] = [middle(from), middle(to)];
  const length = Math.hypot(b.x - a.x, b.y - a.y) || 1;
  const side = Math.min(60 * unit, length / 4);
  const out = { x: -(b.y - a.y) / length, y: (b.x - a.x) / length };
  const control = { x: (a.x + b.x) / 2 - ((b.y - a.y) / length) * side, y: (a.y + b.y) / 2 + ((b.x - a.x) / length) * side };
  const [start, end] = [atRim(from, control), atRim(to, control)];
  return {
    path: `M${start.x} ${start.y}Q${control.x} ${control.y} ${end.x} ${end.y}`,
    at: (part) => ({
      x: (1 - part) ** 2 * start.x + 2 * part * (1 - part) * control.x + part ** 2 * end.x,
      y: (1 - part) ** 2 * start.y + 2 * part * (1 - part) * control.y + part ** 2 * end.y,
    }),
    out,
  };
}

/** The point where the line from the middle of a box to a point leaves the box. */
function atRim(box: Box, to: Point): Point {
  const from = middle(box);
  const [dx, dy] = [to.x - from.x, to.y - from.y];
  const part = Math.min(
    dx === 0 ? Infinity : box.width / 2 / Math.abs(dx),
    dy === 0 ? Infinity : box.height / 2 / Math.abs(dy),
    1,
  );
  return { x: from.x + dx * part, y: from.y + dy * part };
}

function loop(box: Box, unit: number): Way {
  const [x, y] = [box.x + box.width / 2, box.y];
  const size = 46 * unit;
  return {
    path: `M${x - size / 2} ${y}C${x - size} ${y - size} ${x + size} ${y - size} ${x + size / 2} ${y}`,
    at: () => ({ x, y: y - size * 0.75 }),
    out: { x: 0, y: -1 },
  };
}
