import type { MeasuredTimes } from "../../model/protocol";
import { histogramOf } from "../../model/measured_times";
import { shownTime } from "../../model/timing";
import { useWidth } from "../../hooks/use_width";

const [height, above, below] = [64, 16, 15];

/** The distribution of measured times from 0 on, with the bound as a line and the worst case as a mark. */
export function AgeHistogram({ times, bound, name }: { times: MeasuredTimes; bound: number | null; name: string }) {
  const [frame, width] = useWidth<HTMLDivElement>();
  const found = histogramOf(times, bound);
  const bottom = height - below;
  const label = `${name}: ${times.count} measured, the longest ${shownTime(times.most_ns ?? 0)}${bound === null ? "" : `, the bound ${shownTime(bound)}`}`;
  return (
    <div className="age-histogram" ref={frame}>
      {found && width > 0 && (
        <svg width={width} height={height} role="img" aria-label={label}>
          {found.bars.map(({ from, width: wide, height: high, count, least_ns, most_ns }) => (
            <rect
              key={from}
              className="bar"
              x={from * width}
              y={bottom - Math.max(1.5, high * (bottom - above))}
              width={Math.max(1.5, wide * width - 0.5)}
              height={Math.max(1.5, high * (bottom - above))}
            >
              <title>{`${shownTime(Math.round(least_ns))} to ${shownTime(Math.round(most_ns))}: ${count.toLocaleString("en")}`}</title>
            </rect>
          ))}
          <line className="base" x1={0} x2={width} y1={bottom} y2={bottom} />
          <line className="worst" x1={found.worst * width} x2={found.worst * width} y1={above} y2={bottom} />
          {found.bound !== null && (
            <g className="bound">
              <line x1={found.bound * width} x2={found.bound * width} y1={above - 4} y2={bottom} />
              <text x={found.bound * width} y={above - 6} textAnchor="end">
                bound {shownTime(bound!)}
              </text>
            </g>
          )}
          <text x={0} y={height - 3}>
            0
          </text>
          <text x={Math.min(found.worst * width, width)} y={height - 3} textAnchor={found.worst > 0.25 ? "end" : "start"}>
            longest {shownTime(times.most_ns!)}
          </text>
        </svg>
      )}
    </div>
  );
}
