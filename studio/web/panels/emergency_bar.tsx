import { useEffect, useLayoutEffect, useRef, useState, type RefObject } from "react";
import { createPortal } from "react-dom";
import { useStore, useStudio } from "../hooks/use";
import { stoppedOf, type Stopped } from "../live/emergency";

const most = 6;
const terminal = "Use the emergency stop of the robots, or type `tessera emergency-stop` in a terminal.";

/** The dialog that is open, if any: nothing outside of it can be clicked. */
function useOpenDialog(): Element | null {
  const [dialog, setDialog] = useState<Element | null>(null);
  useEffect(() => {
    const look = () => setDialog(document.querySelector("dialog:modal"));
    const observer = new MutationObserver(look);
    observer.observe(document.body, { subtree: true, childList: true, attributes: true, attributeFilter: ["open"] });
    look();
    return () => observer.disconnect();
  }, []);
  return dialog;
}

/** Whether anything drives devices, or a command was given that somebody did not obey: that stays to be read. */
export function useDriving(): boolean {
  const studio = useStudio();
  const { controllers, told } = useStore(studio.emergency.store, (all) => all);
  const ownRun = useStore(studio.runner.store, ({ kind, state }) => kind === "run" && state === "running");
  return controllers.length > 0 || ownRun || !(told?.done ?? true);
}

/** The place of an element in the window, as long as it is needed. */
function usePlace(of: RefObject<HTMLElement | null>, on: boolean): { top: number; left: number } {
  const [place, setPlace] = useState({ top: 0, left: 0 });
  useLayoutEffect(() => {
    if (!on) return;
    const look = () => {
      const { top = 0, left = 0 } = of.current?.getBoundingClientRect() ?? {};
      setPlace({ top: Math.max(0, top), left: Math.max(0, left) });
    };
    look();
    addEventListener("resize", look);
    addEventListener("scroll", look, true);
    return () => {
      removeEventListener("resize", look);
      removeEventListener("scroll", look, true);
    };
  }, [of, on]);
  return place;
}

/** In the line of the run while anything drives devices, or always, and at the same place over an open dialog. */
export function EmergencyBar({ always = false }: { always?: boolean }) {
  const driving = useDriving() || always;
  const dialog = useOpenDialog();
  const here = useRef<HTMLDivElement>(null);
  const place = usePlace(here, driving && dialog !== null);
  if (!driving) return null;
  return (
    <>
      <div ref={here} className="emergency">
        <Bar />
      </div>
      {dialog &&
        createPortal(
          <div className="emergency over" style={place}>
            <Bar />
          </div>,
          dialog,
        )}
    </>
  );
}

function Bar() {
  const studio = useStudio();
  const { asked } = useStore(studio.emergency.store, (all) => all);
  return (
    <section className="emergency-part" aria-label="Emergency stop">
      <button
        className="emergency-stop"
        title="The safe command for all devices of all running controllers, until you reset it"
        onClick={() => void studio.emergency.stop()}
      >
        {asked === "stop" ? "STOPPING…" : "EMERGENCY STOP"}
      </button>
      <div className="emergency-text">
        <Told />
        <Driven />
      </div>
    </section>
  );
}

/** The answers to the last command: who obeyed, and who did not. */
function Told() {
  const studio = useStudio();
  const told = useStore(studio.emergency.store, (all) => all.told);
  if (!told) return null;
  const title =
    told.what === "reset" ? (told.done ? "Reset" : "NOT RESET") : told.done ? "All have stopped" : "NOT ALL HAVE STOPPED";
  return (
    <div role="alert">
      <strong>{title}</strong>{" "}
      <button className="link" onClick={() => studio.emergency.putAway()}>
        Put away
      </button>
      <ul>
        {told.lines.map((line, at) => (
          <li key={at} className={/^tessera: error|could not tell/.test(line) ? "not" : ""}>
            {line.replace(/^tessera: (error: )?/, "")}
          </li>
        ))}
      </ul>
      {!told.done && told.what === "stop" && <p>{terminal}</p>}
    </div>
  );
}

/** The controllers that drive devices, and those that stand in an emergency stop. */
function Driven() {
  const studio = useStudio();
  const controllers = useStore(studio.emergency.store, (all) => all.controllers);
  const connected = useStore(studio.connection.store, ({ state }) => state === "open" || state === "connecting");
  if (!connected) return <p className="not">This page does not reach its server. {terminal}</p>;
  const moving = controllers.filter(({ emergency }) => emergency === null);
  const stopped = stoppedOf(controllers);
  return (
    <>
      {moving.length > 0 && (
        <p>
          {stopped.length > 0 ? "Not stopped: " : "Drives devices: "}
          {moving
            .slice(0, most)
            .map(({ name, answers }) => `${name}${answers ? "" : " (does not answer)"}`)
            .join(", ")}
          {moving.length > most && ` and ${moving.length - most} more`}
        </p>
      )}
      {stopped.map((one) => (
        <StoppedNow key={one.title} {...one} />
      ))}
    </>
  );
}

function StoppedNow({ title, name, why }: Stopped) {
  const studio = useStudio();
  const [sure, setSure] = useState(false);
  const reset = () => {
    setSure(false);
    void studio.emergency.reset(name);
  };
  return (
    <p>
      <strong>{title} is stopped</strong> ({why}){" "}
      {sure ? (
        <>
          Its devices will move again.{" "}
          <button className="danger" onClick={reset}>
            Reset {title}
          </button>{" "}
          <button onClick={() => setSure(false)}>Leave it stopped</button>
        </>
      ) : (
        <button onClick={() => setSure(true)}>Reset…</button>
      )}
    </p>
  );
}
