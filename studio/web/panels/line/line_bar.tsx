import { Boundary } from "../boundary";
import { useStore, useStudio } from "../../hooks/use";
import { goesOn } from "../../live/run/runner_state";
import { EmergencyBar, useDriving } from "../emergency_bar";
import { RecordingPlayer, StepPlayer } from "../run/player";
import { LastOfPlay, LastOfRecording } from "./last_firing";
import { RunLine } from "./run_line";
import { StateChip } from "./state_chip";
import type { LineState } from "./line_state";

/**
 * The debugger's line: one bar for whatever is run, watched, replayed or played, always at the same place. The
 * emergency stop is its first part while anything drives devices.
 */
export function LineBar() {
  const driving = useDriving();
  const shown = useShown();
  if (!driving && shown === null) return null;
  return (
    <section className="line-bar" aria-label="The run">
      {/* It is there even if the rest fails. */}
      <EmergencyBar />
      {shown !== null && (
        <Boundary>
          <Shown what={shown} />
        </Boundary>
      )}
    </section>
  );
}

/** A game uses the whole drawing; otherwise the first pane counts. A run without a pane has its controls, too. */
function useShown(): "play" | "recording" | "run" | null {
  const studio = useStudio();
  const played = useStore(studio.play.store, ({ what }) => what !== "nothing");
  const recorded = useStore(studio.scene.store, ({ panes }) => Boolean(panes[0]?.replay));
  const run = useStore(studio.runner.store, ({ state }) => state !== "idle");
  return played ? "play" : recorded ? "recording" : run ? "run" : null;
}

function Shown({ what }: { what: "play" | "recording" | "run" }) {
  const studio = useStudio();
  const replay = useStore(studio.scene.store, ({ panes }) => panes[0]?.replay ?? null);
  const beside = useStore(studio.scene.store, ({ panes }) => panes.length > 1);
  const active = useStore(studio.runner.store, ({ state }) => goesOn(state));
  if (what === "run") return <RunLine />;
  return (
    <>
      {what === "play" ? <PlayLine /> : replay && <RecordingLine key={replay.id} replay={replay} beside={beside} />}
      {/* It goes on behind what is shown. */}
      {active && <RunLine />}
    </>
  );
}

function PlayLine() {
  const { play } = useStudio();
  const { what, running, position, length, active } = useStore(play.store, (all) => all);
  const atEnd = position === length && active.length === 0;
  const state: LineState = atEnd
    ? { tone: "stuck", word: "Stuck", why: "nothing can fire" }
    : running
      ? { tone: "running", word: "Playing", why: "" }
      : { tone: "paused", word: what === "game" ? "Token game" : "Paused", why: "" };
  return (
    <div className="line-part">
      <StateChip {...state} />
      <StepPlayer />
      <LastOfPlay />
    </div>
  );
}

function RecordingLine({ replay, beside }: { replay: Parameters<typeof RecordingPlayer>[0]["replay"]; beside: boolean }) {
  const { playing, time } = useStore(replay.store, (all) => all);
  const state: LineState = playing
    ? { tone: "running", word: "Playing", why: "" }
    : time >= replay.last
      ? { tone: "ended", word: "At its end", why: "" }
      : { tone: "paused", word: "Recording", why: "" };
  return (
    <div className="line-part">
      <StateChip {...state} />
      <RecordingPlayer replay={replay} beside={beside} fixed={false} />
      <LastOfRecording replay={replay} />
    </div>
  );
}
