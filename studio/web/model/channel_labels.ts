import { intersects, type Box, type Point } from "./geometry";
import { channelLabel, withoutIndex, type Channel, type Structure } from "./structure";
import { head, row, type AgentBox } from "./structure_layout";

const along = [0.5, 0.35, 0.65, 0.2, 0.8];
const between = (from: number, to: number, part: number) => from + part * (to - from);

/** The possible positions of a label: on the longest piece of the line, its middle first. */
function candidates(from: Point, to: Point, lane: number | undefined): Point[] {
  if (lane !== undefined && leadsBack(from, to)) return along.map((part) => ({ x: between(from.x, to.x, part), y: lane }));
  const x = (from.x + to.x) / 2;
  const steep = Math.abs(to.y - from.y) > 60;
  return (steep ? along : [0.5]).map((part) => ({ x, y: between(from.y, to.y, part) }));
}

/** Whether the channel cannot lead straight to the right. */
export const leadsBack = (from: Point, to: Point) => to.x < from.x + 40;

/**
 * The positions of the channels' labels, by the channel's index. They do not
 * overlap if that can be avoided.
 */
export function channelLabels(
  structure: Structure,
  boxes: readonly AgentBox[],
  lanes: ReadonlyMap<number, number>,
): Map<number, Point> {
  const ends = endsOf(structure, boxes);
  const places = new Map<number, Point>();
  const taken: Box[] = [];
  for (const channel of structure.channels) {
    const [from, to] = [ends.get(withoutIndex(channel.from)), ends.get(withoutIndex(channel.to))];
    if (!from || !to) continue;
    const points = candidates(from, to, lanes.get(channel.index));
    const free = points.find((point) => !taken.some((other) => intersects(boxAt(point, channel), other))) ?? points[0]!;
    places.set(channel.index, free);
    taken.push(boxAt(free, channel));
  }
  return places;
}

function boxAt({ x, y }: Point, channel: Channel): Box {
  const { modes, timeout } = channelLabel(channel);
  const width = (modes.length + timeout.length) * 6.8 + 20;
  return { x: x - width / 2, y: y - 10, width, height: 20 };
}

/** The ports of buffers by path. */
function endsOf(structure: Structure, boxes: readonly AgentBox[]): Map<string, Point> {
  const places = new Map(boxes.flatMap(({ subsystems }) => subsystems.map((one) => [one.path, one] as const)));
  const ends = new Map<string, Point>();
  for (const subsystem of structure.agents.flatMap((agent) => agent.subsystems)) {
    const box = places.get(subsystem.path)!;
    for (const direction of ["input", "output"] as const)
      subsystem.buffers
        .filter((buffer) => buffer.direction === direction)
        .forEach((buffer, at) =>
          ends.set(buffer.path, { x: box.x + (direction === "output" ? box.width : 0), y: box.y + head + at * row + row / 2 }),
        );
  }
  return ends;
}
