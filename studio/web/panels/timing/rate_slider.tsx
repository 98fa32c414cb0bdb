import { useId } from "react";
import { useStudio } from "../../hooks/use";
import type { TimedSubsystem } from "../../model/protocol";
import { periodsBeside, shownRate } from "../../model/timing";

/** The rate of a subsystem. Dragging it tries another one; the specification stays as it is. */
export function RateSlider({ timed, path, tried }: { timed: TimedSubsystem; path: string; tried: number | undefined }) {
  const studio = useStudio();
  const id = useId();
  const present = timed.period_ns;
  const now = tried ?? present;
  const choices = periodsBeside(present);
  const attempt = (period: number) => studio.timing.try(path, { period_ns: period === present ? undefined : period });
  const at = now === 0 ? choices.findIndex((one) => one <= 1e9 / 50) : choices.indexOf(now);
  return (
    <div className="rate">
      <label htmlFor={id}>{path}</label>
      <output htmlFor={id}>
        {now === present ? (
          shownRate(present)
        ) : (
          <>
            <span className="old">{shownRate(present)}</span> <strong>{shownRate(now)}</strong>
          </>
        )}
      </output>
      <input
        id={id}
        type="range"
        min={0}
        max={choices.length - 1}
        step={1}
        value={at}
        disabled={now === 0}
        aria-valuetext={shownRate(now)}
        onChange={(event) => attempt(choices[Number(event.target.value)]!)}
      />
      {timed.waits && (
        <label className="switch">
          <input
            type="checkbox"
            checked={now === 0}
            onChange={(event) => attempt(event.target.checked ? 0 : present === 0 ? 1e9 / 50 : present)}
          />
          No rate: it begins when a value comes
        </label>
      )}
    </div>
  );
}
