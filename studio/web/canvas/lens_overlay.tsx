import { useReactFlow, useStore as useFlow, ViewportPortal } from "@xyflow/react";
import { useEffect, useRef } from "react";
import { useStore, useStudio } from "../hooks/use";
import type { Stuck } from "../live/lens";
import type { Box, Point } from "../model/geometry";

const still = matchMedia("(prefers-reduced-motion: reduce)");

/**
 * Greys all but those who have to do with a standstill, and draws who waits for whom. Flies to them once when
 * it is asked for.
 *
 * boxOf: where a subsystem is drawn; undefined: not yet, or not at all.
 */
export function LensOverlay({
  whole,
  boxOf,
  version,
}: {
  whole: Box;
  boxOf: (path: string) => Box | undefined;
  version: unknown;
}) {
  const studio = useStudio();
  const { shown, request } = useStore(studio.lens.store, (all) => all);
  const flow = useReactFlow();
  const zoom = useFlow((state) => state.transform[2]);
  const ready = useFlow((state) => state.width > 0);
  const flown = useRef(0);
  const boxes = new Map(
    (shown?.concerned ?? []).flatMap((path) => {
      const box = boxOf(path);
      return box ? [[path, box] as const] : [];
    }),
  );
  useEffect(() => {
    if (!shown || !ready || flown.current === request || boxes.size < shown.concerned.length) return;
    flown.current = request;
    const bounds = around([...boxes.values()]);
    if (bounds) void flow.fitBounds(bounds, { duration: still.matches ? 0 : 450, padding: 0.25 });
  }, [shown, request, ready, boxes.size, version, flow]);
  if (!shown || boxes.size === 0) return null;
  return <Drawn shown={shown} whole={whole} boxes={boxes} zoom={zoom} />;
}

function Drawn({ shown, whole, boxes, zoom }: { shown: Stuck; whole: Box; boxes: ReadonlyMap<string, Box>; zoom: number }) {
  // Lines and letters have the same size on screen, however near the drawing is.
  const unit = 1 / zoom;
  const far = 4000;
  const outside = { x: whole.x - far, y: whole.y - far, width: whole.width + 2 * far, height: whole.height + 2 * far };
  const rim = 6 * unit;
  const holes = [...boxes.values()].map((box) => grown(box, rim));
  const stuck = new Set(shown.stuck);
  return (
    <ViewportPortal>
      <svg
        className="lens"
        data-testid="lens"
        style={{ left: outside.x, top: outside.y }}
        width={outside.width}
        height={outside.height}
        viewBox={[outside.x, outside.y, outside.width, outside.height].join(" ")}
      >
        <defs>
          <marker
            id="lens-tip"
            viewBox="0 0 10 10"
            refX="9"
            refY="5"
            markerWidth="7"
            markerHeight="7"
            orient="auto-start-reverse"
          >
            <path d="M0 0L10 5L0 10z" />
          </marker>
        </defs>
        <path className="lens-grey" fillRule="evenodd" d={[outside, ...holes].map(rectangle).join("")} />
        {[...boxes].map(([path, box]) => (
          <rect
            key={path}
            className={stuck.has(path) ? "lens-stuck" : "lens-awaited"}
            data-lens={path}
            {...grown(box, rim / 2)}
            rx={6 * unit}
            strokeWidth={3 * unit}
          />
        ))}
        {shown.waits.map(({ who, whom, channel, awaited }) => {
          const [from, to] = [boxes.get(who), boxes.get(whom)];
          if (!from || !to) return null;
          const way = who === whom ? loop(from, unit) : bent(from, to, unit);
          return (
            <g key={`${who} ${whom} ${channel}`} className="lens-wait">
              <path d={way.path} strokeWidth={2.5 * unit} markerEnd="url(#lens-tip)" />
              <text x={way.middle.x} y={way.middle.y} fontSize={12 * unit} strokeWidth={4 * unit} textAnchor={way.anchor}>
                waits for {awaited === "value" ? "a value" : awaited === "nothing" ? "it" : `the ${awaited}`}
              </text>
            </g>
          );
        })}
      </svg>
    </ViewportPortal>
  );
}

const grown = ({ x, y, width, height }: Box, by: number): Box => ({
  x: x - by,
  y: y - by,
  width: width + 2 * by,
  height: height + 2 * by,
});

const rectangle = ({ x, y, width, height }: Box) => `M${x} ${y}h${width}v${height}h${-width}z`;

const middle = ({ x, y, width, height }: Box): Point => ({ x: x + width / 2, y: y + height / 2 });

export function around(boxes: readonly Box[]): Box | undefined {
  if (boxes.length === 0) return undefined;
  const x = Math.min(...boxes.map((box) => box.x));
  const y = Math.min(...boxes.map((box) => box.y));
  const right = Math.max(...boxes.map((box) => box.x + box.width));
  const bottom = Math.max(...boxes.map((box) => box.y + box.height));
  return { x, y, width: right - x, height: bottom - y };
}

interface Way {
  path: string;
  /** Beside the arrow, on its outer side. */
  middle: Point;
  anchor: "start" | "middle" | "end";
}

/** An arrow between the rims of two boxes, bent to one side, so that those of a circle stay apart. */
function bent(from: Box, to: Box, unit: number): Way {
  const [a, b] = [middle(from), middle(to)];
  const length = Math.hypot(b.x - a.x, b.y - a.y) || 1;
  const side = Math.min(60 * unit, length / 4);
  const out = { x: -(b.y - a.y) / length, y: (b.x - a.x) / length };
  const control = { x: (a.x + b.x) / 2 - ((b.y - a.y) / length) * side, y: (a.y + b.y) / 2 + ((b.x - a.x) / length) * side };
  const [start, end] = [atRim(from, control), atRim(to, control)];
  return {
    path: `M${start.x} ${start.y}Q${control.x} ${control.y} ${end.x} ${end.y}`,
    middle: {
      x: (start.x + 2 * control.x + end.x) / 4 + out.x * 8 * unit,
      y: (start.y + 2 * control.y + end.y) / 4 + (out.y * 12 + 3) * unit,
    },
    anchor: out.x > 0.4 ? "start" : out.x < -0.4 ? "end" : "middle",
  };
}

/** Where the line from the middle of a box to a point leaves the box. */
function atRim(box: Box, to: Point): Point {
  const from = middle(box);
  const [dx, dy] = [to.x - from.x, to.y - from.y];
  const part = Math.min(
    dx === 0 ? Infinity : box.width / 2 / Math.abs(dx),
    dy === 0 ? Infinity : box.height / 2 / Math.abs(dy),
    1,
  );
  return { x: from.x + dx * part, y: from.y + dy * part };
}

function loop(box: Box, unit: number): Way {
  const [x, y] = [box.x + box.width / 2, box.y];
  const size = 46 * unit;
  return {
    path: `M${x - size / 2} ${y}C${x - size} ${y - size} ${x + size} ${y - size} ${x + size / 2} ${y}`,
    middle: { x, y: y - size },
    anchor: "middle",
  };
}
