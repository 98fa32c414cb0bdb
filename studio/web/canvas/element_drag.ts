/**
 * Drags of elements of the structure: the head of a box moves it, and from behaviour to behaviour an arrow is drawn. React
 * Flow moves the view with all that has no class "nopan", so an element gets it before the drag reaches React Flow.
 */

export interface Drags {
  zoom: () => number;
  isBehaviour: (path: string) => boolean;
  /** A drag has begun: it is no click. */
  begins: () => void;
  /** by: units of the drawing since the drag began. end: it ends here. */
  moves: (path: string, by: { x: number; y: number }, end: boolean) => void;
  /** The line from a behaviour to the pointer, in pixels of the area; null: there is none any more. */
  line: (line: { x1: number; y1: number; x2: number; y2: number } | null) => void;
  leads: (from: string, to: string, x: number, y: number) => void;
}

/** Pixels that the pointer has to move: a click with a trembling hand is none. */
const least = 5;
const heads = ".agent-name, .subsystem-head";

export function dragElements(area: HTMLElement, drags: Drags): () => void {
  let stop = () => {};
  const down = (event: PointerEvent) => {
    if (event.button !== 0 || !(event.target instanceof Element)) return;
    const at = event.target.closest<HTMLElement>("[data-path]");
    const path = at?.dataset.path;
    if (!at || path === undefined) return;
    const isHead = at.matches(heads);
    const isBehaviour = !isHead && at.dataset.selection === undefined && drags.isBehaviour(path);
    if (!isHead && !isBehaviour) return;
    at.classList.add("nopan");
    stop();
    stop = follow(event, at, path, isHead);
  };
  const follow = (begin: PointerEvent, at: HTMLElement, path: string, isHead: boolean): (() => void) => {
    let begun = false;
    let target: HTMLElement | null = null;
    const room = area.getBoundingClientRect();
    const by = (event: PointerEvent) => ({
      x: (event.clientX - begin.clientX) / drags.zoom(),
      y: (event.clientY - begin.clientY) / drags.zoom(),
    });
    const mark = (next: HTMLElement | null) => {
      target?.classList.remove("drop-target");
      target = next;
      target?.classList.add("drop-target");
    };
    const move = (event: PointerEvent) => {
      if (!begun && Math.hypot(event.clientX - begin.clientX, event.clientY - begin.clientY) < least) return;
      if (!begun) drags.begins();
      begun = true;
      if (isHead) return drags.moves(path, by(event), false);
      const own = at.getBoundingClientRect();
      const [x1, y1] = [own.x + own.width / 2 - room.x, own.y + own.height / 2 - room.y];
      drags.line({ x1, y1, x2: event.clientX - room.x, y2: event.clientY - room.y });
      const under = document.elementFromPoint(event.clientX, event.clientY)?.closest<HTMLElement>("[data-path]") ?? null;
      mark(under !== null && under !== at && drags.isBehaviour(under.dataset.path!) ? under : null);
    };
    const finish = (event: PointerEvent | KeyboardEvent | Event) => {
      if (event instanceof KeyboardEvent && event.key !== "Escape") return;
      end();
      if (!begun) return;
      const up = event instanceof PointerEvent && event.type === "pointerup" ? event : undefined;
      if (isHead) drags.moves(path, up ? by(up) : { x: 0, y: 0 }, true);
      else {
        drags.line(null);
        if (up && target) drags.leads(path, target.dataset.path!, up.clientX, up.clientY);
      }
      mark(null);
      if (event instanceof KeyboardEvent) event.stopPropagation();
    };
    const end = () => {
      removeEventListener("pointermove", move);
      removeEventListener("pointerup", finish);
      removeEventListener("pointercancel", finish);
      removeEventListener("keydown", finish, true);
      removeEventListener("blur", finish);
    };
    addEventListener("pointermove", move);
    addEventListener("pointerup", finish);
    addEventListener("pointercancel", finish);
    addEventListener("keydown", finish, true);
    addEventListener("blur", finish);
    return end;
  };
  area.addEventListener("pointerdown", down, true);
  return () => {
    area.removeEventListener("pointerdown", down, true);
    stop();
  };
}
