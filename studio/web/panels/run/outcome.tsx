import type { CheckOutcome, MeasureOutcome, Outcome } from "../../model/protocol";
import { TableHead } from "../table_head";

const count = (many: number) => many.toLocaleString("en");

/** The result of a run that has ended. */
export function OutcomeOf({ outcome }: { outcome: Outcome }) {
  const { simulated_s, wall_s, real_time_factor, firings, lost_events, warnings, subsystems, checks, measures } = outcome;
  return (
    <>
      <h3>Outcome</h3>
      <p>
        {simulated_s.toFixed(2)} s in {wall_s.toFixed(2)} s ({real_time_factor.toPrecision(3)} × real time), {count(firings)}{" "}
        firings
      </p>
      {lost_events > 0 && <p className="problem-hint">{count(lost_events)} events are missing from the recording</p>}
      {warnings.map((warning) => (
        <p key={warning} className="problem-hint">
          {warning}
        </p>
      ))}
      {checks && checks.length > 0 && <ChecksOf checks={checks} />}
      {measures && Object.keys(measures).length > 0 && <MeasuresOf measures={measures} />}
      <table className="outcome">
        <TableHead columns={["Subsystem", "Iterations", "Overruns", "Errors"]} />
        <tbody>
          {subsystems.map((one) => (
            <tr key={one.path}>
              <th scope="row" title={one.path}>
                {one.path}
              </th>
              <td>{count(one.iterations)}</td>
              <td className={one.overruns > 0 ? "bad" : ""}>{count(one.overruns)}</td>
              <td className={one.errors > 0 ? "bad" : ""}>{count(one.errors)}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </>
  );
}

function ChecksOf({ checks }: { checks: readonly CheckOutcome[] }) {
  return (
    <table className="outcome">
      <TableHead columns={["Check", "Verdict", "At"]} />
      <tbody>
        {checks.map(({ name, text, verdict, time_s, detail }) => (
          <tr key={name} title={detail ? `${text}: ${detail}` : text}>
            <th scope="row">{name}</th>
            <td className={verdict === "failed" ? "bad" : ""}>{verdict}</td>
            <td>{time_s === undefined ? "" : `${time_s.toFixed(2)} s`}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}

function MeasuresOf({ measures }: { measures: Readonly<Record<string, MeasureOutcome | null>> }) {
  return (
    <table className="outcome">
      <TableHead columns={["Measure", "Least", "Mean", "Greatest"]} />
      <tbody>
        {Object.entries(measures).map(([name, one]) => (
          <tr key={name}>
            <th scope="row">
              {name}
              {one?.unit && <span className="unit"> in {one.unit}</span>}
            </th>
            <td title={one ? `at ${one.least_at_s.toFixed(2)} s` : ""}>{one?.least.toPrecision(4)}</td>
            <td>{one?.mean.toPrecision(4)}</td>
            <td title={one ? `at ${one.greatest_at_s.toFixed(2)} s` : ""}>{one?.greatest.toPrecision(4)}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}
