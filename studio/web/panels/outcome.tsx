import type { Outcome } from "../live/protocol";

const count = (many: number) => many.toLocaleString("en");

/** The result of a run that has ended. */
export function OutcomeOf({ outcome }: { outcome: Outcome }) {
  const { simulated_s, wall_s, real_time_factor, firings, lost_events, warnings, subsystems } = outcome;
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
      <table className="outcome">
        <thead>
          <tr>
            <th scope="col">Subsystem</th>
            <th scope="col">Iterations</th>
            <th scope="col">Overruns</th>
            <th scope="col">Errors</th>
          </tr>
        </thead>
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
