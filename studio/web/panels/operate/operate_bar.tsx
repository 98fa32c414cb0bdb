import { useEffect, useState } from "react";
import { useStore, useStudio } from "../../hooks/use";
import { EmergencyBar, useDriving } from "../emergency_bar";
import { Icon } from "../icons";
import { reason, stateTitles } from "../pane_title";

/** The stop, always at the same place, and what is operated, over which connection. */
export function OperateBar() {
  const studio = useStudio();
  useEffect(() => studio.operator.lookAtOthers(), [studio]);
  return (
    <header className="operate-bar">
      <h1 className="visually-hidden">Operate</h1>
      <StopPlace />
      <div className="operate-state">
        <Operated />
        <Heard />
      </div>
      <Tools />
    </header>
  );
}

function StopPlace() {
  const studio = useStudio();
  const { kind, state } = useStore(studio.runner.store, (all) => all);
  const simulated = kind === "simulate" && (state === "running" || state === "paused");
  if (useDriving() || !simulated) return <EmergencyBar always />;
  return (
    <section className="emergency emergency-part" aria-label="Stop of the simulation">
      <button
        className="emergency-stop of-simulation"
        title="Ends the simulated run"
        onClick={() => void studio.runner.control({ command: "stop" })}
      >
        STOP THE RUN
      </button>
    </section>
  );
}

/** The run that the panels belong to: what moves, and whether it does. */
function Operated() {
  const studio = useStudio();
  const name = useStore(studio.project, (all) => all.project?.name ?? "");
  const { kind, state, why } = useStore(studio.runner.store, (all) => all);
  const drives = useDriving();
  const simulatedWorld = useSimulatedWorld();
  const controllers = useStore(studio.emergency.store, (all) => all.controllers);
  const stopped = controllers.length > 0 && controllers.every(({ emergency }) => emergency !== null);
  if (state === "idle") return <p role="status">Nothing runs.</p>;
  const going = state === "running" || state === "paused";
  const isSimulation = kind === "simulate" || (kind === "attach" && !drives);
  return (
    <p role="status" data-testid="operated">
      <strong className={isSimulation || simulatedWorld ? "simulated" : "real"}>
        {isSimulation ? "Simulation" : simulatedWorld ? "Simulated world in real time" : "Real devices"}
      </strong>{" "}
      of <span className="path">{name}</span>: {stateTitles[state].toLowerCase()}
      {why && ` (${reason(why)})`}
      {going && stopped && <strong className="real">, but the emergency stop holds: nothing moves before it is reset</strong>}
      {going && kind === "attach" && ". It was started elsewhere."}
    </p>
  );
}

/** A simulated world has a scene, which comes some time after the run began. */
function useSimulatedWorld(): boolean {
  const studio = useStudio();
  const [there, setThere] = useState(false);
  useEffect(() => {
    const look = () => setThere(Boolean(studio.runner.track?.world));
    const timer = setInterval(look, 500);
    look();
    return () => clearInterval(timer);
  }, [studio]);
  return there;
}

/** An answer that is older than this (ms) is missed. */
const late = 2500;

/** The age of the last answer of the server, so that nobody takes a picture of the past for the present. */
function Heard() {
  const studio = useStudio();
  const { state } = useStore(studio.connection.store, (all) => all);
  const going = useStore(studio.runner.store, (all) => all.state === "running" || all.state === "paused");
  const [now, setNow] = useState(() => performance.now());
  useEffect(() => {
    const timer = setInterval(() => setNow(performance.now()), 250);
    return () => clearInterval(timer);
  }, []);
  const { heard, others } = studio.operator.store.get();
  if (state === "refused")
    return (
      <p className="not" role="alert">
        The server was started anew: open the address that <code>tessera studio</code> printed.
      </p>
    );
  const age = heard && going ? Math.max(0, now - heard.at) : null;
  if (state === "lost" || (age !== null && age > late))
    return (
      <p className="not" role="alert">
        No answer{age === null ? "" : ` for ${Math.round(age / 1000)} s`}: what you see is old, and nothing you move arrives.
      </p>
    );
  return (
    <p className="faint">
      {state === "open" ? "Connected" : "Connecting…"}
      {age !== null && `: answered ${(age / 1000).toFixed(1)} s ago, in ${Math.max(1, Math.round(heard!.took))} ms`}
      {others.size > 0 && `. Another page operates, too; this one is ${studio.operator.name}`}
    </p>
  );
}

function Tools() {
  const studio = useStudio();
  const theme = useStore(studio.view, (view) => view.theme);
  const [full, setFull] = useState(false);
  const wake = useWakeLock();
  useEffect(() => {
    const look = () => setFull(document.fullscreenElement !== null);
    document.addEventListener("fullscreenchange", look);
    return () => document.removeEventListener("fullscreenchange", look);
  }, []);
  const changeFull = () =>
    void (full ? document.exitFullscreen() : document.documentElement.requestFullscreen()).catch(() => {
      // The browser does not allow it: the page stays as it is.
    });
  return (
    <div className="operate-tools">
      {document.fullscreenEnabled && <Tool name="full" label="Full screen" pressed={full} onClick={changeFull} />}
      {wake.possible && <Tool name="lamp" label="Keep the screen on" pressed={wake.on} onClick={wake.change} />}
      <Tool
        name="theme"
        label="Dark colours"
        pressed={theme === "dark"}
        onClick={() => studio.view.set({ theme: theme === "dark" ? "light" : "dark" })}
      />
    </div>
  );
}

function Tool({ name, label, pressed, onClick }: { name: string; label: string; pressed: boolean; onClick: () => void }) {
  return (
    <button className="icon" aria-label={label} title={label} aria-pressed={pressed} onClick={onClick}>
      <Icon name={name} />
    </button>
  );
}

/** Keeps the screen on, where browsers can do so. They end it when the page is hidden. */
function useWakeLock() {
  const possible = "wakeLock" in navigator;
  const [wanted, setWanted] = useState(true);
  const [on, setOn] = useState(false);
  useEffect(() => {
    if (!possible || !wanted) return;
    let over = false;
    let lock: WakeLockSentinel | undefined;
    const ask = async () => {
      if (document.visibilityState !== "visible") return;
      try {
        const got = await navigator.wakeLock.request("screen");
        if (over) return void got.release();
        lock = got;
        setOn(true);
        got.addEventListener("release", () => setOn(false));
      } catch {
        // Not allowed now, as with a low battery.
      }
    };
    void ask();
    const again = () => void ask();
    document.addEventListener("visibilitychange", again);
    return () => {
      over = true;
      document.removeEventListener("visibilitychange", again);
      void lock?.release();
      setOn(false);
    };
  }, [possible, wanted]);
  // A lock that was refused is asked for again.
  const change = () => {
    setWanted(false);
    if (!on) setTimeout(() => setWanted(true));
  };
  return { possible, on, change };
}
