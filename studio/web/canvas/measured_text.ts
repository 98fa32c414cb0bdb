import { fontSize, remembered, type Font, type Measure } from "../model/structure/text_size";

const weights: Record<Font, number> = { agent: 650, subsystem: 620, text: 400 };

/** The width of a text in the letters of this browser (style/structure.css). Each text is measured once. */
export const measured: Measure = remembered((text, font) => {
  const context = (drawing ??= document.createElement("canvas").getContext("2d")!);
  const family = getComputedStyle(document.documentElement).getPropertyValue("--font");
  // A larger size, so that widths are not rounded to pixels.
  const larger = 8;
  context.font = `${weights[font]} ${fontSize[font] * larger}px ${family}`;
  return context.measureText(text).width / larger;
});

let drawing: CanvasRenderingContext2D | undefined;
