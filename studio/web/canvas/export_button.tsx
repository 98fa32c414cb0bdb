import { useState } from "react";
import { useStore, useStudio } from "../hooks/use";
import { message } from "../live/api";
import type { Studio } from "../live/studio";
import { drawnIn, filmOf, mostFirings, type Scenes } from "../model/run/film";
import { initialMarking } from "../model/net/game";
import type { NetModel } from "../model/net/net";
import { filmPage } from "./film_page";
import { withVectors } from "./painted/vectors";
import { asPng, download, takeFirstPicture, takePicture } from "./picture";

/** Buttons that save the visible part as a file. film: also a film of what is played on it. */
export function ExportButtons({ name, film }: { name: string; film?: boolean }) {
  const studio = useStudio();
  const [busy, setBusy] = useState(false);
  const save = async (make: (areas: Element[]) => Blob | Promise<Blob>, ending: string) => {
    const areas = [...document.querySelectorAll(".canvas-area")];
    if (areas.length === 0) return;
    setBusy(true);
    try {
      download(await withVectors(areas, () => make(areas)), `${name || "system"}.${ending}`);
    } catch (error) {
      studio.draft.store.set({ notice: message(error) });
    }
    setBusy(false);
  };
  const svg = (areas: Element[]) => new Blob([takePicture(areas).text], { type: "image/svg+xml" });
  const png = (areas: Element[]) => asPng(takePicture(areas));
  return (
    <>
      {film && <FilmButton busy={busy} onTake={(make) => void save(make, "html")} />}
      <button className="quiet" disabled={busy} title="The visible part, as SVG" onClick={() => void save(svg, "svg")}>
        SVG
      </button>
      <button className="quiet" disabled={busy} title="The visible part, as PNG" onClick={() => void save(png, "png")}>
        PNG
      </button>
    </>
  );
}

function FilmButton({ busy, onTake }: { busy: boolean; onTake: (make: (areas: Element[]) => Blob) => void }) {
  const studio = useStudio();
  const played = useStore(studio.play.store, ({ what, length }) => what !== "nothing" && length > 0);
  const panes = useStore(studio.scene.store, (all) => all.panes);
  const net = useStore(studio.draft.store, (draft) => draft.net);
  const at = panes.findIndex(({ replay }) => replay !== null);
  if (!net || (!played && at < 0)) return null;
  const take = (areas: Element[]) => {
    const of = played ? playedOn(studio) : { net, scenes: panes[at]!.replay!.scenes(mostFirings) };
    return filmBlob(areas[played ? 0 : at]!, of.net, of.scenes);
  };
  return (
    <button
      className="quiet"
      disabled={busy}
      title={`What is played on this drawing from the moment shown on, as a web page that plays by itself (up to ${mostFirings.toLocaleString("en")} firings)`}
      onClick={() => onTake(take)}
    >
      Film
    </button>
  );
}

function playedOn({ play }: Studio): { net: NetModel; scenes: Scenes } {
  const net = play.net!;
  const { title } = play.store.get();
  return { net, scenes: { title, from: initialMarking(net), firings: play.steps.slice(0, mostFirings), times: null, begin: 0 } };
}

function filmBlob(area: Element, net: NetModel, scenes: Scenes): Blob {
  const picture = takeFirstPicture(area);
  const colours = getComputedStyle(area);
  const film = filmOf(scenes, net, drawnIn(picture.text));
  const page = filmPage(film, picture.text, colours.getPropertyValue("--accent"), colours.getPropertyValue("--runs"));
  return new Blob([page], { type: "text/html" });
}
