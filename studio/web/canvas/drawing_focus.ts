import { useReactFlow } from "@xyflow/react";
import { useEffect, type RefObject } from "react";
import { withoutIndex } from "../model/structure/structure";
import { elementAt } from "./structure/structure_keys";

/** The keys go to the element of a drawing that was searched for, and never to one that is out of sight. */

/** Milliseconds after which a drawing that has not arrived does not get the focus any more. */
const patience = 3000;

const goesNowhere = (at: Element | null) => at === null || at === document.body || at.closest("dialog.search") !== null;

/**
 * Focuses an element as soon as it is drawn; in the net, the drawing itself, which has the keys there. A user who has gone
 * elsewhere meanwhile stays there.
 */
export function focusDrawn(view: "structure" | "net", selection: string): void {
  const until = performance.now() + patience;
  const look = () => {
    if (!goesNowhere(document.activeElement) || performance.now() > until) return;
    const area = document.querySelector<HTMLElement>(
      view === "net" ? ".canvas-area[role=application]" : "[data-testid=structure] .canvas-area",
    );
    // A member of a fleet is drawn as its agent.
    const element = area && (view === "net" ? area : (elementAt(area, selection) ?? elementAt(area, withoutIndex(selection))));
    element?.focus({ preventScroll: true });
    if (!element || document.activeElement !== element) requestAnimationFrame(look);
  };
  requestAnimationFrame(look);
}

/** Pixels between an element and the edge of the drawing. */
const margin = 24;

/** The way of a span into a room: none if it is inside, and its beginning counts more than its end. */
const wayInto = (from: number, to: number, room: readonly [number, number]) =>
  from < room[0] ? room[0] - from + margin : to > room[1] ? Math.max(room[1] - to - margin, room[0] - from + margin) : 0;

/** Moves the view so far that an element which gets the focus by a key is seen. */
export function useFocusInSight(area: RefObject<HTMLElement | null>, moved: { current: boolean }): void {
  const flow = useReactFlow();
  useEffect(() => {
    const at = area.current!;
    const look = ({ target }: FocusEvent) => {
      if (!(target instanceof HTMLElement) || !target.closest(".react-flow__viewport") || !target.matches(":focus-visible"))
        return;
      // Browsers have scrolled boxes that are not to be scrolled.
      for (let one: Element | null = target; one && one !== at.parentElement; one = one.parentElement) one.scrollTo(0, 0);
      const [own, room] = [target.getBoundingClientRect(), at.getBoundingClientRect()];
      const right = wayInto(own.left, own.right, [room.left, room.right]);
      let down = wayInto(own.top, own.bottom, [room.top, room.bottom]);
      const map = at.querySelector(".react-flow__minimap")?.getBoundingClientRect();
      const isUnderMap =
        map &&
        own.right + right > map.left &&
        own.left + right < map.right &&
        own.top + down < map.bottom &&
        own.bottom + down > map.top;
      if (isUnderMap) down += map.bottom - own.top - down + margin;
      if (right === 0 && down === 0) return;
      moved.current = true;
      const { x, y, zoom } = flow.getViewport();
      void flow.setViewport({ x: x + right, y: y + down, zoom });
    };
    at.addEventListener("focusin", look);
    return () => at.removeEventListener("focusin", look);
  }, [flow, area, moved]);
}
