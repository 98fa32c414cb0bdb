import type { Sheet } from "../../model/net/geometry";
import { leastCut } from "./closed_name";

/** If a sheet has more nodes than this, only those in and around the window are drawn, unless they are bare. */
export const crowd = 60;

/** More pages than this, too small for any name, are bare frames. */
const throng = 600;

const widest = new WeakMap<Sheet, number>();

/** Whether the pages of a sheet are so many and so small that they are frames without names. pixel: of a unit. */
export function isBare(sheet: Sheet, pixel: number): boolean {
  if (sheet.nodes.length <= throng) return false;
  let width = widest.get(sheet);
  if (width === undefined) widest.set(sheet, (width = sheet.nodes.reduce((most, box) => Math.max(most, box.width), 0)));
  return width * pixel < leastCut;
}
