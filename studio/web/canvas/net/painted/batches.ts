import type { LetterInk, ShapeInk } from "./ink";

/** Up to this number of pixels, a rounded corner cannot be seen. */
const unseen = 1.2;

interface Text {
  text: string;
  x: number;
  y: number;
  size: number;
  align: CanvasTextAlign;
  baseline: CanvasTextBaseline;
  ink: LetterInk;
}

/**
 * The shapes and texts of a sheet, collected by their looks: a path with a thousand shapes is drawn much faster than a
 * thousand paths.
 */
export class Batches {
  private readonly circles = new Map<ShapeInk, number[]>();
  private readonly rectangles = new Map<ShapeInk, number[]>();
  private readonly texts: Text[] = [];

  circle(ink: ShapeInk, x: number, y: number, radius: number): void {
    if (ink.shown) of(this.circles, ink).push(x, y, radius);
  }

  rectangle(ink: ShapeInk, x: number, y: number, width: number, height: number, radius: number): void {
    if (ink.shown) of(this.rectangles, ink).push(x, y, width, height, radius);
  }

  text(text: string, ink: LetterInk, size: number, x: number, y: number, align: CanvasTextAlign, central = false): void {
    if (text !== "") this.texts.push({ text, x, y, size, align, ink, baseline: central ? "middle" : "alphabetic" });
  }

  /** pixel: the number of pixels of a unit. */
  draw(context: CanvasRenderingContext2D, pixel: number): void {
    for (const [ink, all] of this.rectangles) rectangles(context, ink, all, pixel);
    for (const [ink, all] of this.circles) circles(context, ink, all);
    let font = "";
    for (const { text, x, y, size, align, baseline, ink } of this.texts) {
      const wanted = `${ink.weight} ${Math.round(size * 100) / 100}px ${ink.family}`;
      if (wanted !== font) context.font = font = wanted;
      context.textAlign = align;
      context.textBaseline = baseline;
      if (ink.halo !== null) {
        context.strokeStyle = ink.halo;
        context.lineWidth = ink.haloWidth;
        context.lineJoin = "round";
        context.strokeText(text, x, y);
      }
      context.fillStyle = ink.fill;
      context.fillText(text, x, y);
    }
  }
}

function of(all: Map<ShapeInk, number[]>, ink: ShapeInk): number[] {
  let found = all.get(ink);
  if (!found) all.set(ink, (found = []));
  return found;
}

function fillAndStroke(context: CanvasRenderingContext2D, ink: ShapeInk): void {
  context.globalAlpha = ink.opacity;
  if (ink.fill !== null) {
    context.fillStyle = ink.fill;
    context.fill();
  }
  if (ink.stroke !== null && ink.width > 0) {
    context.strokeStyle = ink.stroke;
    context.lineWidth = ink.width;
    context.setLineDash(ink.dash);
    context.stroke();
    context.setLineDash([]);
  }
  context.globalAlpha = 1;
}

function circles(context: CanvasRenderingContext2D, ink: ShapeInk, all: readonly number[]): void {
  context.beginPath();
  for (let at = 0; at < all.length; at += 3) {
    context.moveTo(all[at]! + all[at + 2]!, all[at + 1]!);
    context.arc(all[at]!, all[at + 1]!, all[at + 2]!, 0, 2 * Math.PI);
  }
  fillAndStroke(context, ink);
}

function rectangles(context: CanvasRenderingContext2D, ink: ShapeInk, all: readonly number[], pixel: number): void {
  context.beginPath();
  for (let at = 0; at < all.length; at += 5)
    if (all[at + 4]! * pixel < unseen) context.rect(all[at]!, all[at + 1]!, all[at + 2]!, all[at + 3]!);
    else context.roundRect(all[at]!, all[at + 1]!, all[at + 2]!, all[at + 3]!, all[at + 4]!);
  fillAndStroke(context, ink);
}
