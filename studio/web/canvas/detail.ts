/**
 * What of a structure is drawn at a zoom, so that no letter has less than ten pixels: the names of agents and the
 * channels between them; the names of subsystems, too; or all.
 */
export type Detail = "agents" | "subsystems" | "all";

/** A zoom not above the real one, which changes seldom: letters are measured by it. */
export const steps = (zoom: number, inOctave = 8) => 2 ** (Math.floor(Math.log2(zoom) * inOctave) / inOctave);

/** The step of a structure's zoom: style/structure.css measures letters by it. */
export const structureStep = (zoom: number) => steps(zoom, 16);

/** At this zoom the largest letters that the boxes have room for (model/structure_layout.ts) have ten pixels. */
const all = 0.54;
/** At this zoom a subsystem is wide enough for eight letters. */
const subsystems = 0.27;

export function detailAt(zoom: number): Detail {
  const step = structureStep(zoom);
  return step >= all ? "all" : step >= subsystems ? "subsystems" : "agents";
}

/** Lines of a name that a box of this height has room for: one to three, of letters of so many pixels. */
export const linesIn = (height: number, zoom: number, letters: number) =>
  Math.min(3, Math.max(1, Math.floor((height * zoom - 8) / (letters * 1.25))));
