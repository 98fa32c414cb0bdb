import { useEffect, useRef, useState } from "react";
import { useStore, useStudio } from "../../hooks/use";
import { useStructure } from "../../hooks/use_structure";
import { message } from "../../live/api";
import type { Replay } from "../../live/run/replay";
import type { Studio } from "../../live/studio";
import { drawnIn, filmName, filmOf, mostFirings, type FilmedPlots } from "../../model/run/film";
import { initialMarking } from "../../model/net/game";
import type { Structure } from "../../model/structure/structure";
import { download, takeFirstPicture } from "../../canvas/picture";
import { withVectors } from "../../canvas/net/painted/vectors";
import { plotLines } from "../plots/plot_lines";
import { plotSides, svgOf } from "../plots/plot_svg";
import { filmPage, type FilmColours } from "./film_page";
import { filmedWorld } from "./film_world";

/** Saves what is played on a drawing as a film: a web page that plays by itself. */
export function FilmButton() {
  const studio = useStudio();
  const played = useStore(studio.play.store, ({ what, length }) => what !== "nothing" && length > 0);
  const panes = useStore(studio.scene.store, (all) => all.panes);
  const net = useStore(studio.draft.store, (draft) => draft.net);
  const [open, setOpen] = useState(false);
  const at = panes.findIndex(({ replay }) => replay !== null);
  if (!net || (!played && at < 0)) return null;
  return (
    <>
      <button
        className="quiet"
        title="Save what is played on this drawing as a web page that plays by itself"
        onClick={() => setOpen(true)}
      >
        Film
      </button>
      {open && <FilmDialog replay={played ? null : panes[at]!.replay!} pane={played ? 0 : at} close={() => setOpen(false)} />}
    </>
  );
}

const seconds = (time: number) => String(Number((time / 1e9).toFixed(3)));

/** replay: the recording; null: a run of the token game, or one that shows a violation. */
function FilmDialog({ replay, pane, close }: { replay: Replay | null; pane: number; close: () => void }) {
  const studio = useStudio();
  const structure = useStructure();
  const ref = useRef<HTMLDialogElement>(null);
  const shown = replay ? replay.track.now : 0;
  const loaded = replay?.loaded ?? { from: 0, to: 0 };
  // At its end a run has nothing left to show.
  const [from, setFrom] = useState(seconds(shown >= loaded.to ? loaded.from : shown));
  const [to, setTo] = useState(seconds(loaded.to));
  const [busy, setBusy] = useState("");
  const [problem, setProblem] = useState("");
  useEffect(() => void ref.current?.showModal(), []);
  // A time that is written as shown is that moment, not the rounded one.
  const exact = (text: string, moments: readonly number[]) => moments.find((one) => seconds(one) === text) ?? Number(text) * 1e9;
  const [begin, end] = [exact(from, [loaded.from, shown]), exact(to, [loaded.to, shown])];
  const within = (time: number) => Number.isFinite(time) && time >= loaded.from - 5e5 && time <= loaded.to + 5e5;
  const wrong =
    replay && (from.trim() === "" || to.trim() === "" || !within(begin) || !within(end) || begin >= end)
      ? `From and to are times between ${seconds(loaded.from)} s and ${seconds(loaded.to)} s.`
      : "";
  const scenes = wrong ? null : replay ? replay.scenes(begin, end, mostFirings) : playedOn(studio);
  const firings = scenes?.firings.length ?? 0;
  const cut = firings === mostFirings;
  const last = cut && scenes?.times ? scenes.times.at(-1)! : end;
  const save = async () => {
    if (!scenes) return;
    const areas = [...document.querySelectorAll(".net-pane .canvas-area")];
    const area = areas[pane];
    if (!area) return setProblem("The drawing of the net is not shown.");
    const net = replay ? replay.track.net : studio.play.net!;
    setProblem("");
    setBusy("The drawing…");
    try {
      const world =
        replay &&
        (await filmedWorld(studio.api, replay.track, begin, last, (part) => setBusy(`The world: ${Math.round(100 * part)} %`)));
      setBusy("The drawing…");
      const picture = await withVectors([area], () => takeFirstPicture(area));
      const plots = replay ? filmedPlots(studio, structure, begin, last) : null;
      const system = studio.project.get().project?.name;
      // The name that the user has given to the recording.
      const given = replay && studio.recordings.store.get().list.find(({ name }) => name === replay.name)?.notes?.title;
      const run = system ? `${system}, ${given || scenes.title}` : given || scenes.title;
      const title = replay ? `${run}, ${seconds(begin)} s to ${seconds(last)} s` : run;
      const film = filmOf({ ...scenes, title }, net, drawnIn(picture.text), {
        ...(replay ? { length: (last - begin) / 1e9 } : {}),
        world,
        plots,
      });
      const page = new Blob([filmPage(film, picture.text, coloursOf(area))], { type: "text/html" });
      download(page, `${replay ? filmName(run, begin, last) : filmName(run)}.html`);
      ref.current?.close();
    } catch (error) {
      setProblem(message(error));
    }
    setBusy("");
  };
  return (
    <dialog ref={ref} className="dialog film" aria-labelledby="film-title" onClose={close}>
      <h2 id="film-title">Save a film</h2>
      <p>
        A web page that plays by itself, without the studio and without a network: the drawing as it is shown now
        {replay ? ", the world, the plotted values" : ""} and each firing in words.
      </p>
      {replay && (
        <div className="film-times">
          <label>
            From [s] <input value={from} inputMode="decimal" onChange={(event) => setFrom(event.target.value)} />
          </label>
          <label>
            To [s] <input value={to} inputMode="decimal" onChange={(event) => setTo(event.target.value)} />
          </label>
        </div>
      )}
      <p className={wrong || problem ? "problem" : "hint"} role="status">
        {problem ||
          wrong ||
          (cut
            ? `A film holds ${mostFirings.toLocaleString("en")} firings: this one ends at ${seconds(last)} s.`
            : `${firings.toLocaleString("en")} firings. A film holds up to ${mostFirings.toLocaleString("en")}.`)}
      </p>
      <div className="buttons">
        <button className="primary" disabled={busy !== "" || wrong !== ""} onClick={() => void save()}>
          {busy || "Save film"}
        </button>
        <button onClick={() => ref.current?.close()}>Cancel</button>
      </div>
    </dialog>
  );
}

function playedOn({ play }: Studio) {
  const { title } = play.store.get();
  return { title, from: initialMarking(play.net!), firings: play.steps.slice(0, mostFirings), times: null, begin: 0 };
}

/** The plot that the user has made, without cursors. */
function filmedPlots(studio: Studio, structure: Structure, from: number, to: number): FilmedPlots | null {
  const lines = plotLines(studio.plots.shown, studio.plotted.sources(), structure, false).filter(({ hidden }) => !hidden);
  if (lines.length === 0) return null;
  return { svg: svgOf(lines, from, to), ...plotSides };
}

function coloursOf(area: Element): FilmColours {
  const style = getComputedStyle(area);
  const of = (name: string) => style.getPropertyValue(name).trim();
  return {
    accent: of("--accent"),
    runs: of("--runs"),
    background: of("--bg"),
    surface: of("--surface"),
    text: of("--text"),
    soft: of("--soft"),
    line: of("--line"),
    isDark: document.documentElement.dataset.theme === "dark",
  };
}
