import { useEffect, useState } from "react";
import { useStore, useStudio, useUnsaved } from "../../hooks/use";
import { againFrom } from "../../live/again";

/** Repeats the run with the present code, and continues from the shown time. */
export function Again() {
  const studio = useStudio();
  const { request, state } = useStore(studio.runner.store, (all) => all);
  const dirty = useUnsaved();
  const current = useStore(studio.draft.store, (draft) => draft.current);
  const [typed, setTyped] = useState("");
  const [now, setNow] = useState(0);
  const { track } = studio.runner;
  useEffect(() => {
    const look = () => setNow(track ? track.now / 1e9 : 0);
    look();
    const timer = setInterval(look, 250);
    return () => clearInterval(timer);
  }, [track, state]);
  if (request?.kind !== "simulate" || state === "building" || state === "idle") return null;
  const at = typed === "" ? now : Number(typed);
  const wrong = !(at >= 0 && at < 1e9);
  const again = async () => {
    if (!(await studio.saveAll())) return;
    const paused = studio.runner.store.get().state === "paused";
    await studio.runner.stop();
    await studio.run(againFrom(request, at, paused));
    setTyped("");
  };
  return (
    <div className="again">
      <button
        disabled={!current || wrong}
        title="Builds the code as it is now, repeats the same run from its beginning as fast as possible, and continues at this second"
        onClick={() => void again()}
      >
        {dirty ? "Save and restart at" : "Restart at"}
      </button>
      <input
        type="text"
        inputMode="decimal"
        aria-label="Restart at, in seconds"
        aria-invalid={wrong}
        value={typed}
        placeholder={now.toFixed(2)}
        onChange={(event) => setTyped(event.target.value)}
      />
      <span>s</span>
    </div>
  );
}
