import { useStudio } from "../../hooks/use";
import { useStructure } from "../../hooks/use_structure";
import { senderOf } from "../../model/structure/senders";
import { keyOf } from "../../model/plots/signals";
import { shown } from "../../model/run/series";
import { factsOf, readAt, type PlotLine } from "./plot_lines";

interface PlotTableProps {
  lines: readonly PlotLine[];
  from: number;
  to: number;
  cursors: readonly (number | null)[];
}

/** The legend of a plot, with the values at both cursors and the statistics of the visible span. */
export function PlotTable({ lines, from, to, cursors: [a = null, b = null] }: PlotTableProps) {
  const studio = useStudio();
  const structure = useStructure();
  const senders = lines.map(({ signal }) => (signal.kind === "behaviour" ? undefined : senderOf(structure, signal.path)));
  const sent = senders.some((one) => one !== undefined);
  return (
    <div className="plot-table" tabIndex={0} role="region" aria-label="Values and statistics of the plot">
      <table>
        <thead>
          <tr>
            <th scope="col">Signal</th>
            <th scope="col">Unit</th>
            {sent && (
              <th scope="col" title="The subsystem that sends the values of an input, and its rate">
                Sent by
              </th>
            )}
            {a !== null && <th scope="col">at A</th>}
            {b !== null && <th scope="col">at B</th>}
            {a !== null && b !== null && <th scope="col">B − A</th>}
            <th scope="col">min</th>
            <th scope="col">mean</th>
            <th scope="col">max</th>
            <th scope="col" title="Standard deviation over time">
              std
            </th>
            <th scope="col" title="New values in the visible span">
              count
            </th>
            <th scope="col" title="New values per second">
              per s
            </th>
            <th scope="col">
              <span className="visually-hidden">Remove</span>
            </th>
          </tr>
        </thead>
        <tbody>
          {lines.map((line, at) => {
            const sender = senders[at];
            const facts = line.hidden ? null : factsOf(line, from, to);
            const [atA, atB] = [a, b].map((time) => (time === null ? undefined : readAt(line, time)));
            const difference = typeof atA === "number" && typeof atB === "number" ? atB - atA : undefined;
            const number = (value: number | undefined) => (
              <td>{value === undefined ? "" : shown(Number(value.toPrecision(6)))}</td>
            );
            return (
              <tr key={line.name} className={line.hidden ? "hidden" : ""}>
                <th scope="row">
                  <button
                    className="legend"
                    aria-pressed={!line.hidden}
                    title={`${line.hidden ? "Show" : "Hide"} ${line.name}${line.source.remark && `: ${line.source.remark}`}`}
                    onClick={() => studio.plots.toggleHidden(`${keyOf(line.signal)} ${line.source.name}`)}
                  >
                    <svg width="18" height="8" aria-hidden>
                      {line.states ? (
                        <rect width="18" height="8" fill={line.colour} opacity="0.5" />
                      ) : (
                        <line
                          x2="18"
                          y1="4"
                          y2="4"
                          stroke={line.colour}
                          strokeWidth="2.5"
                          strokeDasharray={line.dash.join(" ")}
                        />
                      )}
                    </svg>
                    {line.name}
                  </button>
                </th>
                <td>{line.unit}</td>
                {sent && (
                  <td>
                    {sender && (
                      <button
                        className="link"
                        title={`Show ${sender.path}, which sends these values`}
                        onClick={() => studio.comeNear(sender.path, structure)}
                      >
                        {sender.path}
                        {sender.rate && ` (${sender.rate})`}
                      </button>
                    )}
                  </td>
                )}
                {a !== null && <td>{shown(atA)}</td>}
                {b !== null && <td>{shown(atB)}</td>}
                {a !== null && b !== null && number(difference)}
                {number(facts?.min)}
                {number(facts?.mean)}
                {number(facts?.max)}
                {number(facts?.std)}
                {number(facts?.count)}
                {number(facts?.rate)}
                <td>
                  <button
                    className="quiet"
                    aria-label={`Remove the plot of ${line.name}`}
                    title="Remove this signal"
                    onClick={() => studio.plots.remove(line.signal)}
                  >
                    ×
                  </button>
                </td>
              </tr>
            );
          })}
        </tbody>
      </table>
    </div>
  );
}
