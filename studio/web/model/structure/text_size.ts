/**
 * Sizes of the texts of the structure. Boxes take the size of their names, so every text is measured before the layout.
 * A unit of the drawing is a pixel at zoom 1.
 */

export type Font = "agent" | "subsystem" | "text";
/** The size of the letters of a font, in units. */
export const fontSize: Record<Font, number> = { agent: 15, subsystem: 13.5, text: 12 };
/** The height of a line, as a multiple of the size of its letters. */
export const lineHeight = 1.25;
/** Letters have at least so many pixels on the screen. */
export const leastPixels = 10;

/** The width of a text in a font, in units. The page measures it with the letters of the browser. */
export type Measure = (text: string, font: Font) => number;

/** A measure without a browser: somewhat more than the letters of usual fonts take. */
export const estimated: Measure = (text, font) => text.length * fontSize[font] * 0.66;

/** The same measure, which asks once for each text. */
export function remembered(measure: Measure): Measure {
  const known = new Map<string, number>();
  return (text, font) => {
    const key = `${font} ${text}`;
    const found = known.get(key);
    if (found !== undefined) return found;
    const width = measure(text, font);
    known.set(key, width);
    return width;
  };
}

/** A shorter word is not broken. */
const breakable = 14;

/** The lines of a text in a width. It breaks at spaces and behind "_", ".", "-"; broken: also within a long word. */
export function wrapped(text: string, width: number, measure: Measure, font: Font = "text", broken = false): string[] {
  const lines: string[] = [];
  let line = "";
  const fits = (one: string) => measure(one.trimEnd(), font) <= width;
  for (const word of text.split(/(?<=[_\-. ])/)) {
    if (line === "" || fits(line + word)) line += word;
    else {
      lines.push(line);
      line = word;
    }
    while (broken && !fits(line) && line.length >= breakable) {
      let end = line.length - 1;
      while (end > 1 && !fits(line.slice(0, end))) end -= 1;
      lines.push(line.slice(0, end));
      line = line.slice(end);
    }
  }
  return [...lines, line].map((one) => one.trimEnd());
}

export interface FittedText {
  /** Pixels of its letters on the screen. */
  size: number;
  lines: string[];
}

/** A name in the largest letters with which it fits into a box of so many pixels; undefined: it does not fit. */
export function fitted(
  text: string,
  { width, height }: { width: number; height: number },
  most: number,
  measure: Measure,
  font: Font,
): FittedText | undefined {
  for (const broken of [false, true])
    for (let size = most; size >= leastPixels; size -= 1) {
      // A little less than the room: letters are rounded to pixels.
      const room = ((width * fontSize[font]) / size) * 0.97;
      const lines = wrapped(text, room, measure, font, broken);
      if (lines.length * size * lineHeight <= height && lines.every((line) => measure(line, font) <= room))
        return { size, lines };
      if (broken) break;
    }
  return undefined;
}
