import { useCallback, useEffect, useState } from "react";
import { useHasWorld, useStore, useStudio, useUnsaved } from "../../hooks/use";
import { message } from "../../live/api";
import { numberIn, startRequest } from "../../live/run/start_request";
import type { Project } from "../../model/protocol";
import { Choice, Field } from "../forms/field";

const kindsOf = (hasWorld: boolean, deployed: boolean) =>
  [
    { value: "simulate", title: hasWorld ? "in the simulated world" : "on the simulated clock" },
    { value: "run", title: "on the steady clock, as on the robot" },
    { value: "attach", title: "no new run: watch one that is running" },
    ...(deployed ? [{ value: "deployment", title: "no new run: watch all running processes" } as const] : []),
  ] as const;

function KindChoice() {
  const studio = useStudio();
  const { wishes } = studio.runner;
  const kind = useStore(wishes, (all) => all.kind);
  const deployed = useStore(studio.project, (all) => (all.project?.processes.length ?? 0) > 0);
  const kinds = kindsOf(useHasWorld(), deployed);
  return <Choice label="Run" value={kind} onChange={(kind) => wishes.set({ kind })} choices={kinds} />;
}

const wrongSpeed = (text: string) =>
  numberIn(text) >= 0 ? undefined : "A number: simulated seconds a second; 0: as fast as possible";
const wrongSeed = (text: string) =>
  Number.isSafeInteger(numberIn(text)) && numberIn(text) >= 0 ? undefined : "A whole number, not negative";

/** Controllers that were started elsewhere and can be followed. */
function AttachForm() {
  const studio = useStudio();
  const [sockets, setSockets] = useState<readonly string[] | null>(null);
  const [chosen, setChosen] = useState("");
  const [problem, setProblem] = useState("");
  const look = useCallback(
    () =>
      studio.api.controllers().then(
        (found) => (setSockets(found), setProblem("")),
        (error: unknown) => setProblem(message(error)),
      ),
    [studio],
  );
  useEffect(() => void look(), [look]);
  const socket = sockets?.includes(chosen) ? chosen : (sockets?.[0] ?? "");
  return (
    <>
      <KindChoice />
      {problem && <p className="problem-hint">{problem}</p>}
      {sockets?.length === 0 && <p className="faint">No controller runs on this machine for this user.</p>}
      {socket && (
        <Choice
          label="Controller"
          value={socket}
          onChange={setChosen}
          choices={sockets!.map((one) => ({ value: one, title: one.replace(/\.sock$/, "") }))}
        />
      )}
      <div className="buttons">
        <button className="primary" disabled={!socket} onClick={() => void studio.run({ kind: "attach", socket })}>
          Watch it
        </button>
        <button onClick={() => void look()}>Refresh</button>
      </div>
    </>
  );
}

/** The processes of a deployed system are found by themselves. */
function DeploymentForm() {
  const studio = useStudio();
  const watch = async () => {
    studio.view.set({ view: "fleet" });
    await studio.run({ kind: "deployment" });
  };
  return (
    <>
      <KindChoice />
      <div className="buttons">
        <button className="primary" onClick={() => void watch()}>
          Watch all processes
        </button>
      </div>
    </>
  );
}

/** The possible floors of the simulated world; nothing if that world has no floor picture. */
export const tracksOf = (project: Project | null) =>
  project?.simulation?.track
    ? (project.worlds.find(({ name }) => name === project.simulation!.world.split("/").at(-1))?.tracks ?? [])
    : [];

/** The settings of the next run. */
export function StartForm() {
  const studio = useStudio();
  const runner = useStore(studio.runner.store, (all) => all);
  const project = useStore(studio.project, (all) => all.project);
  const hasWorld = useHasWorld();
  const dirty = useUnsaved();
  const current = useStore(studio.draft.store, (draft) => draft.current);
  const { wishes } = studio.runner;
  const { kind, track, time, seed, speed, all } = useStore(wishes, (all) => all);
  const tracks = tracksOf(project);
  if (kind === "attach") return <AttachForm />;
  if (kind === "deployment") return <DeploymentForm />;
  const start = async (paused: boolean) => {
    if (!(await studio.saveAll())) return;
    await studio.run(startRequest(wishes.get(), tracks, paused));
  };
  return (
    <>
      <KindChoice />
      {tracks.length > 0 && (
        <Choice
          label="Track"
          value={tracks.includes(track) ? track : ""}
          onChange={(track) => wishes.set({ track })}
          choices={[{ value: "", title: "as the specification says" }, ...tracks.map((one) => ({ value: one, title: one }))]}
        />
      )}
      <div className="row">
        <Field apart label="For" value={time} onChange={(time) => wishes.set({ time })} />
        {kind === "simulate" && (
          <Field apart label="Speed" value={speed} onChange={(speed) => wishes.set({ speed })} wrong={wrongSpeed} />
        )}
        {kind === "simulate" && (
          <Field apart label="Seed" value={seed} onChange={(seed) => wishes.set({ seed })} wrong={wrongSeed} />
        )}
      </div>
      {hasWorld && (
        <label className="check" title="Otherwise a recording holds values of up to 4 KiB. Pictures make it large.">
          <input type="checkbox" checked={all} onChange={(event) => wishes.set({ all: event.target.checked })} />
          Record pictures and other large values
        </label>
      )}
      <div className="buttons">
        <button className="primary" disabled={!current} onClick={() => void start(false)}>
          {dirty ? "Save and run" : "Run"}
        </button>
        {kind === "simulate" && (
          <button disabled={!current} onClick={() => void start(true)}>
            Start paused
          </button>
        )}
        {runner.state !== "idle" && <button onClick={() => studio.runner.close()}>Close this run</button>}
      </div>
    </>
  );
}
