import { useState } from "react";
import { useStudio } from "../hooks/use";
import { message } from "../live/api";
import { withVectors } from "./net/painted/vectors";
import { asPng, download, takePicture } from "./picture";

/** Buttons that save the visible part as a file. */
export function ExportButtons({ name }: { name: string }) {
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
      <button className="quiet" disabled={busy} title="The visible part, as SVG" onClick={() => void save(svg, "svg")}>
        SVG
      </button>
      <button className="quiet" disabled={busy} title="The visible part, as PNG" onClick={() => void save(png, "png")}>
        PNG
      </button>
    </>
  );
}
