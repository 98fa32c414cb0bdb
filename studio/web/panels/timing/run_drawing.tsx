import { useState } from "react";
import { useWidth } from "../../hooks/use_width";
import { inMiddle } from "../../model/net/labels";
import { shownTime } from "../../model/timing";
import { drawnRun, runSizes, type DrawnCall, type DrawnRun, type Shown, type TimedRun } from "../../model/timed_run";
import { niceStep } from "../plots/draw_timeline";

/** Pixels of a letter, about. */
const letter = 6.2;

/** "21.5 ms": from the beginning of the run. */
const since = (run: TimedRun, time: number) => shownTime(Math.max(0, time - run.from_ns));

interface RunDrawingProps {
  run: TimedRun;
  path: readonly string[];
  shown: Shown;
  /** The time of the run that is shown elsewhere on the page; null: none. */
  now?: number | null;
  onSeek?: (time: number) => void;
}

/** A run of a chain over time: a lane for each subsystem, its calls, and the way of the value. */
export function RunDrawing({ run, path, shown, now = null, onSeek }: RunDrawingProps) {
  const [frame, width] = useWidth<HTMLDivElement>();
  const [pointed, point] = useState<number | null>(null);
  const drawn = width > 0 ? drawnRun(run, path, shown, width) : null;
  const parts = drawn?.parts ?? [];
  return (
    <div className="run-drawing" ref={frame}>
      {drawn && (
        <svg
          width={width}
          height={drawn.height}
          role="img"
          aria-label={`The run from the ${shown === "age" ? "reading" : "event"} to the command: ${shownTime(run.to_ns - run.from_ns)}`}
          className={onSeek ? "seekable" : ""}
          onClick={onSeek && ((event) => onSeek(drawn.timeAt(event.clientX - event.currentTarget.getBoundingClientRect().left)))}
          onPointerLeave={() => point(null)}
        >
          <Axis run={run} drawn={drawn} width={width} />
          {drawn.lanes.map(({ subsystem, y }) => (
            <g key={subsystem}>
              <text className="lane-name" x={runSizes.side} y={y - 4}>
                <title>{subsystem}</title>
                {inMiddle(subsystem, Math.floor((width - 2 * runSizes.side) / letter))}
              </text>
              <rect className="lane" x={runSizes.side} y={y} width={width - 2 * runSizes.side} height={runSizes.bar} />
            </g>
          ))}
          {parts.map(
            (part, at) =>
              part.kind !== "works" && (
                <rect
                  key={at}
                  className={`run-part part-${part.kind}${pointed === at ? " pointed" : ""}`}
                  x={part.x}
                  y={part.y}
                  width={part.width}
                  height={runSizes.bar}
                  onPointerEnter={() => point(at)}
                >
                  <title>{`${part.text}: ${shownTime(part.to - part.from)}`}</title>
                </rect>
              ),
          )}
          {drawn.calls.map((one, at) => (
            <Call
              key={at}
              one={one}
              run={run}
              pointed={one.carries && pointed !== null && parts[pointed]?.kind === "works" && parts[pointed]?.lane === one.lane}
              onPoint={() =>
                point(one.carries ? parts.findIndex(({ kind, lane }) => kind === "works" && lane === one.lane) : null)
              }
            />
          ))}
          <WayOfValue drawn={drawn} run={run} shown={shown} />
          <Dimension drawn={drawn} run={run} width={width} />
          {now !== null && now >= run.from_ns && now <= run.to_ns && (
            <line
              className="run-now"
              x1={drawn.x(now)}
              x2={drawn.x(now)}
              y1={runSizes.top - 8}
              y2={drawn.height - runSizes.below}
            />
          )}
        </svg>
      )}
      <ol className="run-parts" aria-label="The parts of the time">
        {parts.map((part, at) => (
          <li
            key={at}
            className={pointed === at ? "pointed" : ""}
            onPointerEnter={() => point(at)}
            onPointerLeave={() => point(null)}
          >
            <span className={`swatch part-${part.kind}`} />
            <span>{part.text}</span>
            <span className="ns">{shownTime(part.to - part.from)}</span>
          </li>
        ))}
      </ol>
      {run.hops.length === 0 && <p className="faint">Events are missing, so that the way of the value is not known.</p>}
    </div>
  );
}

/** Milliseconds since the reading or the event. */
function Axis({ run, drawn, width }: { run: TimedRun; drawn: DrawnRun; width: number }) {
  const span = run.to_ns - run.from_ns;
  const step = niceStep(Math.max(1, span) / Math.max(2, Math.min(8, width / 60)));
  const bottom = drawn.height - runSizes.below;
  const unit = step >= 1e9 ? { ns: 1e9, name: "s" } : step >= 1e5 ? { ns: 1e6, name: "ms" } : { ns: 1e3, name: "us" };
  const times = Array.from({ length: Math.floor(span / step) + 1 }, (_, at) => at * step);
  return (
    <g className="run-axis">
      {times.map((time) => {
        const x = drawn.x(run.from_ns + time);
        return (
          <g key={time}>
            <line x1={x} x2={x} y1={runSizes.top} y2={bottom} />
            <text x={x} y={bottom + 15} textAnchor="middle">
              {Number((time / unit.ns).toFixed(3))}
            </text>
          </g>
        );
      })}
      <text className="unit" x={width - 1} y={drawn.height - 1} textAnchor="end">
        {unit.name}
      </text>
    </g>
  );
}

function Call({ one, run, pointed, onPoint }: { one: DrawnCall; run: TimedRun; pointed: boolean; onPoint: () => void }) {
  const { call, x, y, width, carries } = one;
  const text = `${call.subsystem}.${call.behaviour}: from ${call.begin_ns < run.from_ns ? "before" : since(run, call.begin_ns)} to ${since(run, call.end_ns)}, ${shownTime(call.end_ns - call.begin_ns)}`;
  return (
    <g onPointerEnter={onPoint}>
      <rect
        className={`call${carries ? " carries" : ""}${pointed ? " pointed" : ""}`}
        x={x}
        y={y}
        width={width}
        height={runSizes.bar}
        rx={2}
      >
        <title>{text}</title>
      </rect>
      {width > call.behaviour.length * letter + 8 && (
        <text className={`call-name${carries ? " carries" : ""}`} x={x + 4} y={y + 13}>
          {call.behaviour}
        </text>
      )}
    </g>
  );
}

/** The line from the reading over all channels to the command, with its marks. */
function WayOfValue({ drawn, run, shown }: { drawn: DrawnRun; run: TimedRun; shown: Shown }) {
  const { line, arrows, begin, end } = drawn;
  return (
    <g className="run-way">
      <polyline points={line.map(({ x, y }) => `${x},${y}`).join(" ")} />
      {arrows.map(({ hop, x1, y1, x2, y2 }) => (
        <g key={hop.channel}>
          <circle cx={x1} cy={y1} r={3.5}>
            <title>{`written into ${hop.channel} after ${since(run, hop.written_ns)}`}</title>
          </circle>
          <path d={arrowHead(x1, y1, x2, y2)}>
            <title>{`${hop.to} receives it after ${since(run, hop.read_ns)}`}</title>
          </path>
        </g>
      ))}
      {shown === "age" ? (
        <circle className="run-mark" cx={begin.x} cy={begin.y} r={5.5}>
          <title>The device is read</title>
        </circle>
      ) : (
        <path className="run-mark" d={`M ${begin.x} ${begin.y - 7} l 6 7 l -6 7 l -6 -7 z`}>
          <title>An event at the device, just after it was read</title>
        </path>
      )}
      <path className="run-mark" d={`M ${end.x - 6} ${end.y - 6} h 12 v 12 h -12 z`}>
        <title>The command is given</title>
      </path>
    </g>
  );
}

/** The head of an arrow that ends at a point. */
function arrowHead(x1: number, y1: number, x2: number, y2: number): string {
  const length = Math.hypot(x2 - x1, y2 - y1) || 1;
  const [dx, dy] = [(x2 - x1) / length, (y2 - y1) / length];
  const back = (side: number) => `${x2 - 9 * dx - side * 4.5 * dy},${y2 - 9 * dy + side * 4.5 * dx}`;
  return `M ${x2},${y2} L ${back(1)} L ${back(-1)} z`;
}

/** The whole time, as a dimension above the lanes. */
function Dimension({ drawn, run, width }: { drawn: DrawnRun; run: TimedRun; width: number }) {
  const { begin, end } = drawn;
  const y = 22;
  const text = shownTime(run.to_ns - run.from_ns);
  const middle = Math.min(width - 40, Math.max(40, (begin.x + end.x) / 2));
  return (
    <g className="run-dimension">
      <line x1={begin.x} x2={begin.x} y1={y - 6} y2={begin.y} />
      <line x1={end.x} x2={end.x} y1={y - 6} y2={end.y} />
      <line x1={begin.x} x2={end.x} y1={y} y2={y} />
      <path d={arrowHead(end.x, y, begin.x, y)} />
      <path d={arrowHead(begin.x, y, end.x, y)} />
      <text x={middle} y={y - 6} textAnchor="middle">
        {text}
      </text>
    </g>
  );
}
