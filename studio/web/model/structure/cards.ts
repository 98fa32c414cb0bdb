import type { Point } from "../net/geometry";
import type { Machine } from "./machine_layout";
import type { Agent, Buffer, Structure, Subsystem } from "./structure";
import { fontSize, type Measure } from "./text_size";

/** The cards of subsystems and their devices: they take the size of the texts in them. */

export interface Card {
  width: number;
  height: number;
  /** The corner of its machine, from that of the card. */
  machineAt: Point;
  machine: Machine;
  /** The device below it; null: it has none. */
  device: { width: number; height: number } | null;
}

export const row = 21;
export const head = 42;
export const gap = { device: 22 };
/** Space beside texts: the circle of a buffer, the rims of the card. */
const side = { port: 12, text: 11, between: 16, flag: 18 };
/** So that a short name fits into it from afar. */
const leastWidth = 136;
const deviceHead = 24;
const deviceRow = 20;

export const kindTitle = { control: "control subsystem", receptor: "virtual receptor", effector: "virtual effector" };
export const deviceTitle = ({ kind }: Subsystem) => (kind === "effector" ? "real effector" : "real receptor");

/** The rate as a value, also where the file has an alias: "100 Hz". */
export const rateText = ({ yaml }: Structure, { yaml: at }: Subsystem) => yaml.followedText([...at, "rate"]) ?? "";

/** The text behind the name of an agent: " × 3 uses carrier". */
export const agentNote = ({ count, template, included }: Agent) =>
  `${count ? ` × ${count}` : ""}${template ? ` uses ${template}` : ""}${included ? " of an included file" : ""}`;

/** Letters on the screen are rounded to pixels, so texts may be a little wider than measured. */
const safe = (width: number) => width * 1.03 + 1;

const buffersOf = (subsystem: Subsystem, direction: Buffer["direction"]) =>
  subsystem.buffers.filter((buffer) => buffer.direction === direction);
const widest = (buffers: readonly Buffer[], measure: Measure) =>
  Math.max(0, ...buffers.map(({ name }) => safe(measure(name, "text"))));

export const ports = (subsystem: Subsystem) =>
  Math.max(buffersOf(subsystem, "input").length, buffersOf(subsystem, "output").length);

export function cardOf(structure: Structure, subsystem: Subsystem, machine: Machine, measure: Measure): Card {
  const rows = ports(subsystem);
  const rate = rateText(structure, subsystem);
  const [inputs, outputs] = [widest(buffersOf(subsystem, "input"), measure), widest(buffersOf(subsystem, "output"), measure)];
  const real = buffersOf(subsystem, "real");
  const deviceWidth = Math.max(safe(measure(deviceTitle(subsystem), "text")), widest(real, measure) + 8) + 2 * side.text;
  const device = real.length > 0 ? { width: deviceWidth, height: deviceHead + real.length * deviceRow + 6 } : null;
  const texts = [
    safe(measure(subsystem.name, "subsystem")) + (rate ? safe(measure(rate, "text")) + 10 : 0) + 2 * side.text + side.flag,
    safe(measure(kindTitle[subsystem.kind], "text")) + 2 * side.text,
    (inputs && inputs + side.port + 8) + (outputs && outputs + side.port + 8) + (inputs && outputs ? side.between : side.text),
    machine.width + 2 * side.text,
    device?.width ?? 0,
  ];
  const width = Math.ceil(Math.max(leastWidth, ...texts));
  const above = head + rows * row + 8;
  return {
    width,
    height: Math.ceil(above + machine.height + 10),
    machineAt: { x: (width - machine.width) / 2, y: above + 2 },
    machine,
    device,
  };
}

export const withDevice = ({ height, device }: Card) => height + (device ? gap.device + device.height : 0);

/** The width that the name of an agent takes, with what stands behind it. */
export const agentNameWidth = (agent: Agent, measure: Measure) =>
  safe(measure(agent.name, "agent")) + safe(measure(agentNote(agent), "agent")) + 3 * fontSize.agent;
