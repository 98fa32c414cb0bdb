import type { Box } from "../../model/net/geometry";
import { inMiddle, nameLines } from "../../model/net/labels";

/** Widths in pixels of boxes with a cut name, and the space beside it. */
const cutWidths = [40, 56, 76, 100, 130, 170, 220];
const rim = 10;
/** A box of fewer pixels has no name. */
export const leastCut = cutWidths[0]!;
/** The width of a letter, as a part of its height. */
const letter = 0.62;
/** The distance of lines, as a part of the height of a letter. */
const pitch = 1.15;

/** The name in the middle of a page whose net is too small to be drawn. */
export interface ClosedName {
  /** The middle of the page. */
  x: number;
  y: number;
  /** The whole name: its lines, each with its distance from the middle as a part of the height of letters. */
  lines: { text: string; shift: number }[];
  /** Height of the letters, and how many times they may grow while the page is far away. */
  size: number;
  more: number;
  /** Cut names, each for a range of pixels of a unit. */
  cuts: { text: string; from: number; to: number }[];
  /** Baselines of the layer and of the running behaviour. */
  layerAt: number;
  runningAt: number;
}

/** The letters of the layer and of the running behaviour, below a name with letters of that size. */
export const layerSize = (size: number) => size * 0.52;
export const runningSize = (size: number) => size * 0.75;

/** A name of so many letters. The number of a member of a fleet stays, because nothing else tells it from the others. */
export function cutTo(name: string, room: number): string {
  if (name.length <= room) return name;
  const member = /\[\d+\]$/.exec(name)?.[0] ?? "";
  const end = member.length < room - 1 ? member : "";
  return end ? `${name.slice(0, room - 1 - end.length)}…${end}` : inMiddle(name, room);
}

/**
 * The name broken into the lines that allow the largest letters; cut where the whole name would be too small.
 */
export function closedName(name: string, box: Box): ClosedName {
  const fitting = (lines: string[]) => {
    const longest = Math.max(4, ...lines.map(({ length }) => length)) * letter;
    const size = Math.min(34, (box.width - 30) / longest, (box.height - 12) / (lines.length * pitch + 1.6));
    // Far away, letters grow to their ten pixels if they fit into the frame.
    const largest = Math.min((box.width - 12) / longest, (box.height - 8) / (lines.length * pitch));
    return { lines, size, more: largest / size };
  };
  const ways = [1, 2, 3].map((most) => fitting(nameLines(name, most)));
  // More lines are worth it if their letters are larger, or if the whole name is readable from farther away.
  const isBetter = (one: (typeof ways)[number], best: (typeof ways)[number]) =>
    one.size > best.size * 1.15 || (one.size > best.size * 0.85 && one.size * one.more > best.size * best.more * 1.15);
  const { lines, size, more } = ways.reduce((best, one) => (isBetter(one, best) ? one : best));
  const y = box.y + box.height / 2;
  const below = y + size / 3 + ((lines.length - 1) * size * pitch) / 2;
  // The width in pixels at which the whole name becomes readable.
  const whole = (10 / (size * more)) * box.width;
  return {
    x: box.x + box.width / 2,
    y,
    lines: lines.map((text, at) => ({ text, shift: (at - (lines.length - 1) / 2) * pitch + 0.35 })),
    size,
    more,
    cuts: cutWidths.flatMap((width, at) => {
      if (width >= whole) return [];
      const room = Math.floor((width - rim) / (10 * letter));
      const to = Math.min(whole, cutWidths[at + 1] ?? Infinity);
      return [{ text: cutTo(name, room), from: width / box.width, to: to / box.width }];
    }),
    layerAt: below + size * 0.75,
    runningAt: below + size * 1.75,
  };
}
