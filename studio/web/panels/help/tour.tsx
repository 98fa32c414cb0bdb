import { useEffect, useLayoutEffect, useRef, useState } from "react";
import { useStudio } from "../../hooks/use";
import { tourSteps, type TourStep } from "../../live/guide";
import type { Studio } from "../../live/studio";

interface Station {
  title: string;
  text: string;
  /** Parts of the page that the step is about; the first one that is visible counts. */
  parts: readonly string[];
  /** Shows the part. */
  prepare?: (studio: Studio) => void;
}

const stations: Record<TourStep, Station> = {
  structure: {
    title: "Structure",
    text: "Each large box is an agent, such as a robot. In it are its control and its sensors and motors. Lines are channels: they carry values from an output to an input. Click a box to see its settings.",
    parts: [".structure .canvas-area", ".centre"],
    prepare: (studio) => studio.view.set({ view: "structure" }),
  },
  edit: {
    title: "Edit",
    text: "Change the system in the drawing, in the settings or in the text: all three show the same file. This step says whether it has errors, and saves it. Undo takes back every change.",
    parts: ['[data-step="edit"]'],
    prepare: (studio) => studio.view.set({ panel: "inspect" }),
  },
  verify: {
    title: "Verify",
    text: "A click proves that the robots cannot block each other, and more. If they can, the page shows who waits for whom, plays how it comes to that, and offers repairs.",
    parts: ['[data-step="verify"]'],
    prepare: (studio) => studio.view.set({ panel: "verify" }),
  },
  run: {
    title: "Run",
    text: "A click builds the controller and starts it, in simulation at first. If a C++ function is missing, this step says so and writes its beginning.",
    parts: ['[data-step="run"]'],
    prepare: (studio) => studio.view.set({ panel: "run" }),
  },
  values: {
    title: "Values",
    text: "During a run the page shows what every behaviour does over time, curves of all values, and the simulated world. Each run leaves a recording, which you open here to see the same again.",
    parts: [".watches .watch", '[aria-label="Values"]', '[role="tab"][id="tab-recordings"]', '[data-step="run"]'],
    prepare: (studio) => studio.view.set({ panel: "recordings" }),
  },
};

const find = (parts: readonly string[]) =>
  parts.map((part) => document.querySelector(part)).find((part) => part?.checkVisibility()) ?? null;

interface Box {
  left: number;
  top: number;
  width: number;
  height: number;
}

/** The place of the card: below its part, above it, or else at the lower edge of a part that is as high as the window. */
function besideOf(part: Box, card: { width: number; height: number }): { left: number; top: number } {
  const gap = 10;
  const below = part.top + part.height + gap;
  const above = part.top - card.height - gap;
  const within = part.top + part.height - card.height - 2 * gap;
  const top = below + card.height < innerHeight ? below : above > 0 ? above : within;
  const left = part.left + Math.min(0, (part.width - card.width) / 2) + Math.max(0, (part.width - card.width) / 2);
  const kept = (value: number, size: number, all: number) => Math.max(gap, Math.min(value, all - size - gap));
  return { left: kept(left, card.width, innerWidth), top: kept(top, card.height, innerHeight) };
}

/** A step of the tour: a card beside the part of the page that it is about. The page works as always. */
export function Tour({ step }: { step: TourStep }) {
  const studio = useStudio();
  const station = stations[step];
  const card = useRef<HTMLElement>(null);
  const next = useRef<HTMLButtonElement>(null);
  const [part, setPart] = useState<Box | null>(null);
  const [place, setPlace] = useState<{ left: number; top: number } | null>(null);
  useEffect(() => station.prepare?.(studio), [studio, station]);
  useLayoutEffect(() => {
    const look = () => {
      const found = find(station.parts)?.getBoundingClientRect();
      const box = found ? { left: found.left, top: found.top, width: found.width, height: found.height } : null;
      setPart((before) => (JSON.stringify(before) === JSON.stringify(box) ? before : box));
      if (!card.current) return;
      const { offsetWidth: width, offsetHeight: height } = card.current;
      const at = besideOf(box ?? { left: innerWidth / 2, top: innerHeight / 2, width: 0, height: 0 }, { width, height });
      setPlace((before) => (before && before.left === at.left && before.top === at.top ? before : at));
    };
    look();
    // The part may appear, move or change its size while the step is shown.
    const timer = setInterval(look, 250);
    window.addEventListener("resize", look);
    return () => {
      clearInterval(timer);
      window.removeEventListener("resize", look);
    };
  }, [station]);
  useEffect(() => next.current?.focus(), []);
  const leave = () => studio.guide.go(null);
  const at = tourSteps.indexOf(step);
  const last = at === tourSteps.length - 1;
  return (
    <>
      {part && <div className="tour-part" style={part} aria-hidden="true" />}
      <section
        ref={card}
        className="tour-card"
        role="dialog"
        aria-labelledby="tour-title"
        aria-describedby="tour-text"
        style={place ?? { left: 0, top: 0, opacity: 0 }}
        onKeyDown={(event) => {
          if (event.key !== "Escape") return;
          event.stopPropagation();
          leave();
        }}
      >
        <h2 id="tour-title">
          {station.title} <span className="faint">{`${at + 1} of ${tourSteps.length}`}</span>
        </h2>
        <p id="tour-text">{station.text}</p>
        <div className="buttons">
          <button ref={next} className="primary" onClick={() => studio.guide.go(studio.guide.beside(1))}>
            {last ? "Finish" : "Next"}
          </button>
          {at > 0 && <button onClick={() => studio.guide.go(studio.guide.beside(-1))}>Back</button>}
          {!last && <button onClick={leave}>Leave the tour</button>}
        </div>
      </section>
    </>
  );
}
