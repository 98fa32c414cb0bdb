import { useReactFlow, useStore as useFlow, type ReactFlowState } from "@xyflow/react";
import { useCallback, useEffect, useRef, useState, type RefObject } from "react";
import { useStore, useStudio } from "../../hooks/use";
import {
  findThing,
  nextEntryOf,
  nextSelection,
  selectedPath,
  withoutIndex,
  type Structure,
} from "../../model/structure/structure";
import type { Box } from "../../model/net/geometry";
import type { Direction } from "../../model/structure/walk";
import { dragElements } from "./element_drag";
import { LeadOnForm, type LeadOn } from "../lead_on";
import { elementAt, structureKey } from "./structure_keys";
import { itemsFor, renameInForm, StructureMenu, type OpenMenu } from "./structure_menu";

const still = matchMedia("(prefers-reduced-motion: reduce)");

interface Hands {
  structure: Structure;
  /** The element of the page with the drawing. */
  area: RefObject<HTMLDivElement | null>;
  boxes: ReadonlyMap<string, Box>;
  /** Moves a box by units of the drawing; false: there is no such box. */
  move: (path: string, by: { x: number; y: number }, end: boolean) => boolean;
  /** Gives up all moves of boxes; undefined: none was moved. */
  arrange: (() => unknown) | undefined;
  /** A drag has begun: the click that ends it selects nothing. */
  onDrag: () => void;
}

/** The arrow of a drag that is not done. */
interface Line {
  x1: number;
  y1: number;
  x2: number;
  y2: number;
}

/** Units of the drawing that a box moves with an arrow key. */
const nudge = 20;
const nudges: Record<Direction, { x: number; y: number }> = {
  left: { x: -nudge, y: 0 },
  right: { x: nudge, y: 0 },
  up: { x: 0, y: -nudge },
  down: { x: 0, y: nudge },
};

const isEditable = (element: Element | null) =>
  element instanceof HTMLInputElement ||
  element instanceof HTMLTextAreaElement ||
  element instanceof HTMLSelectElement ||
  (element instanceof HTMLElement && element.isContentEditable);

const transformOf = ({ transform, width, height }: ReactFlowState) => [...transform, width, height].join();

/** Work by hand on elements of the structure: menu, keys, clipboard, drags. It is a child of the drawing. */
export function StructureHands({ structure, area, boxes, move, arrange, onDrag }: Hands) {
  const studio = useStudio();
  const flow = useReactFlow();
  const selected = useStore(studio.view, (view) => view.selected);
  const [menu, setMenu] = useState<OpenMenu | null>(null);
  const [leading, setLeading] = useState<LeadOn | null>(null);
  const [line, setLine] = useState<Line | null>(null);
  const closeMenu = useCallback(() => setMenu(null), []);
  const closeForm = useCallback(() => setLeading(null), []);

  const cornerOf = (path: string | null): { x: number; y: number } => {
    const at = (path !== null && elementAt(area.current!, path)) || area.current!;
    const { x, y, width, height } = at.getBoundingClientRect();
    return at === area.current ? { x: x + width / 3, y: y + height / 3 } : { x: x + Math.min(width / 2, 60), y: y + height };
  };
  const show = (path: string) => {
    const element = elementAt(area.current!, path);
    const own = element?.getBoundingClientRect();
    const room = area.current!.getBoundingClientRect();
    const visible =
      own && own.width > 0 && own.x >= room.x && own.y >= room.y && own.right <= room.right && own.bottom <= room.bottom;
    const box = boxes.get(selectedPath(path).split(".").slice(0, 2).join("."));
    if (!visible && box) void flow.fitBounds(box, { duration: still.matches ? 0 : 250, padding: 0.3 });
  };

  // The listeners see the present state without being made anew.
  const now = useRef({ structure, selected, move, show, cornerOf, onDrag });
  now.current = { structure, selected, move, show, cornerOf, onDrag };

  useEffect(() => {
    const at = area.current!;
    const key = (event: KeyboardEvent) => {
      const { structure, selected, move, show, cornerOf } = now.current;
      const done = structureKey(event, {
        studio,
        structure,
        area: at,
        selected,
        menu: () => setMenu({ path: selected, ...cornerOf(selected) }),
        rename: () => selected !== null && renameInForm(studio, selected, structure),
        move: (direction) => selected !== null && move(selectedPath(selected), nudges[direction], true),
        show,
      });
      if (!done) return;
      event.preventDefault();
      event.stopPropagation();
    };
    const context = (event: MouseEvent) => {
      event.preventDefault();
      const target = event.target as Element;
      const path = selectionAt(target);
      studio.choose(path, now.current.structure);
      setMenu({ path, x: event.clientX, y: event.clientY });
    };
    // Only while the drawing, and no field or text of the page, has the attention.
    const isHere = () =>
      !isEditable(document.activeElement) &&
      (document.activeElement === document.body || at.contains(document.activeElement)) &&
      document.getSelection()?.isCollapsed !== false;
    const copy = (event: ClipboardEvent) => {
      if (!isHere()) return;
      const text = studio.elements.copy(now.current.selected);
      if (text === undefined) return;
      event.clipboardData?.setData("text/plain", text);
      event.preventDefault();
    };
    const paste = (event: ClipboardEvent) => {
      if (!isHere()) return;
      event.preventDefault();
      void studio.elements.paste(event.clipboardData?.getData("text/plain") ?? "");
    };
    at.addEventListener("keydown", key);
    at.addEventListener("contextmenu", context);
    document.addEventListener("copy", copy);
    document.addEventListener("paste", paste);
    const stop = dragElements(at, {
      zoom: () => flow.getZoom(),
      isBehaviour: (path) => findThing(now.current.structure, path)?.kind === "behaviour",
      begins: () => now.current.onDrag(),
      moves: (path, by, end) => void now.current.move(path, by, end),
      line: setLine,
      leads: (from, to, x, y) => {
        const { structure } = now.current;
        const [source, target] = [findThing(structure, from), findThing(structure, to)];
        if (source?.kind !== "behaviour" || target?.kind !== "behaviour") return;
        if (source.subsystem.path !== target.subsystem.path || source.of.group !== target.of.group)
          studio.draft.store.set({ notice: "A behaviour goes on with behaviours of its own subsystem and group" });
        else setLeading({ from, to: target.of.name, x, y });
      },
    });
    return () => {
      at.removeEventListener("keydown", key);
      at.removeEventListener("contextmenu", context);
      document.removeEventListener("copy", copy);
      document.removeEventListener("paste", paste);
      stop();
    };
  }, [studio, flow, area]);

  const items =
    menu && itemsFor(studio, structure, menu.path, { leadOn: (from) => setLeading({ from, ...cornerOf(from) }), arrange });
  return (
    <>
      {line && (
        <svg className="drag-line" aria-hidden="true">
          <line {...line} markerEnd="url(#channel-tip)" />
        </svg>
      )}
      {!menu && !leading && !line && (
        <MoreButton area={area} selected={selected} onOpen={(x, y) => setMenu({ path: selected, x, y })} />
      )}
      {menu && items && <StructureMenu open={menu} items={items} onClose={closeMenu} />}
      {leading && <LeadOnForm structure={structure} of={leading} onClose={closeForm} />}
    </>
  );
}

/** The element at a click: an entry of `next` at its arrow. */
export function selectionAt(target: Element): string | null {
  const arrow = target.closest<SVGElement>("[data-entry]");
  if (arrow) return nextSelection(arrow.dataset.from!, Number(arrow.dataset.entry));
  const at = target.closest<HTMLElement>("[data-path]");
  return at?.dataset.selection ?? at?.dataset.path ?? target.closest<SVGElement>("[data-reach]")?.dataset.reach ?? null;
}

/** The button at the selected element that opens its menu. */
function MoreButton({
  area,
  selected,
  onOpen,
}: {
  area: Hands["area"];
  selected: string | null;
  onOpen: (x: number, y: number) => void;
}) {
  const view = useFlow(transformOf);
  const [place, setPlace] = useState<{ left: number; top: number } | null>(null);
  // Not a layout effect: the element around this one does not exist then.
  useEffect(() => {
    const look = () => {
      const at = area.current;
      const element = at && selected !== null && nextEntryOf(selected) === undefined ? elementAt(at, selected) : undefined;
      const [own, room] = [element?.getBoundingClientRect(), at?.getBoundingClientRect()];
      if (!own || !room || own.width < 40 || own.height < 12) return setPlace(null);
      const [left, top] = [own.right - room.x - 9, own.y - room.y - 13];
      setPlace(
        left < 0 || top < -13 || left > room.width - 24 || top > room.height - 24 ? null : { left, top: Math.max(top, 0) },
      );
    };
    look();
    // The drawing arrives a moment after its text.
    const seen = new MutationObserver(look);
    seen.observe(area.current!, { subtree: true, childList: true, attributeFilter: ["style", "aria-pressed"] });
    return () => seen.disconnect();
  }, [area, selected, view]);
  if (!place || selected === null) return null;
  return (
    <button
      className="more-button"
      style={place}
      aria-haspopup="menu"
      aria-label={`What can be done with ${selectedPath(withoutIndex(selected))}`}
      title="More (Shift F10)"
      onClick={(event) => {
        event.stopPropagation();
        const { x, bottom } = event.currentTarget.getBoundingClientRect();
        onOpen(x, bottom + 2);
      }}
    >
      ⋯
    </button>
  );
}
