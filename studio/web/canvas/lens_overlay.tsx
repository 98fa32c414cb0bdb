import { useReactFlow, useStore as useFlow, ViewportPortal, type ReactFlowState } from "@xyflow/react";
import { useEffect, useRef } from "react";
import { useStore, useStudio } from "../hooks/use";
import { useLens } from "../hooks/use_lens";
import type { Stuck } from "../live/lens";
import type { Box } from "../model/net/geometry";
import type { NetModel } from "../model/net/net";
import { around, arrows, grown, type Arrow } from "../model/structure/lens_layout";

const still = matchMedia("(prefers-reduced-motion: reduce)");
const windowOf = (state: ReactFlowState) => [...state.transform, state.width, state.height].join();

/**
 * Greys everything except the subsystems of a standstill, and draws which of them waits for which. Flies to
 * them once on request.
 *
 * net: the net of the drawing; the lens is shown only on the net in which the subsystems stand still. boxOf:
 * the box of a subsystem; undefined: not drawn, or not yet. names: the boxes of other names, which stay readable.
 */
export function LensOverlay({
  net,
  whole,
  boxOf,
  names,
  version,
}: {
  net: NetModel | null;
  whole: Box;
  boxOf: (path: string) => Box | undefined;
  names: readonly Box[];
  version: unknown;
}) {
  const studio = useStudio();
  const shown = useLens(net);
  const request = useStore(studio.lens.store, (all) => all.request);
  const flow = useReactFlow();
  const [x, y, zoom, width, height] = useFlow(windowOf).split(",").map(Number) as [number, number, number, number, number];
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
  const window = { x: -x / zoom, y: -y / zoom, width: width / zoom, height: height / zoom };
  return (
    <Drawn shown={shown} whole={whole} boxes={boxes} drawn={arrows(shown.waits, boxes, names, window, 1 / zoom)} zoom={zoom} />
  );
}

interface DrawnProps {
  shown: Stuck;
  whole: Box;
  boxes: ReadonlyMap<string, Box>;
  drawn: readonly Arrow[];
  zoom: number;
}

function Drawn({ shown, whole, boxes, drawn, zoom }: DrawnProps) {
  // Lines and letters have the same size on screen at every zoom.
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
        {drawn.map(({ key, path, label, text }) => (
          <g key={key} className="lens-wait">
            <path d={path} strokeWidth={2.5 * unit} markerEnd="url(#lens-tip)" />
            <text x={label.x} y={label.y + 11.5 * unit} fontSize={12 * unit} strokeWidth={4 * unit}>
              {text}
            </text>
          </g>
        ))}
      </svg>
    </ViewportPortal>
  );
}

const rectangle = ({ x, y, width, height }: Box) => `M${x} ${y}h${width}v${height}h${-width}z`;
