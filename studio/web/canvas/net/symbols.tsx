import { memo, type CSSProperties } from "react";
import { foldedPage, header, intersects, roundedPath, type Box, type Point, type Sheet } from "../../model/net/geometry";
import { conditionText, operationText, pageName, spoken } from "../../model/net/labels";
import type { NetModel, Page } from "../../model/net/net";
import { tipOf, type ArcKind, type Strokes } from "../../model/net/strokes";
import { mostFarArcs, strokes } from "./painted/arcs";
import { closedName, layerSize, runningSize } from "./closed_name";

/** The paper's graphic language: circle place, double circle page, bar transition, dashed fused place. */

interface PartProps {
  net: NetModel;
  page: number;
  index: number;
  box: Box;
  direction: "down" | "right";
  selected: boolean;
}

function Labels({ box, direction, lines }: { box: Box; direction: "down" | "right"; lines: { text: string; kind: string }[] }) {
  const shown = lines.filter((line) => line.text);
  const down = direction === "down";
  const x = down ? box.x + box.width + 6 : box.x + box.width / 2;
  const first = down ? box.y + box.height / 2 + 4 - (shown.length - 1) * 6.5 : box.y + box.height + 13;
  return shown.map((line, at) => (
    <text key={at} className={`label ${line.kind}`} x={x} y={first + at * 13} textAnchor={down ? "start" : "middle"}>
      {line.text}
    </text>
  ));
}

export const PlaceSymbol = memo(function PlaceSymbol({ net, page, index, box, direction, selected }: PartProps) {
  const on = net.page(page);
  const node = on.nodes[index]!;
  const flat = net.flatPlaces(page)[index]!;
  const path = net.places.at(flat)?.name ?? node.name;
  const [cx, cy, r] = [box.x + box.width / 2, box.y + box.height / 2, box.width / 2];
  return (
    <g
      className={`element place${node.fusion === null ? "" : " fused"}${selected ? " selected" : ""}`}
      data-path={path}
      role="img"
      aria-label={spoken(net, path)}
    >
      <circle className="shape" cx={cx} cy={cy} r={r} />
      <g className="tokens" data-place={flat} style={{ display: node.tokens > 0 ? "" : "none" }}>
        <circle className="token" cx={cx} cy={cy} r={5} />
        <text className="token-count" x={cx} y={cy + 4} textAnchor="middle" />
      </g>
      <Labels
        box={box}
        direction={direction}
        lines={[
          { text: node.name, kind: "name" },
          { text: operationText(on, node.operation), kind: "operation" },
        ]}
      />
    </g>
  );
});

export const BarSymbol = memo(function BarSymbol({ net, page, index, box, direction, selected }: PartProps) {
  const transition = net.page(page).transitions[index]!;
  const flat = net.flatTransitions(page)[index]!;
  const path = net.transitions.at(flat)?.name ?? transition.name;
  const never = transition.condition?.truth === "never";
  const wide = box.width > 80;
  const at = wide ? { ...box, x: box.x + box.width / 2 - 14, width: 28 } : box;
  return (
    <g
      className={`element bar${never ? " never" : ""}${selected ? " selected" : ""}`}
      data-path={path}
      data-transition={flat}
      role="img"
      aria-label={spoken(net, path)}
    >
      <rect className="reach" x={box.x - 6} y={box.y - 6} width={box.width + 12} height={box.height + 12} />
      <rect className="shape" x={box.x} y={box.y} width={box.width} height={box.height} rx={1.5} />
      {!wide && (
        <Labels
          box={at}
          direction={direction}
          lines={[
            { text: transition.name, kind: "name" },
            { text: conditionText(transition), kind: "condition" },
          ]}
        />
      )}
      <text
        className="label firings"
        x={wide ? box.x + box.width + 5 : box.x - 5}
        y={box.y + (direction === "down" ? 5 : -4)}
        textAnchor={wide ? "start" : "end"}
      />
    </g>
  );
});

interface PageSymbolProps extends PartProps {
  folded: boolean;
  /** Its net is drawn inside it, by a separate sheet. */
  open: boolean;
  /** So far away that a folded page is drawn as a dot. */
  far: boolean;
  /** One of so many, so far away, that an open page is a frame without a name. */
  bare: boolean;
  flagged: "error" | "warning" | null;
  onFold: (path: string, folded: boolean) => void;
}

export const PageSymbol = memo(function PageSymbol(props: PageSymbolProps) {
  const { net, page, index, box, direction, selected, folded, open, far, bare, flagged } = props;
  const child = net.page(page).nodes[index]!.page!;
  const of: Page = net.page(child);
  const group = (
    <>
      {folded ? <FoldedPage box={box} far={far} /> : <OpenPage page={of} box={box} open={open} child={child} bare={bare} />}
      {folded && !far && <Reach box={box} direction={direction} name={of.name} />}
      {folded && !far && <Labels box={box} direction={direction} lines={[{ text: of.name, kind: "name" }]} />}
      {flagged && (
        <circle className={`flag ${flagged}`} cx={box.x + box.width - (folded ? 4 : 14)} cy={box.y + (folded ? 4 : 11)} r={4.5} />
      )}
    </>
  );
  return (
    <g
      className={`element page ${of.layer}${folded ? " folded" : ""}${selected ? " selected" : ""}`}
      data-path={of.path}
      data-page={child}
      role="img"
      aria-label={spoken(net, of.path)}
    >
      {group}
    </g>
  );
});

function FoldedPage({ box, far }: { box: Box; far: boolean }) {
  const [cx, cy] = [box.x + box.width / 2, box.y + box.height / 2];
  return (
    <>
      <circle className="shape" cx={cx} cy={cy} r={foldedPage / 2} />
      {!far && <circle className="ring" cx={cx} cy={cy} r={foldedPage / 2 - 4} />}
      {!far && <circle className="token inside" cx={cx} cy={cy} r={6} />}
    </>
  );
}

/** The area between a folded page and its name belongs to the page, not to the frame below. */
function Reach({ box, direction, name }: { box: Box; direction: "down" | "right"; name: string }) {
  const length = 6 + 6.2 * name.length;
  const { x, y, width, height } = box;
  const [cx, cy] = [x + width / 2, y + height / 2];
  const [across, along] = [Math.max(width, length), height / 2 + 20];
  return direction === "down" ? (
    <rect className="reach" x={cx} y={cy - 9} width={width / 2 + length} height={18} />
  ) : (
    <rect className="reach" x={cx - across / 2} y={cy} width={across} height={along} />
  );
}

/**
 * A double circle stretched into a frame: its name above, its net inside; or its name in large letters
 * if the net is too small to read.
 */
function OpenPage({ page, box, open, child, bare }: { page: Page; box: Box; open: boolean; child: number; bare: boolean }) {
  if (bare) return <rect className="shape bare" x={box.x} y={box.y} width={box.width} height={box.height} rx={16} />;
  return (
    <>
      <rect className="shape" x={box.x} y={box.y} width={box.width} height={box.height} rx={16} />
      <rect className="ring" x={box.x + 3.5} y={box.y + 3.5} width={box.width - 7} height={box.height - 7} rx={13} />
      <text className="label frame-name" x={box.x + 14} y={box.y + header - 6} visibility={open ? "visible" : "hidden"}>
        {pageName(page)}
      </text>
      {open && (
        <text className="label running" data-running={child} x={box.x + box.width - 26} y={box.y + header - 6} textAnchor="end" />
      )}
      {!open && <ClosedName page={page} box={box} child={child} />}
    </>
  );
}

/**
 * The name in the middle of a page, broken into the lines that allow the largest letters; cut if the whole
 * name is too small.
 */
function ClosedName({ page, box, child }: { page: Page; box: Box; child: number }) {
  const { lines, cuts, x, y, size, more, layerAt, runningAt } = closedName(pageName(page), box);
  const middle = { x, textAnchor: "middle" as const };
  const style = { "--u": size, "--more": more } as CSSProperties;
  return (
    <g className="closed-name">
      {lines.map(({ text, shift }, at) => (
        <text key={at} className="label large" {...middle} y={y} dy={`${shift}em`} style={style}>
          {text}
        </text>
      ))}
      {cuts.map(({ text, from, to }) => (
        <text
          key={from}
          className="label cut"
          {...middle}
          y={y}
          dominantBaseline="central"
          style={{ "--from": from, "--to": to } as CSSProperties}
        >
          {text}
        </text>
      ))}
      <text className="label layer" {...middle} y={layerAt} style={{ "--u": layerSize(size) } as CSSProperties}>
        {page.layer}
      </text>
      <text
        className="label running"
        data-running={child}
        {...middle}
        y={runningAt}
        style={{ "--u": runningSize(size) } as CSSProperties}
      />
    </g>
  );
}

interface ArcsProps {
  net: NetModel;
  page: number;
  sheet: Sheet;
  /** So far away that tips are not visible: everything in one line. */
  far: boolean;
  clip: string;
}

/** Whether a box is in the drawn part. */
export function within(clip: string): (box: Box) => boolean {
  if (!clip) return () => true;
  const [x, y, width, height] = clip.split(",").map(Number) as [number, number, number, number];
  return (box) => intersects(box, { x, y, width, height });
}

function around(points: readonly Point[]): Box {
  const [xs, ys] = [points.map(({ x }) => x), points.map(({ y }) => y)];
  const [x, y] = [Math.min(...xs), Math.min(...ys)];
  return { x, y, width: Math.max(...xs) - x, height: Math.max(...ys) - y };
}

export const Arcs = memo(function Arcs({ net, page, sheet, far, clip }: ArcsProps) {
  const { nodes, transitions } = net.page(page);
  if (far && sheet.routes.length > mostFarArcs) return null;
  if (far || sheet.grid) return <SharedArcs strokes={strokes(net, page, sheet, far)} far={far} clip={clip} />;
  const isDrawn = within(clip);
  return sheet.routes.map((route, at) => {
    if (clip && !isDrawn(around(route.points))) return null;
    const never = transitions[route.transition]?.condition?.truth === "never";
    const fused = nodes[route.node]?.fusion !== null;
    return (
      <path
        key={at}
        className={`arc${never ? " never" : ""}${fused ? " memory" : ""}`}
        d={roundedPath(route.points)}
        markerEnd={`url(#tip${never ? "-never" : ""})`}
      />
    );
  });
});

/** The arcs of a grid run in the same lanes, so what they share is one line. Tips and kinds are not visible far away. */
function SharedArcs({ strokes, far, clip }: { strokes: ReadonlyMap<ArcKind, Strokes>; far: boolean; clip: string }) {
  const isDrawn = within(clip);
  return [...strokes].map(([kind, { lines, slanted, corners, tips }]) => {
    const path: string[] = [];
    const tipPath: string[] = [];
    for (const all of [lines, slanted])
      for (let at = 0; at < all.length; at += 4) {
        const [x1, y1, x2, y2] = all.subarray(at, at + 4) as unknown as [number, number, number, number];
        const box = { x: Math.min(x1, x2), y: Math.min(y1, y2), width: Math.abs(x2 - x1) + 0.1, height: Math.abs(y2 - y1) + 0.1 };
        if (isDrawn(box)) path.push(`M${tenth(x1)} ${tenth(y1)}L${tenth(x2)} ${tenth(y2)}`);
      }
    for (let at = 0; at < corners.length; at += 6) {
      const [x1, y1, x, y, x2, y2] = [...corners.subarray(at, at + 6)].map(tenth) as [number, number, number, number, number, number]; // prettier-ignore
      if (isDrawn({ x: x - 8, y: y - 8, width: 16, height: 16 })) path.push(`M${x1} ${y1}Q${x} ${y} ${x2} ${y2}`);
    }
    for (let at = 0; at < (far ? 0 : tips.length); at += 4)
      if (isDrawn({ x: tips[at]! - 8, y: tips[at + 1]! - 8, width: 16, height: 16 }))
        tipPath.push(`M${tipOf(tips, at).map(({ x, y }) => `${tenth(x)} ${tenth(y)}`).join("L")}Z`); // prettier-ignore
    return (
      <g key={kind}>
        <path className={`arc${kind && !far ? ` ${kind}` : ""}`} d={path.join("")} />
        {tipPath.length > 0 && <path className={kind === "never" ? "tip-never" : "tip"} d={tipPath.join("")} />}
      </g>
    );
  });
}
const tenth = (value: number) => Math.round(value * 10) / 10;

export function ArrowTips() {
  return (
    <svg width="0" height="0" aria-hidden="true" style={{ position: "absolute" }}>
      <defs>
        {["", "-never"].map((kind) => (
          <marker
            key={kind}
            id={`tip${kind}`}
            viewBox="0 0 10 8"
            refX="9.5"
            refY="4"
            markerWidth="8"
            markerHeight="6.4"
            markerUnits="userSpaceOnUse"
            orient="auto"
          >
            <path className={`tip${kind}`} d="M0 0L10 4L0 8L2.5 4Z" />
          </marker>
        ))}
      </defs>
    </svg>
  );
}
