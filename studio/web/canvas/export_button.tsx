import { useState } from "react";
import { useStudio } from "../hooks/use";
import { message } from "../live/draft";
import { asPng, download, takePicture } from "./picture";

/** Buttons that save the visible part as a file. */
export function ExportButtons({ name }: { name: string }) {
  const studio = useStudio();
  const [busy, setBusy] = useState(false);
  const take = async (format: "svg" | "png") => {
    const areas = [...document.querySelectorAll(".canvas-area")];
    if (areas.length === 0) return;
    setBusy(true);
    try {
      const picture = takePicture(areas);
      download(
        format === "svg" ? new Blob([picture.text], { type: "image/svg+xml" }) : await asPng(picture),
        `${name || "system"}.${format}`,
      );
    } catch (error) {
      studio.draft.store.set({ notice: message(error) });
    }
    setBusy(false);
  };
  return (
    <>
      <button className="quiet" disabled={busy} title="What is seen, as SVG" onClick={() => void take("svg")}>
        SVG
      </button>
      <button className="quiet" disabled={busy} title="What is seen, as PNG" onClick={() => void take("png")}>
        PNG
      </button>
    </>
  );
}
