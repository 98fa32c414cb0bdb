import type { Box, Sheet } from "../../../model/net/geometry";
import type { NetModel } from "../../../model/net/net";
import { strokesOf, tipOf, type ArcKind, type Strokes } from "../../../model/net/strokes";
import type { Ink, ShapeInk } from "./ink";

/** More arcs than this, so far away that they have no tips, would only be a grey area. */
export const mostFarArcs = 6000;

/** Corners and tips of so few pixels cannot be seen. */
const unseen = 1.5;

const known = new WeakMap<Sheet, Map<string, ReadonlyMap<ArcKind, Strokes>>>();

/** The lines of a sheet, made once. */
export function strokes(net: NetModel, page: number, sheet: Sheet, sharp: boolean): ReadonlyMap<ArcKind, Strokes> {
  let all = known.get(sheet);
  if (!all) known.set(sheet, (all = new Map()));
  // Pages that share a sheet differ at most in what never fires.
  const never = net.page(page).transitions.map(({ condition }) => (condition?.truth === "never" ? 1 : 0));
  const key = `${sharp}${never.join("")}`;
  let made = all.get(key);
  if (!made) all.set(key, (made = strokesOf(net, page, sheet, sharp)));
  return made;
}

interface Place {
  net: NetModel;
  page: number;
  sheet: Sheet;
  /** The classes of the sheet. */
  classes: string;
  /** The number of pixels of a unit. */
  pixel: number;
  /** The visible part. */
  clip: Box;
  far: boolean;
}

/** Draws the arcs of a sheet that are in the visible part. */
export function paintArcs(
  context: CanvasRenderingContext2D,
  ink: Ink,
  { net, page, sheet, classes, pixel, clip, far }: Place,
): void {
  if (far && sheet.routes.length > mostFarArcs) return;
  const sharp = far || 7 * pixel < unseen;
  for (const [kind, { lines, slanted, corners, tips }] of strokes(net, page, sheet, sharp)) {
    const style = ink.shape(classes, "", `path.arc${kind && !far ? `.${kind}` : ""}`);
    straight(context, style, lines, clip);
    context.strokeStyle = style.stroke ?? "none";
    context.lineWidth = style.width;
    context.beginPath();
    for (let at = 0; at < slanted.length; at += 4) {
      context.moveTo(slanted[at]!, slanted[at + 1]!);
      context.lineTo(slanted[at + 2]!, slanted[at + 3]!);
    }
    for (let at = 0; at < corners.length; at += 6) {
      if (!near(corners[at + 2]!, corners[at + 3]!, clip)) continue;
      context.moveTo(corners[at]!, corners[at + 1]!);
      context.quadraticCurveTo(corners[at + 2]!, corners[at + 3]!, corners[at + 4]!, corners[at + 5]!);
    }
    context.stroke();
    if (!far && 8 * pixel >= unseen) arrows(context, ink.shape(classes, "", kind === "never" ? "path.tip-never" : "path.tip"), tips, clip); // prettier-ignore
  }
}

const near = (x: number, y: number, clip: Box) =>
  x > clip.x - 10 && y > clip.y - 10 && x < clip.x + clip.width + 10 && y < clip.y + clip.height + 10;

function straight(context: CanvasRenderingContext2D, style: ShapeInk, lines: Float32Array, clip: Box): void {
  const half = style.width / 2;
  const [right, bottom] = [clip.x + clip.width, clip.y + clip.height];
  context.fillStyle = style.stroke ?? "none";
  for (let at = 0; at < lines.length; at += 4) {
    // Long lines are cut at the window, since a drawn pixel outside of it takes time, too.
    const [x1, y1] = [Math.max(lines[at]!, clip.x), Math.max(lines[at + 1]!, clip.y)];
    const [x2, y2] = [Math.min(lines[at + 2]!, right), Math.min(lines[at + 3]!, bottom)];
    if (x1 > x2 || y1 > y2) continue;
    if (lines[at + 1] === lines[at + 3]) context.fillRect(x1, y1 - half, x2 - x1, style.width);
    else context.fillRect(x1 - half, y1, style.width, y2 - y1);
  }
}

function arrows(context: CanvasRenderingContext2D, style: ShapeInk, tips: Float32Array, clip: Box): void {
  context.fillStyle = style.fill ?? "none";
  context.beginPath();
  for (let at = 0; at < tips.length; at += 4) {
    if (!near(tips[at]!, tips[at + 1]!, clip)) continue;
    const [first, ...rest] = tipOf(tips, at);
    context.moveTo(first!.x, first!.y);
    for (const { x, y } of rest) context.lineTo(x, y);
    context.closePath();
  }
  context.fill();
}
