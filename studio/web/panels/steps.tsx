import { useEffect } from "react";
import { useStore, useStudio } from "../hooks/use";
import { isUnsaved } from "../live/draft";
import { startRequest } from "../live/run/start_request";
import type { Studio } from "../live/studio";
import { structureOf } from "../model/structure/structure";
import { stepsOf, type Act, type Situation, type Step } from "../model/steps";
import { timesOf } from "../model/timing";
import { tracksOf } from "./run/start_form";

/** The way from a specification to a run: edit, verify, run. Each step has its state, its button and what stands in its way. */
export function Steps() {
  const studio = useStudio();
  useFunctions();
  const steps = stepsOf(useSituation());
  return (
    <ol className="steps" aria-label="Steps">
      {steps.map((one) => (
        <li key={one.step} className={`step ${one.tone}`} data-step={one.step}>
          <span className="step-title">{one.title}</span>
          <button
            className={`quiet step-state${leadsOn.includes(one.leads) ? " leads-on" : ""}`}
            data-testid={`step-${one.step}`}
            onClick={() => void act(studio, one.leads)}
          >
            <span className={`dot ${dots[one.tone]}`} />
            <span className="step-text">{one.state}</span>
          </button>
          <button
            className="primary"
            aria-label={one.primary.name}
            title={one.step === "edit" ? "Save (Ctrl S)" : one.primary.name}
            disabled={!one.primary.enabled}
            onClick={() => void act(studio, one.primary.act)}
          >
            {one.primary.label}
          </button>
        </li>
      ))}
    </ol>
  );
}

/** These acts change or go to what stands in the way. */
const leadsOn: readonly Act[] = ["write_functions", "show_error"];
const dots: Record<Step["tone"], string> = { good: "good", warning: "warning", error: "error", busy: "busy", open: "" };

function useSituation(): Situation {
  const studio = useStudio();
  const draft = useStore(studio.draft.store, (all) => all);
  const verifier = useStore(studio.verifier.store, (all) => all);
  const { verified, judging, unjudged } = useStore(studio.timing.store, (all) => all);
  const missing = useStore(studio.sources.store, (all) => all.functions.filter(({ state }) => state === "missing").length);
  const run = useStore(studio.runner.store, (all) => all.state);
  const followed = useStore(studio.runner.store, (all) => all.kind);
  const wished = useStore(studio.runner.wishes, (all) => all.kind);
  const runProblem = useStore(studio.runner.store, (all) => all.problem);
  const of = (severity: "error" | "warning") => draft.diagnostics.filter((one) => one.severity === severity).length;
  return {
    blank: draft.loaded && draft.text.trim() === "",
    errors: of("error"),
    warnings: of("warning"),
    checking: draft.checking || !draft.loaded,
    unsaved: isUnsaved(draft),
    verifying: verifier.state === "running",
    verdicts: verifier.verdicts,
    times: timesOf(verified),
    timing: judging ? "computing" : unjudged ? "failed" : "known",
    verdictsCurrent: verifier.text === draft.text,
    verifyProblem: verifier.text === draft.text ? verifier.problem : "",
    missing,
    run,
    runKind: run === "idle" || run === "ended" || run === "failed" ? wished : followed,
    runProblem,
  };
}

/** Keeps the list of functions as it is in the files: another program may have changed them while the page had no focus. */
function useFunctions(): void {
  const studio = useStudio();
  const text = useStore(studio.draft.store, (draft) => (draft.current ? draft.text : null));
  useEffect(() => {
    if (text === null) return;
    const look = () => void studio.sources.look();
    const timer = setTimeout(look, 250);
    window.addEventListener("focus", look);
    return () => {
      clearTimeout(timer);
      window.removeEventListener("focus", look);
    };
  }, [studio, text]);
}

/** Writes the missing functions, and shows the first of them: somebody has to fill it. */
async function writeFunctions({ draft, sources, view, dock }: Studio): Promise<void> {
  const missing = sources.store.get().functions.filter(({ state }) => state === "missing");
  for (const one of missing) await sources.add(one);
  const { problem, functions } = sources.store.get();
  const written = missing.filter((one) =>
    functions.some((now) => now.subsystem === one.subsystem && now.function === one.function && now.state !== "missing"),
  );
  if (problem !== "" || written.length === 0) return;
  const [first] = written;
  const { agents } = structureOf(draft.store.get().text);
  const behaviour = agents
    .flatMap(({ subsystems }) => subsystems)
    .find(({ path }) => path === first!.subsystem)
    ?.behaviours.find((one) => one.function === first!.function);
  if (behaviour) view.set({ selected: behaviour.path });
  dock.open("code");
  draft.store.set({
    notice:
      written.length === 1
        ? "The function does nothing yet: fill it in C++"
        : `${written.length} functions do nothing yet: fill them in C++`,
  });
}

async function act(studio: Studio, what: Act): Promise<void> {
  const { view, draft, verifier, runner } = studio;
  switch (what) {
    case "save":
      await draft.save();
      return;
    case "verify":
      view.set({ panel: "verify" });
      await verifier.start();
      return;
    case "stop_verify":
      verifier.stop();
      return;
    case "run":
      view.set({ panel: "run" });
      if (!(await studio.saveAll())) return;
      await studio.run(startRequest(runner.wishes.get(), tracksOf(studio.project.get().project), false));
      return;
    case "stop_run":
      await runner.control({ command: "stop" });
      return;
    case "write_functions":
      await writeFunctions(studio);
      return;
    case "show_form":
      view.set({ panel: "inspect" });
      return;
    case "show_error":
    case "show_problems": {
      const severity = what === "show_error" ? "error" : "warning";
      const first = draft.store.get().diagnostics.find((one) => one.severity === severity);
      view.set({ text: true });
      if (first) studio.showLine(first.line);
      return;
    }
    case "show_verdicts":
      view.set({ panel: "verify" });
      return;
    case "show_run":
      view.set({ panel: "run" });
  }
}
