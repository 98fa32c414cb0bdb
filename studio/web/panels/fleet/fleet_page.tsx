import { useStore, useStudio } from "../../hooks/use";
import { lossOf, trouble, worstFirst } from "../../live/deployment";
import type { LinkSeen, ProcessSeen, WaitingChain } from "../../model/protocol";
import { reason } from "../pane_title";

const stateTitles: Record<Exclude<ProcessSeen["state"], "absent">, string> = {
  running: "running",
  silent: "says nothing",
  ended: "ended",
  gone: "gone",
};
const seconds = (value: number) => `${value.toFixed(1)} s`;
/** The largest number of rows of links; the rest has no problem. */
const mostLinks = 60;
const mostChains = 20;

/** All processes of a deployed system: their states, which waits for which, and the messages between them. */
export function FleetPage() {
  const studio = useStudio();
  const names = useStore(studio.project, (all) => all.project?.processes ?? none);
  const { state, kind, why, problem } = useStore(studio.runner.store, (all) => all);
  const seen = useStore(studio.deployment.store, (all) => all.seen);
  const busy = ["building", "running", "paused"].includes(state);
  const watching = busy && kind === "deployment";
  const running = seen?.processes.filter((one) => one.state === "running").length ?? 0;
  return (
    <section className="fleet" aria-label="Fleet" data-testid="fleet">
      <header className="fleet-head">
        <h2>
          {watching && seen
            ? `${running} of ${names.length} processes run${seen.network ? "" : " on this machine"}`
            : `${names.length} processes`}
        </h2>
        {watching ? (
          <button onClick={() => void studio.runner.control({ command: "stop" })}>Stop watching</button>
        ) : (
          <button className="primary" disabled={busy} onClick={() => void studio.run({ kind: "deployment" })}>
            Watch all processes
          </button>
        )}
        {busy && !watching && <span className="faint">Another run is shown. Stop it, or stop watching it, first.</span>}
        {problem && <span className="problem-hint">{problem}</span>}
        {!busy && kind === "deployment" && why && <span role="status">{reason(why)}</span>}
      </header>
      {!watching && !seen && (
        <p className="faint">
          <code>tessera run --deploy</code> starts the processes. Watching disturbs none of them.
        </p>
      )}
      {seen && !watching && <p className="fleet-old">What was seen last; nothing is watched now.</p>}
      {seen?.remark && <p className="problem-hint">{seen.remark}</p>}
      {seen && (
        <>
          {seen.waits.length > 0 && <Waits waits={seen.waits} />}
          <ul className="fleet-cards" aria-label="Processes">
            {[...seen.processes]
              .sort((one, other) => trouble(other) - trouble(one))
              .map((one) => (
                <Card key={one.name} process={one} network={seen.network} />
              ))}
          </ul>
          {seen.links.length > 0 && <Links links={seen.links} />}
        </>
      )}
    </section>
  );
}
const none: readonly string[] = [];

/** The end of a long chain matters most. */
const mostSteps = 6;
function shortened<T>(steps: readonly T[]): readonly T[] {
  return steps.length > mostSteps ? [...steps.slice(0, 2), ...steps.slice(-2)] : steps;
}

function Waits({ waits }: { waits: readonly WaitingChain[] }) {
  const studio = useStudio();
  return (
    <div className="fleet-waits">
      <h3>Who waits for whom</h3>
      <ul>
        {waits.slice(0, mostChains).map(({ steps, end }) => (
          <li key={steps[0]!.subsystem}>
            {shortened(steps).map((step, at) => (
              <span key={step.subsystem} className="fleet-step">
                {at > 0 && <span aria-hidden="true">→ </span>}
                {at === 2 && steps.length > mostSteps && <span className="faint">{steps.length - 4} more in between → </span>}
                <button className="quiet" title={step.channel} onClick={() => studio.flyTo(step.subsystem)}>
                  {step.text}
                </button>
              </span>
            ))}
            {end && <strong className="fleet-end">{end}</strong>}
          </li>
        ))}
        {waits.length > mostChains && <li className="faint">and {waits.length - mostChains} more</li>}
      </ul>
    </div>
  );
}

function Card({ process, network }: { process: ProcessSeen; network: boolean }) {
  const studio = useStudio();
  const { name, state, since_s, host, pid, time_s, emergency, overruns, errors, agents, subsystems } = process;
  const dot = state === "running" ? (emergency === null ? "good" : "error") : state === "gone" ? "error" : "warning";
  const there = state === "running" || state === "silent";
  return (
    <li className={`fleet-card ${state}`} data-testid={`process-${name}`}>
      <h3>
        <span className={`dot ${state === "absent" || state === "ended" ? "" : dot}`} /> <span className="path">{name}</span>
      </h3>
      <p>
        {state !== "absent" ? stateTitles[state] : network ? "not heard" : "not on this machine"}
        {(state === "gone" || state === "silent") && since_s !== null && ` for ${seconds(since_s)}`}
        {state === "running" && time_s !== null && `, ${seconds(time_s)}`}
        {host && <span className="faint"> on {host}</span>}
        {pid !== null && <span className="faint"> · process {pid}</span>}
      </p>
      {emergency !== null && <p className="fleet-emergency">Emergency stop: {emergency}</p>}
      {errors > 0 && <p className="fleet-emergency">{errors} errors of user code</p>}
      {overruns > 0 && <p className="faint">{overruns} overruns</p>}
      {process.left_out > 0 && <p className="faint">Its message had no room for {process.left_out} more lines.</p>}
      {there && !process.followed && (
        <p className="faint">
          {process.by_network ? "It is heard over the network. " : "Its recording cannot be read here. "}The drawing of the net
          does not show its tokens.
        </p>
      )}
      {subsystems.length === 0 && <p className="faint">{agents.join(", ")}</p>}
      <ul className="fleet-doings">
        {subsystems.map(({ path, behaviour, ended }) => (
          <li key={path}>
            <button className="quiet path" onClick={() => studio.flyTo(path)}>
              {path}
            </button>
            <span className={`chip ${there && behaviour !== null && !ended ? "running" : ""}`}>
              {ended ? "ended" : (behaviour ?? "not begun")}
            </span>
          </li>
        ))}
      </ul>
    </li>
  );
}

function clockText({ clock_ahead_s, clock_uncertainty_s }: LinkSeen): string {
  if (clock_ahead_s === null) return "–";
  const sign = clock_ahead_s < 0 ? "−" : "+";
  const [factor, unit] = Math.abs(clock_ahead_s) + clock_uncertainty_s < 1 ? [1e3, "ms"] : [1, "s"];
  return `${sign}${(Math.abs(clock_ahead_s) * factor).toFixed(2)} ± ${(clock_uncertainty_s * factor).toFixed(2)} ${unit}`;
}

function Links({ links }: { links: readonly LinkSeen[] }) {
  return (
    <>
      <h3>Links</h3>
      <table className="fleet-links">
        <thead>
          <tr>
            <th scope="col">Process</th>
            <th scope="col">hears</th>
            <th scope="col">State</th>
            <th scope="col" title="Age of the newest message or sign of life">
              Heard
            </th>
            <th scope="col" title="Of the last 64 signs of life">
              Loss
            </th>
            <th scope="col">Sent</th>
            <th scope="col" title="Values and recalls that were sent again">
              Repeated
            </th>
            <th scope="col">Received</th>
            <th scope="col" title="Values and recalls that came again, or after newer ones">
              Duplicates
            </th>
            <th scope="col" title="How far the clock of the other is ahead; an estimate with its uncertainty">
              Its clock
            </th>
          </tr>
        </thead>
        <tbody>
          {worstFirst(links)
            .slice(0, mostLinks)
            .map((link) => (
              <tr key={`${link.process} ${link.peer}`} className={link.reachable ? "" : "bad"}>
                <th scope="row">{link.process}</th>
                <td>{link.peer}</td>
                <td>{link.reachable ? "reachable" : `disconnected for ${seconds(link.for_s)}`}</td>
                <td>{link.heard_s === null ? "never" : seconds(link.heard_s)}</td>
                <td className={lossOf(link) > 0 ? "warn" : ""}>
                  {link.signs === 0 ? "–" : `${Math.round(lossOf(link) * 100)} %`}
                </td>
                <td>{link.sent}</td>
                <td>{link.repeated}</td>
                <td>{link.received}</td>
                <td>{link.duplicates}</td>
                <td>{clockText(link)}</td>
              </tr>
            ))}
        </tbody>
      </table>
      {links.length > mostLinks && <p className="faint">and {links.length - mostLinks} more, none of them worse</p>}
    </>
  );
}
