import { useEffect, useMemo, useRef, useState, type KeyboardEvent } from "react";
import { useStore, useStudio } from "../../hooks/use";
import { useStructure } from "../../hooks/use_structure";
import type { Source } from "../../live/plots/plotted";
import { signalOf } from "../../model/plots/signals";
import { IconButton } from "../icons";
import type { Drawing, Flag, PlotCharts } from "./plot_charts";
import { plotLines } from "./plot_lines";
import { PlotTable } from "./plot_table";
import { PlotTools } from "./plot_tools";

/** The visible time: the last seconds, all of it, or a span that the user has chosen. */
export type Span = { last: number } | "all" | { from: number; to: number };

/** Milliseconds between two pictures of a run that goes on. */
const pause = 60;
/** The type of a signal that is dragged. */
export const dragged = "application/x-tessera-signal";

/** A hook: whether there is a plot to show, and a run whose values are in it. */
export function usePlot(): boolean {
  const studio = useStudio();
  const track = useStore(studio.scene.store, ({ panes }) => panes.some((one) => one.track !== null));
  const plot = useStore(studio.plots.store, ({ plots }) => plots.length > 1 || plots.some(({ signals }) => signals.length > 0));
  return track && plot;
}

/** The plot of the user: several signals of several runs over one axis of time. */
export function PlotPanel() {
  const studio = useStudio();
  const { plots, active, problem } = useStore(studio.plots.store, (all) => all);
  const loading = useStore(studio.plotted.store, (all) => all);
  const { panes } = useStore(studio.scene.store, (all) => all);
  const list = useStore(studio.recordings.store, (all) => all.list);
  const isDark = useStore(studio.view, (view) => view.theme === "dark");
  const structure = useStructure();
  const kept = plots[active]!;
  const [span, setSpan] = useState<Span | null>(null);
  const [cursors, setCursors] = useState<readonly (number | null)[]>([null, null]);
  const [, look] = useState(0);
  const root = useRef<HTMLDivElement>(null);
  const [charts, setCharts] = useState<PlotCharts | null>(null);

  // eslint-disable-next-line react-hooks/exhaustive-deps
  const sources = useMemo(() => studio.plotted.sources(), [studio, panes, loading, kept]);
  const current = () => drawingOf(sources, span, cursors, flagsOf(sources, list), () => lines());
  const lines = () => plotLines(kept, sources, structure, isDark);
  const latest = useRef({ current, setSpan, setCursors });
  latest.current = { current, setSpan, setCursors };

  // The library is loaded when the first plot is opened.
  useEffect(() => {
    let made: PlotCharts | undefined;
    let gone = false;
    void import("./plot_charts").then(({ PlotCharts: Made }) => {
      if (gone || !root.current) return;
      made = new Made(root.current, {
        onSpan: (from, to) => latest.current.setSpan({ from, to }),
        onReset: () => latest.current.setSpan(null),
        onCursor: (which, time) => latest.current.setCursors((before) => before.map((one, at) => (at === which ? time : one))),
      });
      setCharts(made);
    });
    return () => {
      gone = true;
      made?.destroy();
    };
  }, []);

  useEffect(() => {
    if (!charts) return;
    let [frame, before, painted] = [0, -Infinity, ""];
    const paint = (now: number) => {
      frame = requestAnimationFrame(paint);
      if (now - before < pause) return;
      before = now;
      const { clientWidth, clientHeight } = root.current!;
      const state = [
        sources.map(({ track, shift }) => `${track.id} ${track.now} ${track.end} ${shift} ${track.series.size}`),
        clientWidth,
        clientHeight,
        devicePixelRatio,
      ].join();
      if (state === painted) return;
      painted = state;
      charts.draw(latest.current.current());
    };
    frame = requestAnimationFrame(paint);
    return () => cancelAnimationFrame(frame);
    // Everything that changes the picture without a change of the runs draws at once.
  }, [charts, sources, kept, span, cursors, structure, isDark, list]);

  // The numbers below a run that goes on.
  useEffect(() => {
    const timer = setInterval(() => look((at) => at + 1), 400);
    return () => clearInterval(timer);
  }, []);

  const drawing = current();
  const all = lines();
  const key = (event: KeyboardEvent) => {
    if (event.ctrlKey || event.metaKey || event.altKey || !charts?.key(event.key)) return;
    event.preventDefault();
  };
  const lacking = kept.signals.filter((one) => !all.some(({ signal }) => signal === one));
  return (
    <section
      className="plot-panel"
      aria-label="Plots"
      onDragOver={(event) => event.dataTransfer.types.includes(dragged) && event.preventDefault()}
      onDrop={(event) => {
        const text = event.dataTransfer.getData(dragged);
        const signal = text === "" ? null : signalOf(JSON.parse(text));
        if (signal) studio.plots.add(signal);
      }}
    >
      <PlotTools
        lines={all.filter(({ hidden }) => !hidden)}
        sources={sources}
        drawing={drawing}
        span={span}
        onSpan={setSpan}
        onCursors={setCursors}
        picture={() => charts?.picture()}
      />
      {(problem || loading.problem) && <p className="problem-hint pad">{problem || loading.problem}</p>}
      <div className="plot-body">
        <div
          className="plot-charts"
          ref={root}
          tabIndex={0}
          role="group"
          aria-label="Plot. Arrows move it, plus and minus zoom, Home resets it."
          aria-keyshortcuts="ArrowLeft ArrowRight + - Home"
          onKeyDown={key}
        />
        <PlotTable lines={all} from={drawing.from} to={drawing.to} cursors={cursors} />
      </div>
      {sources.some(({ remark }) => remark) && (
        <p className="faint pad">
          {sources
            .filter(({ remark }) => remark)
            .map(({ name, remark }) => `${name}: ${remark}`)
            .join(". ")}
        </p>
      )}
      {lacking.length > 0 && (
        <ul className="plot-lacking" aria-label="Signals without values here">
          {lacking.map((signal) => (
            <li key={`${signal.kind} ${signal.path}`} className="faint">
              {signal.path}: no value here
              <IconButton
                name="cross"
                label={`Remove ${signal.path}`}
                title="Remove"
                onClick={() => studio.plots.remove(signal)}
              />
            </li>
          ))}
        </ul>
      )}
    </section>
  );
}

/** The marks of the recordings in the plot. */
function flagsOf(
  sources: readonly Source[],
  list: readonly { name: string; notes: { marks: { t: number; text: string }[] } | null }[],
): Flag[] {
  return sources.flatMap(({ name, shift }) =>
    (list.find((one) => one.name === name)?.notes?.marks ?? []).map(({ t, text }) => ({ time: t + shift, text })),
  );
}

/** Seconds that are visible of a run that goes on, unless the user wants others. */
const usual = 10;

function drawingOf(
  sources: readonly Source[],
  span: Span | null,
  cursors: readonly (number | null)[],
  flags: readonly Flag[],
  lines: () => ReturnType<typeof plotLines>,
): Drawing {
  const lead = sources[0];
  const wanted = span ?? (lead && !lead.replay ? { last: usual } : "all");
  let [from, to] = [0, 1e9];
  if (typeof wanted === "object" && "from" in wanted) ({ from, to } = wanted);
  else if (lead) {
    const ends = sources.map(({ replay, track, shift }) => shift + (replay ? replay.last : track.now));
    const starts = sources.map(({ replay, shift }) => shift + (replay ? replay.first : 0));
    const shown = lead.replay ? lead.track.now : Math.max(...ends);
    to = wanted === "all" ? Math.max(...ends) : shown;
    from = wanted === "all" ? Math.min(...starts) : to - wanted.last * 1e9;
  }
  return {
    lines: lines().filter(({ hidden }) => !hidden),
    from,
    to: Math.max(to, from + 1000),
    cursors,
    flags,
    now: lead?.replay ? lead.track.now : null,
  };
}
