import { useEffect, useState } from "react";
import { useStore, useStudio } from "../../hooks/use";
import { shown } from "../../model/run/series";
import {
  distributionOf,
  measuresOf,
  sweptParameters,
  sweptPoints,
  sweptValues,
  type SweepField,
  type SweepTyped,
} from "../../model/run/sweep";
import { save } from "../plots/save_plot";
import { SweepCurve, SweepDistribution } from "./sweep_chart";

const usual: SweepTyped = { parameter: "", from: "", to: "", steps: "11", runs: "5", seed: "1", duration: "10s" };

/** Many runs: a parameter over its values, or only the seeds. */
export function SweepPanel() {
  const studio = useStudio();
  const [open, setOpen] = useState(false);
  const going = useStore(studio.sweeps.store, ({ shown: one }) => one?.state === "running" || one?.state === "building");
  return (
    <details className="sweep" open={open || going} onToggle={({ currentTarget }) => setOpen(currentTarget.open)}>
      <summary>
        <h2>Many runs: vary a parameter or the seed</h2>
      </summary>
      {(open || going) && (
        <>
          <SweepForm />
          <SweepResult />
        </>
      )}
    </details>
  );
}

function SweepForm() {
  const studio = useStudio();
  const { parameters, processes, shown: sweep, problem } = useStore(studio.sweeps.store, (all) => all);
  const revision = useStore(studio.draft.store, (draft) => draft.revision);
  const [typed, setTyped] = useState(usual);
  const [interleave, setInterleave] = useState(false);
  const [refused, setRefused] = useState("");
  const [tried, setTried] = useState(false);
  useEffect(() => void studio.sweeps.refresh(), [studio, revision]);
  const offered = sweptParameters(parameters);
  const chosen = offered.find(({ path }) => path === typed.parameter);
  const { values, mistakes } = sweptValues(typed, chosen);
  const active = sweep?.state === "running" || sweep?.state === "building";
  const change = (field: SweepField, text: string) => setTyped({ ...typed, [field]: text });
  const start = async () => {
    setTried(true);
    if (Object.keys(mistakes).length > 0) return;
    if (!(await studio.trust.given()) || !(await studio.saveAll())) return;
    const runs = Number(typed.runs);
    setRefused(
      await studio.sweeps.start({
        ...(typed.parameter ? { parameter: typed.parameter, values } : {}),
        runs,
        seed: Number(typed.seed),
        for: typed.duration.replace(/\s/g, ""),
        interleave,
      }),
    );
  };
  const field = (name: SweepField, label: string, title: string) => {
    const wrong = (tried || typed[name] !== usual[name]) && mistakes[name];
    return (
      <label title={title}>
        {label}
        <input
          type="text"
          value={typed[name]}
          aria-invalid={Boolean(wrong)}
          onChange={({ target }) => change(name, target.value)}
          onKeyDown={({ key }) => key === "Enter" && !active && void start()}
        />
        {wrong && <span className="problem-hint">{wrong}</span>}
      </label>
    );
  };
  const unit = chosen?.unit ? ` (${chosen.unit})` : "";
  return (
    <div className="sweep-form">
      <label>
        Parameter
        <select value={typed.parameter} onChange={({ target }) => change("parameter", target.value)}>
          <option value="">none: only the seeds differ</option>
          {offered.map(({ path, unit: its }) => (
            <option key={path} value={path}>
              {path}
              {its && ` (${its})`}
            </option>
          ))}
        </select>
      </label>
      {chosen && (
        <p className="faint">
          {`It is ${chosen.initial} ${chosen.unit}`.trim()}
          {chosen.minimum !== null && `, at least ${chosen.minimum}`}
          {chosen.maximum !== null && `, at most ${chosen.maximum}`}.
        </p>
      )}
      {typed.parameter !== "" && (
        <div className="row">
          {field("from", `From${unit}`, "The first value")}
          {field("to", `To${unit}`, "The last value")}
          {field("steps", "Values", "So many values, evenly apart")}
        </div>
      )}
      <div className="row">
        {field("runs", typed.parameter ? "Runs of each" : "Runs", "Each with the next seed")}
        {field("seed", "First seed", "The seed decides the noise of the sensors")}
        {field("duration", "Run for", "Simulated time of each run")}
      </div>
      <label className="switch">
        <input type="checkbox" checked={interleave} onChange={({ target }) => setInterleave(target.checked)} /> The seed also
        changes the order of the subsystems
      </label>
      <div className="sweep-buttons">
        {active ? (
          <button onClick={() => void studio.sweeps.stop()}>Stop the runs</button>
        ) : (
          <button className="primary" onClick={() => void start()}>
            Start the runs
          </button>
        )}
        <span className="faint">{processes} at a time, without recordings. The same again goes on where it was stopped.</span>
      </div>
      {(refused || problem) && (
        <p className="problem-hint" role="alert">
          {refused || problem}
        </p>
      )}
    </div>
  );
}

function SweepResult() {
  const studio = useStudio();
  const { shown: sweep, rows } = useStore(studio.sweeps.store, (all) => all);
  const [wanted, setWanted] = useState("");
  if (!sweep) return null;
  const measures = measuresOf(rows);
  const measure = measures.includes(wanted) ? wanted : (measures.find((name) => name.endsWith(", mean")) ?? measures[0] ?? "");
  const unit = rows.find(({ units }) => units[measure])?.units[measure] ?? "";
  const title = unit ? `${measure} (${unit})` : measure;
  const points = sweptPoints(rows, measure);
  const failed = rows.find((row) => row.failed);
  const state = { building: "building the controller", running: "running", done: "done", stopped: "stopped", failed: "failed" };
  return (
    <div className="sweep-result">
      <p role="status">
        {sweep.parameter || "seeds"}: {sweep.done} of {sweep.of} runs, {state[sweep.state]}
        {sweep.reused > 0 && `, ${sweep.reused} from an earlier sweep`}
        {sweep.line && ` (${sweep.line})`}
        {sweep.why && `: ${sweep.why}`}
      </p>
      <progress aria-label="Runs that are done" max={sweep.of} value={sweep.done} />
      {rows.length > 0 && (
        <>
          <label>
            Measure
            <select value={measure} onChange={({ target }) => setWanted(target.value)}>
              {measures.map((name) => (
                <option key={name}>{name}</option>
              ))}
            </select>
          </label>
          {sweep.parameter ? (
            <SweepCurve points={points} measure={title} parameter={sweep.parameter} />
          ) : (
            <SweepDistribution bins={distributionOf(rows, measure)} measure={title} />
          )}
          {failed && (
            <p className="faint">
              {rows.filter((row) => row.failed).length} failed; the first: {failed.value && `${failed.value}, `}seed {failed.seed}
              : {failed.ended.slice(0, 300)}
            </p>
          )}
          <div className="sweep-table" tabIndex={0} role="region" aria-label="Results of the runs">
            <table>
              <thead>
                <tr>
                  <th scope="col">{sweep.parameter ? "value" : "all seeds"}</th>
                  {["runs", "failed", "min", "mean", "max", "std"].map((name) => (
                    <th key={name} scope="col">
                      {name}
                    </th>
                  ))}
                </tr>
              </thead>
              <tbody>
                {points.map(({ value, runs, failed: bad, numbers }) => (
                  <tr key={value}>
                    <th scope="row">{value || "all"}</th>
                    <td>{runs}</td>
                    <td>{bad}</td>
                    <td>{shown(numbers?.min)}</td>
                    <td>{shown(numbers?.mean)}</td>
                    <td>{shown(numbers?.max)}</td>
                    <td>{shown(numbers?.std)}</td>
                  </tr>
                ))}
              </tbody>
            </table>
          </div>
          <button className="quiet" onClick={() => save("sweep.csv", new Blob([sweepCsv(rows, measures)], { type: "text/csv" }))}>
            CSV of all runs
          </button>
        </>
      )}
    </div>
  );
}

/** A row for each run. */
function sweepCsv(
  rows: readonly { value: string; seed: number; failed: boolean; numbers: Record<string, number | null> }[],
  measures: readonly string[],
): string {
  const quoted = (text: string) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
  return [
    ["value", "seed", "failed", ...measures.map(quoted)].join(","),
    ...rows.map(({ value, seed, failed, numbers }) =>
      [quoted(value), seed, failed ? 1 : 0, ...measures.map((name) => numbers[name] ?? "")].join(","),
    ),
    "",
  ].join("\n");
}
