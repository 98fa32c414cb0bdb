import { useEffect, useRef, useState } from "react";
import { useStore, useStudio } from "../app/use";
import type { Track } from "../live/runner";
import { drawTimeline, timeAt } from "./draw_timeline";
import { drawWorld } from "./draw_world";
import { ValueList } from "./value_list";

/** Below the drawing while something runs or is replayed: who did what when, values, and the world from above. */
export function Watch() {
  const studio = useStudio();
  useStore(studio.runner.store, (all) => all.run);
  useStore(studio.runner.store, (all) => all.state);
  const open = useStore(studio.recordings.store, (all) => all.open);
  const track = open !== null ? studio.recordings.track : studio.runner.track;
  const [seconds, setSeconds] = useState(10);
  if (!track) return null;
  return (
    <section className="watch" aria-label="Run">
      <div className="watch-pane timeline">
        <div className="watch-title">
          <h2>Timeline</h2>
          <Facts track={track} />
          <span className="spring" />
          <select aria-label="Time shown" value={seconds} onChange={(event) => setSeconds(Number(event.target.value))}>
            {[1, 3, 10, 60, 600].map((choice) => (
              <option key={choice} value={choice}>
                {choice < 60 ? `${choice} s` : `${choice / 60} min`}
              </option>
            ))}
          </select>
        </div>
        <Painted
          label="Behaviours and firings of each subsystem over time"
          draw={(context, size, colours) => drawTimeline(context, size, colours, track, seconds)}
          onPick={open === null ? undefined : (x, width) => studio.recordings.seek(timeAt(track, seconds, x, width))}
        />
      </div>
      <div className="watch-pane values">
        <div className="watch-title">
          <h2>Values</h2>
        </div>
        <ValueList track={track} seconds={seconds} none={open === null ? "No values yet" : "This recording holds no values"} />
      </div>
      <div className="watch-pane world">
        <div className="watch-title">
          <h2>World</h2>
          <span className="faint">{track.path.length > 0 ? "from above" : ""}</span>
        </div>
        <Painted
          label="The robot's path from above"
          draw={(context, size, colours) =>
            drawWorld(context, size, colours, track, open === null ? "No path yet" : "This recording holds no path")
          }
        />
      </div>
    </section>
  );
}

/** Counts that change all the time; told to nobody who only listens. */
function Facts({ track }: { track: Track }) {
  const ref = useRef<HTMLSpanElement>(null);
  useEffect(() => {
    const tell = () => {
      const dropped = track.dropped > 0 ? ` (${track.dropped.toLocaleString("en")} only counted)` : "";
      if (ref.current)
        ref.current.textContent = `${(track.now / 1e9).toFixed(2)} s · ${track.firings.toLocaleString("en")} firings${dropped}`;
    };
    tell();
    const timer = setInterval(tell, 100);
    return () => clearInterval(timer);
  }, [track]);
  return <span ref={ref} className="facts" data-testid="run-facts" />;
}

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

/** A canvas that is painted every frame in which it can be seen. */
export function Painted({
  label,
  draw,
  onPick,
  every = 48,
}: {
  label: string;
  /** Milliseconds between pictures: twenty a second read as motion, and leave the time to the drawing of the net. */
  every?: number;
  draw: (context: CanvasRenderingContext2D, size: Size, colours: Colours) => void;
  onPick?: ((x: number, width: number) => void) | undefined;
}) {
  const ref = useRef<HTMLCanvasElement>(null);
  const pause = useRef(every);
  const latest = useRef(draw);
  latest.current = draw;
  useEffect(() => {
    const canvas = ref.current!;
    const context = canvas.getContext("2d")!;
    let frame = 0;
    let before = -Infinity;
    const paint = (now: number) => {
      frame = requestAnimationFrame(paint);
      if (now - before < pause.current) return;
      before = now;
      const { clientWidth: width, clientHeight: height } = canvas;
      const ratio = devicePixelRatio;
      if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
        canvas.width = Math.round(width * ratio);
        canvas.height = Math.round(height * ratio);
      }
      context.setTransform(ratio, 0, 0, ratio, 0, 0);
      context.clearRect(0, 0, width, height);
      latest.current(context, { width, height }, coloursOf(canvas));
    };
    frame = requestAnimationFrame(paint);
    return () => cancelAnimationFrame(frame);
  }, []);
  return (
    <canvas
      ref={ref}
      className="painted"
      role="img"
      aria-label={label}
      onClick={(event) =>
        onPick?.(event.clientX - event.currentTarget.getBoundingClientRect().left, event.currentTarget.clientWidth)
      }
    />
  );
}
