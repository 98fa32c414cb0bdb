import { bandsOf, drawnCurves } from "../../model/plots/drawn_curves";
import { chartsOf } from "../../model/plots/signals";
import { shown } from "../../model/run/series";
import type { DrawnLine } from "./plot_charts";
import { niceStep } from "./draw_timeline";

const width = 900;
const each = 220;
const row = 20;
const [left, right] = [70, 70];
/** The parts of the drawing's width at which the time begins and ends. */
export const plotSides = { left: left / width, right: 1 - right / width };

const escaped = (text: string) => text.replace(/[<>&"]/g, (one) => `&#${one.charCodeAt(0)};`);
const text = (x: number, y: number, content: string, anchor = "start") =>
  `<text x="${x.toFixed(1)}" y="${y.toFixed(1)}" text-anchor="${anchor}">${escaped(content)}</text>`;

/** The numbers of an axis. */
function steps(low: number, high: number, most: number): number[] {
  const step = niceStep((high - low) / most);
  const found: number[] = [];
  for (let value = Math.ceil(low / step) * step; value <= high + step / 1e6; value += step)
    found.push(Number(value.toPrecision(9)));
  return found;
}

/** The lines of a plot in a span of nanoseconds, as a drawing for documents. */
export function svgOf(lines: readonly DrawnLine[], from: number, to: number): string {
  const inner = width - left - right;
  const x = (time: number) => left + ((time - from) / (to - from)) * inner;
  const parts: string[] = [];
  let top = 10;
  for (const { states, colour, name } of lines.filter((one) => one.states)) {
    const { changes, shift, until } = states!;
    parts.push(text(left - 6, top + 14, name.length > 11 ? `…${name.slice(-10)}` : name, "end"));
    for (const band of bandsOf(changes, from - shift, to - shift, until, inner)) {
      const [begin, end] = [x(band.from + shift), x(band.to + shift)];
      parts.push(
        `<rect x="${begin.toFixed(1)}" y="${top}" width="${(end - begin).toFixed(1)}" height="${row - 4}" fill="${colour}" fill-opacity="0.3" stroke="${colour}" stroke-width="0.5"/>`,
      );
      if (end - begin > band.state.length * 7 + 6) parts.push(text(begin + 4, top + 12, band.state));
    }
    top += row;
  }
  for (const { left: unit, right: other, signals } of chartsOf(lines.filter((one) => one.curve))) {
    const [low0, high0] = [top + 8, top + each - 26];
    parts.push(`<rect x="${left}" y="${low0}" width="${inner}" height="${high0 - low0}" fill="none" stroke="#999"/>`);
    for (const second of steps(from / 1e9, to / 1e9, 8)) {
      parts.push(
        `<line x1="${x(second * 1e9).toFixed(1)}" x2="${x(second * 1e9).toFixed(1)}" y1="${low0}" y2="${high0}" stroke="#ddd"/>`,
      );
      parts.push(text(x(second * 1e9), high0 + 14, `${second} s`, "middle"));
    }
    for (const [scale, at] of [
      [unit, 0],
      [other, 1],
    ] as const) {
      if (scale === null) continue;
      const mine = signals.filter((one) => one.unit === scale);
      const [times, ...points] = drawnCurves(
        mine.map(({ curve }) => curve!),
        from,
        to,
        inner * 2,
      );
      const known = points.flat().filter((one) => one !== null);
      let [low, high] = [Infinity, -Infinity];
      for (const value of known) [low, high] = [Math.min(low, value), Math.max(high, value)];
      if (low > high) continue;
      if (high - low < 1e-12) [low, high] = [low - 0.5, high + 0.5];
      const y = (value: number) => high0 - 4 - ((value - low) / (high - low)) * (high0 - low0 - 8);
      for (const value of steps(low, high, 4))
        parts.push(text(at === 0 ? left - 6 : width - right + 6, y(value) + 4, shown(value), at === 0 ? "end" : "start"));
      if (scale) parts.push(text(at === 0 ? 4 : width - 4, low0 + 10, scale, at === 0 ? "start" : "end"));
      mine.forEach(({ colour, dash, curve }, line) => {
        let [path, before] = ["", null as number | null];
        points[line]!.forEach((value, one) => {
          const here = x(times[one]! * 1e9).toFixed(1);
          if (value !== null)
            path +=
              before === null
                ? `M${here} ${y(value).toFixed(1)}`
                : `${curve!.course === "hold" ? `H${here}` : ""}L${here} ${y(value).toFixed(1)}`;
          before = value;
        });
        parts.push(`<path d="${path}" fill="none" stroke="${colour}" stroke-width="1.5" stroke-dasharray="${dash.join(" ")}"/>`);
      });
    }
    top += each;
  }
  for (const { name, unit, colour } of lines) {
    parts.push(`<rect x="${left}" y="${top + 3}" width="14" height="4" fill="${colour}"/>`);
    parts.push(text(left + 20, top + 10, unit ? `${name} [${unit}]` : name));
    top += 16;
  }
  return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${top + 8}" width="${width}" height="${top + 8}" font-family="sans-serif" font-size="11"><rect width="100%" height="100%" fill="#fff"/>${parts.join("")}</svg>\n`;
}
