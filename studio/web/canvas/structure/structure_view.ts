import { useReactFlow, useStore as useFlow, useStoreApi } from "@xyflow/react";
import { useCallback, useEffect, useRef } from "react";
import { useStore, useStudio } from "../../hooks/use";
import type { Box } from "../../model/net/geometry";
import { bundleAt, bundlePath } from "../../model/structure/bundles";
import { around } from "../../model/structure/lens_layout";
import { findThing, selectedPath, withoutIndex } from "../../model/structure/structure";
import { nothing, type Drawn } from "./drawn_structure";

/** The part of the structure that is visible: all of it at first, and then what the user comes near to. */

const still = matchMedia("(prefers-reduced-motion: reduce)");
const duration = () => (still.matches ? 0 : 350);
/** Nearer than this, letters are larger than they need be. */
const nearest = 1.25;

/**
 * Shows all of a drawing, with the channels around its boxes, until the user moves it. If an edit makes it too large for
 * its letters, it stays near to what was edited. Returns the function to call after a move.
 */
export function useWholeUntilMoved(drawn: Drawn, whole: Box, near: (path: string) => void, moved: { current: boolean }): void {
  const flow = useReactFlow();
  const studio = useStudio();
  const size = useFlow((state) => `${state.width} ${state.height}`);
  const last = useRef<Box | null>(null);
  const lastSize = useRef({ width: 0, height: 0 });
  useEffect(() => {
    const [across, down] = size.split(" ").map(Number) as [number, number];
    if (across === 0 || drawn === nothing || moved.current) return;
    const { x, y, width, height } = whole;
    // A small system is not drawn larger than it is.
    const least = { width: Math.max(width, 620), height: Math.max(height, 520) };
    const box = { x: x + (width - least.width) / 2, y: y + (height - least.height) / 2, ...least };
    // The space around the drawing included.
    const fits = Math.min(across / least.width, down / least.height) * 0.94;
    const { selected } = studio.view.get();
    // A list below the drawing, or a row above it, takes some of its height: that is no reason to draw less.
    const { width: before, height: high } = lastSize.current;
    lastSize.current = { width: across, height: down };
    const isLower = across === before && down < high && down > 0.6 * high;
    if (isLower && last.current === whole && fits < drawn.levels.all && flow.getZoom() >= drawn.levels.all) return;
    const isEdited = last.current !== null && last.current !== whole && flow.getZoom() >= drawn.levels.all;
    last.current = whole;
    if (isEdited && fits < drawn.levels.all && selected?.includes(".")) near(selected);
    else void flow.fitBounds(box, { duration: 0, padding: 0.03 });
  }, [size, whole, drawn, flow, near, moved, studio]);
}

/** The boxes of an element: all of it is to be visible, and its middle if that is not possible. */
function boxesOf({ structure, drawing }: Drawn, selection: string): { whole: Box; middle: Box } | undefined {
  const path = withoutIndex(selectedPath(selection));
  const thing = findThing(structure, selection);
  const bundle = thing?.kind === "channel" ? bundlePath(thing.of) : path;
  const agents = bundle === undefined ? undefined : bundleAt(structure, bundle)?.agents;
  const ends = thing?.kind === "channel" ? [thing.of.from, thing.of.to].map((end) => partOf(withoutIndex(end))) : [partOf(path)];
  const boxes = (agents ?? ends).flatMap((one) => drawing.boxes.get(one) ?? []);
  const whole = around(boxes);
  if (!whole) return undefined;
  const card = drawing.cards.get(partOf(path));
  const state = card?.machine.states.get(path);
  if (!card || !state) return { whole, middle: whole };
  const at = { x: whole.x + card.machineAt.x + state.x, y: whole.y + card.machineAt.y + state.y };
  return { whole, middle: { ...state, ...at } };
}

/** The agent or subsystem that a path is in. */
const partOf = (path: string) => path.split(".").slice(0, 2).join(".");

/** A function that moves the view to an element, so near that what is in a subsystem can be read. */
export function useComeNear(drawn: Drawn, moved: { current: boolean }): (path: string) => void {
  const flow = useReactFlow();
  const store = useStoreApi();
  return useCallback(
    (path) => {
      const found = boxesOf(drawn, path);
      const { width, height } = store.getState();
      if (!found || width === 0) return;
      moved.current = true;
      const { whole, middle } = found;
      const fits = 0.92 * Math.min(width / whole.width, height / whole.height);
      const least = path.includes(".") ? drawn.levels.all : 0;
      const zoom = Math.max(least * 1.01, Math.min(fits, nearest));
      const at = fits >= zoom ? whole : middle;
      void flow.setCenter(at.x + at.width / 2, at.y + at.height / 2, { zoom, duration: duration() });
    },
    [drawn, flow, store, moved],
  );
}

/** Comes near to the element that the search, or another part of the page, has asked for. */
export function useNearness(drawn: Drawn, comeNear: (path: string) => void): void {
  const studio = useStudio();
  const near = useStore(studio.view, (view) => view.near);
  const ready = useFlow((state) => state.width > 0);
  useEffect(() => {
    if (near === null || !ready || drawn === nothing) return;
    studio.view.set({ near: null });
    comeNear(near);
  }, [near, ready, drawn, comeNear, studio]);
}
