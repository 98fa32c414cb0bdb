/** Sizes and positions of drawn nets. Units are pixels at zoom 1 on the page's own sheet. */

export interface Point {
  x: number;
  y: number;
}
export interface Box extends Point {
  width: number;
  height: number;
}
/** An arc as drawn: from a node to a transition or back. */
export interface Route {
  /** Index of the transition on its page. */
  transition: number;
  node: number;
  into: "node" | "transition";
  points: Point[];
}
/** The drawing of one page: the boxes of the symbols; labels stand beside them. */
export interface Sheet {
  width: number;
  height: number;
  nodes: Box[];
  transitions: Box[];
  routes: Route[];
  /** The direction of the net: down (labels to the right) or right (labels below). */
  direction: "down" | "right";
  /** Whether its pages are in a grid, with lanes of arcs beside the columns. */
  grid?: boolean;
}

export const place = 24;
export const foldedPage = 40;
export const bar = { long: 34, thick: 6 };
/** Height of the title strip of an open page. */
export const header = 22;
export const margin = 24;

/** The approximate width of a text in the drawing's font. */
export const textWidth = (text: string, size = 11) => text.length * size * 0.58;

/** An SVG path along points, with rounded corners. */
export function roundedPath(points: readonly Point[], radius = 7): string {
  const [first, ...rest] = points;
  if (!first) return "";
  let path = `M${round(first.x)} ${round(first.y)}`;
  rest.forEach((point, index) => {
    const before = points[index]!;
    const after = points[index + 2];
    if (!after) {
      path += `L${round(point.x)} ${round(point.y)}`;
      return;
    }
    const enter = towards(point, before, radius);
    const leave = towards(point, after, radius);
    path += `L${round(enter.x)} ${round(enter.y)}Q${round(point.x)} ${round(point.y)} ${round(leave.x)} ${round(leave.y)}`;
  });
  return path;
}

const round = (value: number) => Math.round(value * 10) / 10;

function towards(from: Point, to: Point, distance: number): Point {
  const length = Math.hypot(to.x - from.x, to.y - from.y);
  const part = length === 0 ? 0 : Math.min(distance, length / 2) / length;
  return { x: from.x + (to.x - from.x) * part, y: from.y + (to.y - from.y) * part };
}

export const intersects = (a: Box, b: Box) =>
  a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;

/** The intersection of two boxes. */
export function overlap(a: Box, b: Box): Box | undefined {
  if (!intersects(a, b)) return undefined;
  const [x, y] = [Math.max(a.x, b.x), Math.max(a.y, b.y)];
  return { x, y, width: Math.min(a.x + a.width, b.x + b.width) - x, height: Math.min(a.y + a.height, b.y + b.height) - y };
}
