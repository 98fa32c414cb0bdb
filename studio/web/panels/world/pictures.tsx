import { useEffect, useRef } from "react";
import type { WorldView } from "../../model/protocol";
import type { Track } from "../../live/run/track";
import { numbersOf, pixelsOf } from "../../model/net/views";
import { cut } from "../fleet/draw_fleet";

/** Milliseconds between two pictures of one camera. */
const pause = 200;
/** The number of pictures shown at a time. */
export const mostPictures = 6;

/** The pictures of the cameras, beside the world. */
export function Pictures({ track, views }: { track: Track; views: readonly WorldView[] }) {
  if (views.length === 0) return null;
  return (
    <div className="pictures" role="group" aria-label="Pictures">
      {views.slice(0, mostPictures).map((view) => (
        <Picture key={view.path} track={track} view={view} />
      ))}
      {views.length > mostPictures && <p className="faint">and {views.length - mostPictures} more</p>}
    </div>
  );
}

function Picture({ track, view }: { track: Track; view: WorldView }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const note = useRef<HTMLSpanElement>(null);
  useEffect(() => {
    let shown: unknown;
    const look = () => {
      const bytes = track.arrays.at(view.path, track.now);
      if (bytes === shown && shown !== undefined) return;
      shown = bytes;
      const numbers = bytes ? numbersOf(view.type, bytes) : null;
      const pixels = numbers && pixelsOf(view, numbers);
      const why = bytes === undefined ? "no picture yet" : bytes === null ? "not recorded" : pixels ? "" : "no picture";
      if (note.current) note.current.textContent = why;
      const context = canvas.current?.getContext("2d");
      if (!context) return;
      if (pixels) context.putImageData(new ImageData(pixels, view.width!, view.height!), 0, 0);
      else context.clearRect(0, 0, view.width!, view.height!);
    };
    look();
    const timer = setInterval(look, pause);
    return () => clearInterval(timer);
  }, [track, view]);
  const tip = "Pictures are recorded if the run records all values";
  return (
    <figure title={`${view.path} (${view.kind}, ${view.width} x ${view.height})`}>
      <canvas ref={canvas} width={view.width} height={view.height} role="img" aria-label={`${view.kind} ${view.path}`} />
      <figcaption>
        {cut(view.path, 26)} <span ref={note} className="faint" title={tip} />
      </figcaption>
    </figure>
  );
}
