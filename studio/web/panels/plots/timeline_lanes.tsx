import { useRef, useState } from "react";
import type { MarkedRun } from "../../live/measured";
import type { Track } from "../../live/run/track";
import { Painted } from "../world/painted";
import { drawTimeline, heightOfAll, laneAt, timeAt } from "./draw_timeline";

/** The lanes of a timeline. Those that the panel has no room for are scrolled to; the axis of time stays below them. */
export function TimelineLanes({
  track,
  seconds,
  marked,
  onSeek,
}: {
  track: Track;
  seconds: number;
  /** A run of a chain in this recording that is marked. */
  marked: MarkedRun | null;
  onSeek: ((time: number) => void) | undefined;
}) {
  const frame = useRef<HTMLDivElement>(null);
  const scrolled = () => frame.current?.scrollTop ?? 0;
  const [pointed, setPointed] = useState("");
  return (
    <div
      ref={frame}
      className="lanes"
      role="group"
      aria-label="Subsystems over time"
      tabIndex={0}
      title={pointed}
      onPointerMove={({ clientY, currentTarget }) => {
        const { top, height } = currentTarget.getBoundingClientRect();
        setPointed(laneAt(track, clientY - top, height, scrolled())?.path ?? "");
      }}
    >
      <div className="lanes-all" style={{ height: heightOfAll(track) }}>
        <div className="lanes-seen">
          <Painted
            label="Behaviours and firings of each subsystem over time"
            draw={(context, size, colours) =>
              drawTimeline(context, size, colours, { track, seconds, scrolled: scrolled(), marked })
            }
            of={() =>
              `${track.id} ${track.now} ${track.firings} ${seconds} ${scrolled()} ${marked?.run.from_ns} ${marked?.run.to_ns}`
            }
            onPick={onSeek && ((x, width) => onSeek(timeAt(track, seconds, x, width)))}
          />
        </div>
      </div>
    </div>
  );
}
