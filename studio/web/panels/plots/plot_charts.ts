import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { bandsOf, drawnCurves, type Curve } from "../../model/plots/drawn_curves";
import type { States } from "../../model/plots/plotted_runs";
import { chartsOf } from "../../model/plots/signals";

/** A curve or a row of bands, as the legend names it. */
export interface DrawnLine {
  name: string;
  unit: string;
  colour: string;
  /** The dashes of its run; none: a line without gaps. */
  dash: readonly number[];
  curve?: Curve;
  states?: { changes: States; shift: number; until: number };
  /** Times in nanoseconds at which a value was not valid. */
  invalid: readonly number[];
}

/** A time with a text: a mark of the user, or the moment that is shown. */
export interface Flag {
  time: number;
  text: string;
}

export interface Drawing {
  lines: readonly DrawnLine[];
  /** Nanoseconds. */
  from: number;
  to: number;
  /** The two cursors, in nanoseconds. */
  cursors: readonly (number | null)[];
  flags: readonly Flag[];
  /** The moment that the world and the net show. */
  now: number | null;
}

export interface Acts {
  /** Another span is wanted. */
  onSpan: (from: number, to: number) => void;
  onReset: () => void;
  /** A cursor is put at a time. */
  onCursor: (which: 0 | 1, time: number) => void;
}

const side = 54;
const labelSize = 16;
const row = 18;
/** The range of an axis: a little more than the values, also if all are the same. */
const room = (_: uPlot, low: number | null, high: number | null): [number, number] => {
  if (low === null || high === null || !Number.isFinite(low) || !Number.isFinite(high)) return [0, 1];
  const edge = high > low ? 0.06 * (high - low) : Math.max(0.5, Math.abs(low) * 0.1);
  return [low - edge, high + edge];
};
/** A span is at least so long, in nanoseconds. */
const shortest = 1000;

/** The charts of one plot, one above the other, with a common axis of time. */
export class PlotCharts {
  private charts: { plot: uPlot; lines: DrawnLine[]; columns: number }[] = [];
  private shape = "";
  private drawing: Drawing | null = null;
  private readonly sync = uPlot.sync(`plot ${Math.random()}`);

  constructor(
    private readonly root: HTMLElement,
    private readonly acts: Acts,
  ) {}

  /** Draws all anew; the charts are made again only if another curve, unit or size comes. */
  draw(drawing: Drawing): void {
    this.drawing = drawing;
    const { clientWidth: width, clientHeight: height } = this.root;
    if (width < 80 || height < 40) return;
    const shape = JSON.stringify([
      drawing.lines.map(({ name, unit, colour, dash, states }) => [name, unit, colour, dash, states !== undefined]),
      width,
      height,
      devicePixelRatio,
      document.documentElement.dataset.theme,
    ]);
    if (shape !== this.shape) this.build(width, height);
    this.shape = shape;
    for (const chart of this.charts) {
      chart.lines = chart.lines.map(({ name }) => drawing.lines.find((one) => one.name === name)!);
      const curves = chart.lines.flatMap(({ curve }) => (curve ? [curve] : []));
      chart.plot.setData(drawnCurves(curves, drawing.from, drawing.to, chart.columns) as uPlot.AlignedData);
    }
  }

  destroy(): void {
    for (const { plot } of this.charts) plot.destroy();
    this.charts = [];
    this.root.replaceChildren();
  }

  /** The charts as one picture. */
  picture(): HTMLCanvasElement {
    const canvas = document.createElement("canvas");
    const parts = this.charts.map(({ plot }) => plot.ctx.canvas);
    canvas.width = Math.max(1, ...parts.map((one) => one.width));
    canvas.height = parts.reduce((sum, one) => sum + one.height, 0);
    const context = canvas.getContext("2d")!;
    context.fillStyle = getComputedStyle(this.root).getPropertyValue("--surface");
    context.fillRect(0, 0, canvas.width, canvas.height);
    let top = 0;
    for (const one of parts) {
      context.drawImage(one, 0, top);
      top += one.height;
    }
    return canvas;
  }

  private build(width: number, height: number): void {
    this.destroy();
    const { lines } = this.drawing!;
    const rows = lines.filter(({ states }) => states);
    const charts = chartsOf(lines.filter(({ curve }) => curve));
    const hasRight = charts.some(({ right }) => right !== null);
    const bands = rows.length === 0 ? 0 : rows.length * row + (charts.length === 0 ? 26 : 6);
    const each = charts.length === 0 ? 0 : Math.max(70, Math.floor((height - bands) / charts.length));
    if (rows.length > 0) this.add(rows, [], null, hasRight, width, charts.length === 0 ? height : bands, charts.length === 0);
    charts.forEach(({ left, right, signals }, at) =>
      this.add([...signals], [left], right, hasRight, width, each, at === charts.length - 1),
    );
  }

  /** left: the unit; none: rows of bands. last: its axis has the times. */
  private add(
    lines: DrawnLine[],
    [left]: string[],
    right: string | null,
    hasRight: boolean,
    width: number,
    height: number,
    last: boolean,
  ): void {
    const style = getComputedStyle(this.root);
    const colour = (name: string) => style.getPropertyValue(name).trim();
    const box = document.createElement("div");
    box.setAttribute("role", "img");
    box.setAttribute("aria-label", `Plot of ${lines.map(({ name }) => name).join(", ")}${left ? ` in ${left}` : ""}`);
    this.root.append(box);
    const font = "11px system-ui, 'DejaVu Sans', sans-serif";
    const grid = { stroke: colour("--line"), width: 1 };
    const common = { stroke: colour("--soft"), grid, ticks: { show: false }, font };
    const curves = lines.filter(({ curve }) => curve);
    const chart = { plot: null as unknown as uPlot, lines, columns: Math.max(50, Math.floor(width - side)) };
    const plot = new uPlot(
      {
        width,
        height,
        legend: { show: false },
        padding: [
          8,
          hasRight && right === null ? side + labelSize + 10 : 10,
          last ? 0 : 2,
          left === undefined ? side + labelSize : 0,
        ],
        cursor: { sync: { key: this.sync.key }, y: false, drag: { x: false, y: false }, points: { show: curves.length > 0 } },
        select: { show: true, left: 0, top: 0, width: 0, height: 0 },
        scales: {
          x: { time: false, range: () => [this.drawing!.from / 1e9, this.drawing!.to / 1e9] },
          ...(left === undefined ? {} : { left: { range: room } }),
          ...(right === null ? {} : { right: { range: room } }),
        },
        axes: [
          {
            ...common,
            size: last ? 24 : 4,
            values: (_, splits) => splits.map((one) => (last ? `${Number(one.toPrecision(12))} s` : "")),
            space: 70,
          },
          ...(left === undefined
            ? []
            : [{ ...common, scale: "left", size: side, label: left || " ", labelSize, labelFont: font }]),
          ...(right === null
            ? []
            : [
                {
                  ...common,
                  scale: "right",
                  side: 1 as const,
                  size: side,
                  grid: { show: false },
                  label: right || " ",
                  labelSize,
                  labelFont: font,
                },
              ]),
        ],
        series: [
          {},
          ...curves.map(({ name, unit, colour: stroke, dash, curve }) => ({
            label: name,
            scale: unit === left ? "left" : "right",
            stroke,
            width: 1.5,
            dash: [...dash],
            points: { show: false },
            spanGaps: false,
            ...(curve!.course === "hold" ? { paths: uPlot.paths.stepped!({ align: 1 }) } : {}),
          })),
        ],
        hooks: { draw: [(drawn) => this.decorate(drawn, chart, colour)] },
      },
      [[]] as unknown as uPlot.AlignedData,
      box,
    );
    chart.plot = plot;
    this.charts.push(chart);
    this.listen(plot);
  }

  /** Bands of states, invalid values, marks, cursors and the shown moment. */
  private decorate(plot: uPlot, { lines }: { lines: DrawnLine[] }, colour: (name: string) => string): void {
    const { from, to, cursors, flags, now } = this.drawing!;
    const { ctx: context } = plot;
    const ratio = devicePixelRatio;
    const { left, top, width, height } = plot.bbox;
    const x = (time: number) => left + ((time - from) / (to - from)) * width;
    context.save();
    context.font = `${11 * ratio}px system-ui, 'DejaVu Sans', sans-serif`;
    context.textBaseline = "middle";
    context.textAlign = "left";
    lines
      .filter(({ states }) => states)
      .forEach(({ states, name, colour: fill }, at) => {
        const { changes, shift, until } = states!;
        const y = top + at * row * ratio;
        context.fillStyle = colour("--soft");
        context.fillText(endOf(context, name, left - 8 * ratio), 4 * ratio, y + (row * ratio) / 2);
        for (const band of bandsOf(changes, from - shift, to - shift, until, width / ratio)) {
          const [begin, end] = [x(band.from + shift), x(band.to + shift)];
          context.fillStyle = fill;
          context.globalAlpha = shadeOf(band.state, changes);
          context.fillRect(begin, y + ratio, end - begin, (row - 3) * ratio);
          context.globalAlpha = 1;
          context.fillRect(begin, y + ratio, 1.5 * ratio, (row - 3) * ratio);
          context.fillStyle = colour("--text");
          if (context.measureText(band.state).width + 8 * ratio < end - begin)
            context.fillText(band.state, begin + 5 * ratio, y + (row * ratio) / 2);
        }
      });
    context.beginPath();
    context.rect(left, top, width, height);
    context.clip();
    context.fillStyle = colour("--red");
    for (const time of lines.flatMap(({ invalid }) => invalid.filter((one) => one >= from && one <= to)).slice(0, 500))
      context.fillText("×", x(time) - 3 * ratio, top + height - 5 * ratio);
    const line = (time: number, stroke: string, text: string, dash: number[] = []) => {
      if (time < from || time > to) return;
      context.strokeStyle = stroke;
      context.fillStyle = stroke;
      context.lineWidth = ratio;
      context.setLineDash(dash.map((one) => one * ratio));
      context.beginPath();
      context.moveTo(x(time), top);
      context.lineTo(x(time), top + height);
      context.stroke();
      context.setLineDash([]);
      const room = context.measureText(text).width + 6 * ratio;
      context.fillText(text, x(time) + (x(time) + room > left + width ? -room : 4 * ratio), top + 7 * ratio);
    };
    for (const { time, text } of flags) line(time, colour("--fused"), text, [4, 3]);
    if (now !== null) line(now, colour("--text"), "");
    cursors.forEach((time, at) => time !== null && line(time, colour("--accent"), "AB"[at]!));
    context.restore();
  }

  /** Two keys or turns of the wheel may come before the page draws again: the second begins where the first has led. */
  private show(from: number, to: number): void {
    this.drawing = { ...this.drawing!, from, to };
    this.acts.onSpan(from, to);
  }

  private timeAt(plot: uPlot, pixels: number): number {
    const { from, to } = this.drawing!;
    return from + (pixels / plot.over.clientWidth) * (to - from);
  }

  private zoom(at: number, factor: number): void {
    const { from, to } = this.drawing!;
    const length = Math.max(shortest, (to - from) * factor);
    const begin = at - ((at - from) / (to - from)) * length;
    this.show(begin, begin + length);
  }

  /** Keys: arrows move, + and - zoom, Home shows all. Returns whether the key has a meaning. */
  key(key: string): boolean {
    if (!this.drawing) return false;
    const { from, to } = this.drawing;
    const by = (part: number) => this.show(from + part * (to - from), to + part * (to - from));
    if (key === "ArrowLeft") by(-0.1);
    else if (key === "ArrowRight") by(0.1);
    else if (key === "PageUp") by(-0.9);
    else if (key === "PageDown") by(0.9);
    else if (key === "+" || key === "=") this.zoom((from + to) / 2, 0.5);
    else if (key === "-") this.zoom((from + to) / 2, 2);
    else if (key === "Home" || key === "0") this.acts.onReset();
    else return false;
    return true;
  }

  private listen(plot: uPlot): void {
    const { over } = plot;
    const here = (event: PointerEvent | WheelEvent) => event.clientX - over.getBoundingClientRect().left;
    over.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        const { from, to } = this.drawing!;
        if (event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY)) {
          const by = (((event.deltaX || event.deltaY) / 400) * (to - from)) / 2;
          this.show(from + by, to + by);
        } else this.zoom(this.timeAt(plot, here(event)), 1.0016 ** event.deltaY);
      },
      { passive: false },
    );
    over.addEventListener("dblclick", () => this.acts.onReset());
    over.addEventListener("pointerdown", (down) => {
      if (down.button !== 0) return;
      const start = here(down);
      const { from, to } = this.drawing!;
      const chosen = down.shiftKey;
      let moved = false;
      over.setPointerCapture(down.pointerId);
      const move = (event: PointerEvent) => {
        const by = here(event) - start;
        moved ||= Math.abs(by) > 3;
        if (!moved) return;
        if (chosen)
          plot.setSelect({ left: Math.min(start, start + by), top: 0, width: Math.abs(by), height: over.clientHeight }, false);
        else {
          const shift = (-by / over.clientWidth) * (to - from);
          this.show(from + shift, to + shift);
        }
      };
      const up = (event: PointerEvent) => {
        over.removeEventListener("pointermove", move);
        over.removeEventListener("pointerup", up);
        over.removeEventListener("pointercancel", up);
        const end = here(event);
        if (event.type === "pointercancel") return;
        if (!moved) this.acts.onCursor(event.shiftKey || event.altKey ? 1 : 0, this.timeAt(plot, end));
        else if (chosen) {
          plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
          this.show(this.timeAt(plot, Math.min(start, end)), this.timeAt(plot, Math.max(start, end)));
        }
      };
      over.addEventListener("pointermove", move);
      over.addEventListener("pointerup", up);
      over.addEventListener("pointercancel", up);
    });
  }
}

const shades = [0.16, 0.42, 0.28, 0.55];

/** The darkness of a state: that of its first appearance; false is pale. */
function shadeOf(state: string, changes: States): number {
  if (state === "false") return 0.08;
  if (state === "true") return 0.5;
  const names: string[] = [];
  for (const { state: one } of changes) {
    if (one !== "" && !names.includes(one)) names.push(one);
    if (names.length >= shades.length || one === state) break;
  }
  return shades[Math.max(0, names.indexOf(state)) % shades.length]!;
}

/** The end of a name, as far as there is room. */
function endOf(context: CanvasRenderingContext2D, name: string, most: number): string {
  for (let from = 0; from < name.length; from += 1) {
    const text = from === 0 ? name : `…${name.slice(from)}`;
    if (context.measureText(text).width <= most) return text;
  }
  return "";
}
