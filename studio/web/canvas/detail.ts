/**
 * The parts of a structure that are drawn at a zoom, so that no letter has less than ten pixels: the names of
 * agents and the channels between them; the names of subsystems, too; or everything.
 */
export type Detail = "agents" | "subsystems" | "all";

/** A zoom not above the real one, which changes seldom: it scales the letters. */
export const steps = (zoom: number, inOctave = 8) => 2 ** (Math.floor(Math.log2(zoom) * inOctave) / inOctave);

/** The step of a structure's zoom, by which style/structure.css scales letters. */
export const structureStep = (zoom: number) => steps(zoom, 16);

/** At this zoom, the largest letters that fit into the boxes (model/structure_layout.ts) have ten pixels. */
const all = 0.54;
/** At this zoom a subsystem is wide enough for eight letters. */
const subsystems = 0.27;

export function detailAt(zoom: number): Detail {
  const step = structureStep(zoom);
  return step >= all ? "all" : step >= subsystems ? "subsystems" : "agents";
}

/** The lines of a name that fit into a box of this height: one to three, of letters of so many pixels. */
export const linesIn = (height: number, zoom: number, letters: number) =>
  Math.min(3, Math.max(1, Math.floor((height * zoom - 8) / (letters * 1.25))));

/**
 * The distance of a sheet, by the pixels of its unit: 2 means that lines and letters would be four times too large,
 * -1 that they are small, -3 that they are dots.
 */
export const nearness = (pixels: number) => Math.min(5, Math.max(-3, Math.floor(Math.log2(pixels / 0.95))));
