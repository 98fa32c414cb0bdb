import { useEffect, useRef } from "react";

export interface Colours {
  text: string;
  faint: string;
  line: string;
  accent: string;
  soft: string;
  surface: string;
}
export interface Size {
  width: number;
  height: number;
}

function coloursOf(element: Element): Colours {
  const style = getComputedStyle(element);
  const of = (name: string) => style.getPropertyValue(name).trim();
  return {
    text: of("--text"),
    faint: of("--faint"),
    line: of("--line"),
    accent: of("--accent"),
    soft: of("--accent-soft"),
    surface: of("--surface"),
  };
}

/** A canvas that is painted again when its content changes. */
export function Painted({
  label,
  draw,
  of,
  onPick,
  every = 48,
}: {
  /** A description of the picture; empty: the text beside it describes it completely. */
  label: string;
  /**
   * Milliseconds between pictures: twenty a second look like motion, and leave time for drawing the net.
   */
  every?: number;
  draw: (context: CanvasRenderingContext2D, size: Size, colours: Colours) => void;
  /** The state on which the picture depends: it is painted again only if that changes. */
  of: () => string;
  onPick?: ((x: number, width: number) => void) | undefined;
}) {
  const ref = useRef<HTMLCanvasElement>(null);
  const pause = useRef(every);
  const latest = useRef({ draw, of });
  latest.current = { draw, of };
  useEffect(() => {
    const canvas = ref.current!;
    const context = canvas.getContext("2d")!;
    let frame = 0;
    let before = -Infinity;
    let painted = "";
    const paint = (now: number) => {
      frame = requestAnimationFrame(paint);
      if (now - before < pause.current) return;
      before = now;
      const { clientWidth: width, clientHeight: height } = canvas;
      const ratio = devicePixelRatio;
      const state = [latest.current.of(), width, height, ratio, document.documentElement.dataset.theme].join();
      if (state === painted) return;
      painted = state;
      if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
        canvas.width = Math.round(width * ratio);
        canvas.height = Math.round(height * ratio);
      }
      context.setTransform(ratio, 0, 0, ratio, 0, 0);
      context.clearRect(0, 0, width, height);
      latest.current.draw(context, { width, height }, coloursOf(canvas));
    };
    frame = requestAnimationFrame(paint);
    return () => cancelAnimationFrame(frame);
  }, []);
  return (
    <canvas
      ref={ref}
      className="painted"
      {...(label ? { role: "img", "aria-label": label } : { "aria-hidden": true })}
      onClick={(event) =>
        onPick?.(event.clientX - event.currentTarget.getBoundingClientRect().left, event.currentTarget.clientWidth)
      }
    />
  );
}
