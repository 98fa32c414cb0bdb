import { useId } from "react";
import { useStudio } from "../../hooks/use";
import type { TimedSubsystem } from "../../model/protocol";
import { longestBeside, type Tried } from "../../model/tried_times";
import { shownTime } from "../../model/timing";

/** The longest time of the calls of a subsystem. Dragging it tries another one; the specification stays as it is. */
export function TakesSlider({ timed, path, tried }: { timed: TimedSubsystem; path: string; tried: Tried }) {
  const studio = useStudio();
  const id = useId();
  const present = timed.longest_ns;
  if (present === null || timed.missing) return null;
  const now = tried.longest_ns ?? present;
  const choices = longestBeside(present);
  return (
    <div className="rate">
      <label htmlFor={id}>Its calls take at most</label>
      <output htmlFor={id}>
        {now === present ? (
          shownTime(present)
        ) : (
          <>
            <span className="old">{shownTime(present)}</span> <strong>{shownTime(now)}</strong>
          </>
        )}
      </output>
      <input
        id={id}
        type="range"
        aria-label={`${path}: its calls take at most`}
        min={0}
        max={choices.length - 1}
        step={1}
        value={Math.max(0, choices.indexOf(now))}
        aria-valuetext={shownTime(now)}
        onChange={(event) => {
          const longest = choices[Number(event.target.value)]!;
          studio.timing.try(path, { longest_ns: longest === present ? undefined : longest });
        }}
      />
    </div>
  );
}
