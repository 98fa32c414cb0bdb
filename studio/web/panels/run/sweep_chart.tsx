import { shown } from "../../model/run/series";
import type { SweptPoint } from "../../model/run/sweep";
import { niceStep } from "../plots/draw_timeline";

const [width, height] = [460, 210];
const [left, right, top, below] = [56, 12, 18, 34];

function ticks(low: number, high: number, most: number): number[] {
  const step = niceStep((high - low) / most);
  const found: number[] = [];
  for (let value = Math.ceil(low / step) * step; value <= high + step / 1e6; value += step)
    found.push(Number(value.toPrecision(9)));
  return found;
}

const spread = (low: number, high: number): [number, number] =>
  high > low ? [low, high] : [low - Math.max(0.5, Math.abs(low) * 0.1), low + Math.max(0.5, Math.abs(low) * 0.1)];

interface FrameProps {
  label: string;
  x: readonly [number, number];
  y: readonly [number, number];
  xTitle: string;
  yTitle: string;
  children: (place: { x: (value: number) => number; y: (value: number) => number }) => React.ReactNode;
}

/** Axes with numbers and titles. */
function Frame({ label, x: [lowX, highX], y: [lowY, highY], xTitle, yTitle, children }: FrameProps) {
  const x = (value: number) => left + ((value - lowX) / (highX - lowX)) * (width - left - right);
  const y = (value: number) => height - below - ((value - lowY) / (highY - lowY)) * (height - top - below);
  return (
    <svg className="sweep-chart" viewBox={`0 0 ${width} ${height}`} role="img" aria-label={label}>
      {ticks(lowY, highY, 4).map((value) => (
        <g key={value}>
          <line className="grid" x1={left} x2={width - right} y1={y(value)} y2={y(value)} />
          <text x={left - 5} y={y(value) + 4} textAnchor="end">
            {shown(value)}
          </text>
        </g>
      ))}
      {ticks(lowX, highX, 5).map((value) => (
        <text key={value} x={x(value)} y={height - below + 14} textAnchor="middle">
          {shown(value)}
        </text>
      ))}
      <text x={left} y={11}>
        {yTitle}
      </text>
      <text x={width - right} y={height - 4} textAnchor="end">
        {xTitle}
      </text>
      {children({ x, y })}
    </svg>
  );
}

/** A measure over the values of a parameter: its mean as a line, and its least and greatest value as a band. */
export function SweepCurve({
  points,
  measure,
  parameter,
}: {
  points: readonly SweptPoint[];
  measure: string;
  parameter: string;
}) {
  const known = points.flatMap(({ x, numbers, ...rest }) => (numbers ? [{ x, numbers, ...rest }] : []));
  if (known.length === 0) return <p className="faint">No run has taken this measure yet.</p>;
  const low = Math.min(...known.map(({ numbers }) => numbers.min));
  const high = Math.max(...known.map(({ numbers }) => numbers.max));
  const xs = known.map((one) => one.x);
  return (
    <Frame
      label={`${measure} over ${parameter}`}
      x={spread(Math.min(...xs), Math.max(...xs))}
      y={spread(low, high)}
      xTitle={parameter}
      yTitle={measure}
    >
      {({ x, y }) => {
        const up = known.map((one) => `${x(one.x)},${y(one.numbers.max)}`);
        const down = known.map((one) => `${x(one.x)},${y(one.numbers.min)}`).reverse();
        return (
          <>
            <polygon className="band" points={[...up, ...down].join(" ")} />
            <polyline className="mean" points={known.map((one) => `${x(one.x)},${y(one.numbers.mean)}`).join(" ")} />
            {known.map(({ value, x: at, numbers, failed }) => (
              <circle key={value} className={failed > 0 ? "failed" : ""} cx={x(at)} cy={y(numbers.mean)} r="3">
                <title>{`${value}: ${shown(numbers.mean)} (${shown(numbers.min)} to ${shown(numbers.max)})${failed > 0 ? `, ${failed} failed` : ""}`}</title>
              </circle>
            ))}
          </>
        );
      }}
    </Frame>
  );
}

/** The number of runs in ranges of a measure. */
export function SweepDistribution({
  bins,
  measure,
}: {
  bins: readonly { from: number; to: number; runs: number }[];
  measure: string;
}) {
  if (bins.length === 0) return <p className="faint">No run has taken this measure yet.</p>;
  const [low, high] = spread(bins[0]!.from, bins.at(-1)!.to);
  return (
    <Frame
      label={`Runs by ${measure}`}
      x={[low, high]}
      y={[0, Math.max(...bins.map(({ runs }) => runs))]}
      xTitle={measure}
      yTitle="runs"
    >
      {({ x, y }) =>
        bins.map(({ from, to, runs }) => {
          const [begin, end] = from === to ? [x(from) - 12, x(from) + 12] : [x(from), x(to)];
          return (
            <rect key={from} className="bin" x={begin} y={y(runs)} width={Math.max(1, end - begin - 1)} height={y(0) - y(runs)}>
              <title>{`${runs} of ${shown(from)} to ${shown(to)}`}</title>
            </rect>
          );
        })
      }
    </Frame>
  );
}
