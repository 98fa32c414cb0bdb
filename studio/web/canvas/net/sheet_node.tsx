import type { NodeProps, Node } from "@xyflow/react";
import { memo, useEffect, useRef, type CSSProperties } from "react";
import { useStudio } from "../../hooks/use";
import { numbered } from "../../live/breakpoints";
import type { Stage } from "../../live/stage";
import type { NetModel } from "../../model/net/net";
import type { Placed } from "../../model/net/sheets";
import { Marks } from "./marks";
import { paint } from "./paint";
import { Arcs, BarSymbol, PageSymbol, PlaceSymbol, within } from "./symbols";

export interface SheetData extends Record<string, unknown> {
  net: NetModel;
  placed: Placed;
  /** Pages whose nets are drawn by separate sheets. */
  open: string;
  folded: string;
  /** The distance of the sheet (`nearness`). */
  near: number;
  /** Its pages are frames without names (`isBare`). */
  bare: boolean;
  /** The part that is drawn, "x,y,width,height"; empty: all of it. */
  clip: string;
  selected: string | null;
  flags: ReadonlyMap<string, "error" | "warning">;
  /** The stage whose tokens are shown. */
  stage: Stage;
}
export type SheetNode = Node<SheetData, "sheet">;

/** The net of one page. Its symbols carry the numbers by which tokens are placed on them. */
export const SheetNodeView = memo(function SheetNodeView({ data }: NodeProps<SheetNode>) {
  const studio = useStudio();
  const ref = useRef<SVGSVGElement>(null);
  const { net, placed, open, folded, near, bare, clip, selected, flags, stage } = data;
  const { page, sheet, scale } = placed;
  const opened = new Set(open.split(",").map(Number));
  const closed = new Set(folded.split(",").map(Number));
  useEffect(() => {
    const { store } = studio.runner;
    let last = store.get().breakpoints;
    const now = () => ref.current && stage.is(net) && paint(ref.current, new Marks(net, stage, numbered(net, last).found));
    now();
    const told = store.subscribe(() => {
      const { breakpoints } = store.get();
      if (breakpoints === last) return;
      last = breakpoints;
      now();
    });
    const leave = stage.subscribe(now);
    return () => (told(), leave());
  }, [net, stage, sheet, open, folded, clip, selected, studio]);
  const far = near <= -3;
  const isDrawn = within(clip);
  const parts = { net, page, direction: sheet.direction };
  const labelled = (isClosed: boolean) => (isClosed && sheet.grid ? "right" : sheet.direction);
  const drawn = net.page(page);
  return (
    <svg
      ref={ref}
      className={`sheet layer-${drawn.layer} near${data.near}`}
      width={sheet.width}
      height={sheet.height}
      style={{ transform: `scale(${scale})`, transformOrigin: "0 0", "--scale": scale } as CSSProperties}
      data-sheet={drawn.path || "system"}
      data-of={page}
    >
      <Arcs net={net} page={page} sheet={sheet} far={far} clip={clip} />
      {drawn.nodes.map((node, index) => {
        const box = sheet.nodes[index]!;
        if (!isDrawn(box)) return null;
        if (node.page === null)
          return <PlaceSymbol key={index} {...parts} index={index} box={box} selected={isSelected(net, page, index, selected)} />;
        const path = net.page(node.page).path;
        return (
          <PageSymbol
            key={index}
            {...parts}
            direction={labelled(closed.has(node.page))}
            index={index}
            box={box}
            selected={selected === path}
            folded={closed.has(node.page)}
            open={opened.has(node.page)}
            far={far}
            bare={bare}
            flagged={flags.get(path) ?? null}
            onFold={(at, to) => studio.fold(at, to)}
          />
        );
      })}
      {drawn.transitions.map((_, index) => (
        <BarSymbol
          key={index}
          {...parts}
          index={index}
          box={sheet.transitions[index]!}
          selected={selected !== null && net.transitions.at(net.flatTransitions(page)[index]!)?.name === selected}
        />
      ))}
    </svg>
  );
});

const isSelected = (net: NetModel, page: number, node: number, selected: string | null) =>
  selected !== null && net.places.at(net.flatPlaces(page)[node]!)?.name === selected;
