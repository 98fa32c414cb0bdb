import type { Box } from "../net/geometry";
import type { Agent, Structure, Subsystem } from "./structure";
import type { StructureDrawing } from "./structure_graph";
import { fitted, fontSize, leastPixels, type FittedText, type Measure } from "./text_size";

/**
 * Semantic zoom: the farther the drawing, the less of it is drawn, so that no text is too small, cut, or over another
 * one. Near, everything is there; then the names of subsystems fill their boxes; farthest, those of agents.
 */
export type Detail = "agents" | "subsystems" | "all";

/** Zooms from which on a part of the drawing has room. */
export interface Levels {
  /** The names of agents fit into their boxes. The drawing does not become smaller. */
  agents: number;
  /** So do the names of all subsystems. */
  subsystems: number;
  /** All letters have the least size. */
  all: number;
}

const inOctave = 16;
/** A zoom not above the real one, which changes seldom: it scales the letters. */
export const structureStep = (zoom: number) => 2 ** (Math.floor(Math.log2(zoom) * inOctave + 1e-6) / inOctave);
const stepAt = (index: number) => 2 ** (index / inOctave);

export const detailAt = (zoom: number, levels: Levels): Detail => {
  const step = structureStep(zoom);
  return step >= levels.all ? "all" : step >= levels.subsystems ? "subsystems" : "agents";
};

/** The space for the name of an agent above its subsystems, in units. */
export const agentHead = 46;
const most = { agent: 16, subsystem: 15 };

const inner = ({ width, height }: Box, zoom: number, across: number, down: number) => ({
  width: width * zoom - across,
  height: height * zoom - down,
});

/** A name in a box, with the notes below it that fit, too. */
export interface FilledBox extends FittedText {
  notes: string[];
}

function filled(
  name: string,
  notes: readonly string[],
  room: { width: number; height: number },
  font: "agent" | "subsystem",
  measure: Measure,
): FilledBox | undefined {
  const text = fitted(name, room, most[font], measure, font);
  if (!text) return undefined;
  const noteSize = leastPixels + 1;
  let left = room.height - text.lines.length * text.size * 1.25;
  const shown = notes.filter((note) => {
    const wide = measure(note, "text") * (noteSize / fontSize.text) * 1.03;
    if (wide > room.width || left < noteSize * 1.3) return false;
    left -= noteSize * 1.3;
    return true;
  });
  return { ...text, notes: shown };
}

/** The size of a name with its notes, in units of the drawing. */
export function sizeOfFilled({ lines, size, notes }: FilledBox, font: "agent" | "subsystem", zoom: number, measure: Measure) {
  const wide = [
    ...lines.map((line) => (measure(line, font) * size) / fontSize[font]),
    ...notes.map((note) => (measure(note, "text") * (leastPixels + 1)) / fontSize.text),
  ];
  const high = lines.length * size + notes.length * (leastPixels + 1);
  return { width: Math.max(...wide) / zoom, height: (high * 1.25) / zoom };
}

const counted = (count: number, one: string) => `${count} ${one}${count === 1 ? "" : "s"}`;

/** The name of an agent that fills its box; undefined: there is no room. */
export function agentFilled({ name, count, included, subsystems }: Agent, box: Box, zoom: number, measure: Measure) {
  const inside = included ? "in an included file" : counted(subsystems.length, "subsystem");
  const notes = [...(count ? [`× ${count}`] : []), inside];
  return filled(name, notes, inner(box, zoom, 14, 8), "agent", measure);
}

/** The name of an agent above its subsystems, whose names fill their boxes; undefined: there is no room. */
export function agentAbove({ name, count }: Agent, box: Box, zoom: number, measure: Measure) {
  const room = { width: box.width * zoom - 20, height: agentHead * zoom };
  const text = count ? `${name} × ${count}` : name;
  return fitted(text, room, most.agent, measure, "agent") ?? fitted(name, room, most.agent, measure, "agent");
}

/** The name of a subsystem that fills its box; undefined: there is no room. */
export function subsystemFilled(subsystem: Subsystem, box: Box, zoom: number, measure: Measure, now = "") {
  const behaviours = subsystem.behaviours.filter(({ isGroup }) => !isGroup).length;
  const notes = [now || counted(behaviours, "behaviour")];
  return filled(subsystem.name, notes, inner(box, zoom, 5, 5), "subsystem", measure);
}

/** The lowest step at which something holds that holds at all higher ones; the last, if it never does. */
function lowestStep(holds: (zoom: number) => boolean, from: number, to: number): number {
  let [low, high] = [from, to];
  while (low < high) {
    const middle = Math.floor((low + high) / 2);
    if (holds(stepAt(middle))) high = middle;
    else low = middle + 1;
  }
  return stepAt(low);
}

export function levelsOf({ agents }: Structure, { boxes }: StructureDrawing, measure: Measure): Levels {
  const all = Math.ceil(Math.log2(leastPixels / fontSize.text) * inOctave);
  const farthest = -6 * inOctave;
  const named = agents.flatMap((agent) => (boxes.has(agent.name) ? [{ agent, box: boxes.get(agent.name)! }] : []));
  const inside = named.flatMap(({ agent }) =>
    agent.subsystems.flatMap((one) => (boxes.has(one.path) ? [{ one, box: boxes.get(one.path)! }] : [])),
  );
  return {
    all: stepAt(all),
    subsystems: lowestStep(
      (zoom) =>
        named.every(({ agent, box }) => agentAbove(agent, box, zoom, measure)) &&
        inside.every(({ one, box }) => subsystemFilled(one, box, zoom, measure)),
      farthest,
      all,
    ),
    agents: lowestStep((zoom) => named.every(({ agent, box }) => agentFilled(agent, box, zoom, measure)), farthest, all),
  };
}
