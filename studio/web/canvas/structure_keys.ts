import type { Studio } from "../live/studio";
import { findThing, nextEntryOf, nextSelection, selectedPath, withoutIndex, type Structure } from "../model/structure/structure";
import { inside, nextIn, outside, type Direction, type Shown } from "../model/structure/walk";

/** The keys of the drawing of the structure: every element can be reached, changed and moved without a pointer. */

export interface KeyContext {
  studio: Studio;
  structure: Structure;
  area: HTMLElement;
  selected: string | null;
  /** Opens the menu of what is selected. */
  menu: () => void;
  /** Focuses the field with the name of what is selected. */
  rename: () => void;
  /** Moves the box of what is selected; false: it is no box. */
  move: (direction: Direction) => boolean;
  /** Shows an element that is out of sight, or not drawn at this zoom. */
  show: (path: string) => void;
}

const directions: Record<string, Direction> = { ArrowLeft: "left", ArrowRight: "right", ArrowUp: "up", ArrowDown: "down" };

const isField = (target: EventTarget | null) =>
  target instanceof HTMLInputElement ||
  target instanceof HTMLTextAreaElement ||
  target instanceof HTMLSelectElement ||
  (target instanceof HTMLElement && target.isContentEditable);

/** The button of an element in the drawing; undefined: it is not drawn. */
export function elementAt(area: HTMLElement, selection: string): HTMLElement | undefined {
  const of = (attribute: string, value: string) => area.querySelector<HTMLElement>(`[${attribute}="${CSS.escape(value)}"]`);
  const entry = nextEntryOf(selection);
  if (entry !== undefined) {
    const from = CSS.escape(selectedPath(selection));
    return area.querySelector<HTMLElement>(`[data-from="${from}"][data-entry="${entry}"]`) ?? undefined;
  }
  return of("data-selection", selection) ?? of("data-path", selection) ?? of("data-path", selectedPath(selection)) ?? undefined;
}

/** The buttons beside an element: agents beside agents, subsystems beside subsystems, what is in a subsystem beside its like. */
function beside(area: HTMLElement, structure: Structure, selected: string): Shown[] {
  const level = (selection: string): string | undefined => {
    const thing = findThing(structure, withoutIndex(selection));
    if (!thing) return undefined;
    if (thing.kind === "behaviour" || thing.kind === "buffer") return thing.subsystem.path;
    return thing.kind;
  };
  const own = level(selected);
  return [...area.querySelectorAll<HTMLElement>("[data-path]")].flatMap((element) => {
    const path = element.dataset.selection ?? element.dataset.path!;
    if (path !== selected && level(path) !== own) return [];
    const { x, y, width, height } = element.getBoundingClientRect();
    return width > 0 && height > 0 ? [{ path, x, y, width, height }] : [];
  });
}

function step(context: KeyContext, direction: Direction): void {
  const { area, structure, selected } = context;
  if (selected === null) return go(context, structure.agents[0]?.name ?? null);
  const entry = nextEntryOf(selected);
  if (entry !== undefined) {
    // The entries of one behaviour, one after the other.
    const thing = findThing(structure, selected);
    const count = thing?.kind === "behaviour" ? thing.of.next.length : 0;
    const by = direction === "right" || direction === "down" ? 1 : -1;
    const to = entry + by;
    if (to >= 0 && to < count) go(context, nextSelection(selectedPath(selected), to));
    return;
  }
  const boxes = beside(area, structure, selected);
  const from = boxes.find(({ path }) => path === selected) ?? boxes.find(({ path }) => selectedPath(path) === selected);
  const next = from && nextIn(boxes, from, direction);
  if (next !== undefined) go(context, next);
}

/** Selects an element, shows it and focuses it. */
function go({ studio, structure, area, show }: KeyContext, path: string | null): void {
  studio.choose(path, structure);
  if (path === null) return area.focus({ preventScroll: true });
  show(path);
  requestAnimationFrame(() => elementAt(area, path)?.focus({ preventScroll: true }));
}

/** Handles a key on the drawing; false: the key has no function there. */
export function structureKey(event: KeyboardEvent, context: KeyContext): boolean {
  const { studio, structure, selected } = context;
  if (isField(event.target) || event.altKey) return false;
  const thing = selected === null ? undefined : findThing(structure, withoutIndex(selected));
  if (event.ctrlKey || event.metaKey) {
    if (event.key.toLowerCase() !== "d" || selected === null) return false;
    void studio.elements.duplicate(selected);
    return true;
  }
  const direction = directions[event.key];
  if (direction) {
    if (event.shiftKey) return context.move(direction);
    step(context, direction);
    return true;
  }
  switch (event.key) {
    case "ContextMenu":
      context.menu();
      return true;
    case "F10":
      if (!event.shiftKey) return false;
      context.menu();
      return true;
    case "F2":
      if (!thing || thing.kind === "channel") return false;
      context.rename();
      return true;
    case "Delete":
    case "Backspace":
      if (selected === null) return false;
      void studio.elements.remove(selected);
      return true;
    case "Enter": {
      // On an element that is not selected, Enter selects it, as a click does.
      const at = (event.target as HTMLElement).closest<HTMLElement>("[data-path]");
      if (!at && event.target instanceof HTMLButtonElement) return false;
      if (at && selected !== (at.dataset.selection ?? at.dataset.path) && nextEntryOf(selected ?? "") === undefined) return false;
      const into = inside(structure, selected);
      if (into === undefined) return false;
      go(context, into);
      return true;
    }
    case "Escape":
      if (selected === null) return false;
      if (nextEntryOf(selected) !== undefined) go(context, selectedPath(selected));
      else go(context, thing ? outside(thing) : null);
      return true;
    default:
      return false;
  }
}
