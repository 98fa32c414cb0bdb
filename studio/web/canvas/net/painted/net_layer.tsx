import { useEffect, useLayoutEffect, useMemo, useRef } from "react";
import { useStudio } from "../../../hooks/use";
import { numbered } from "../../../live/breakpoints";
import type { Stage } from "../../../live/stage";
import type { Window } from "../../../model/net/sheets";
import { Marks } from "../marks";
import { Ink } from "./ink";
import { InView } from "./in_view";
import { paintNet, type Scene } from "./painter";

/** The net on a canvas, with the state of the stage. It shows the same as the elements of SVG would. */
export function NetLayer({ scene, window, stage }: { scene: Scene; window: Window; stage: Stage }) {
  const studio = useStudio();
  const ref = useRef<HTMLCanvasElement>(null);
  const ink = useRef<Ink | null>(null);
  const now = useRef<() => void>(() => undefined);
  const width = Math.round(window.width * window.zoom);
  const height = Math.round(window.height * window.zoom);
  const breakpoints = useMemo(() => {
    let last = studio.runner.store.get().breakpoints;
    let found = numbered(scene.net, last).found;
    return () => {
      const { breakpoints } = studio.runner.store.get();
      if (breakpoints !== last) found = numbered(scene.net, (last = breakpoints)).found;
      return found;
    };
  }, [studio, scene.net]);
  useLayoutEffect(() => {
    const canvas = ref.current!;
    const context = canvas.getContext("2d")!;
    ink.current ??= new Ink(canvas.parentElement!);
    now.current = () => {
      const ratio = devicePixelRatio;
      if (canvas.width !== Math.round(width * ratio)) canvas.width = Math.round(width * ratio);
      if (canvas.height !== Math.round(height * ratio)) canvas.height = Math.round(height * ratio);
      paintNet(context, ink.current!, scene, new Marks(scene.net, stage, breakpoints()), window, ratio);
    };
    now.current();
  }, [scene, window, width, height, stage, breakpoints]);
  useEffect(() => {
    const paint = () => now.current();
    const leave = stage.subscribe(paint);
    let last = studio.runner.store.get().breakpoints;
    const told = studio.runner.store.subscribe(() => {
      if (studio.runner.store.get().breakpoints === last) return;
      last = studio.runner.store.get().breakpoints;
      paint();
    });
    // Another theme, another style.
    const themes = new MutationObserver(() => {
      ink.current = new Ink(ref.current!.parentElement!);
      paint();
    });
    themes.observe(document.documentElement, { attributeFilter: ["data-theme"] });
    return () => (leave(), told(), themes.disconnect());
  }, [stage, studio]);
  return (
    <>
      <canvas ref={ref} className="net-layer" style={{ width, height }} aria-hidden="true" />
      <InView scene={scene} window={window} />
    </>
  );
}
