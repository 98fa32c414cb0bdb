import type { TimedStep, Timing } from "../../model/protocol";
import { saidStep, sharesOf, shownTime } from "../../model/timing";

type Steps = NonNullable<Timing["steps"]>;

/** The parts of the two times of a chain: a bar each, and all parts in words. */
export function Budget({ steps, other }: { steps: Steps; other: Steps | null }) {
  return (
    <>
      <Bar title="Reaction" steps={steps.reaction} other={other?.reaction} />
      <Bar title="Age" steps={steps.age} other={other?.age} />
    </>
  );
}

const total = (steps: readonly TimedStep[]) => steps.reduce((sum, { ns }) => sum + ns, 0);

/** A bar of the present parts, and below it one of those with other rates, in the same scale. */
function Bar({ title, steps, other }: { title: string; steps: readonly TimedStep[]; other: readonly TimedStep[] | undefined }) {
  const most = Math.max(total(steps), total(other ?? []));
  const shown = other ?? steps;
  const isAge = title === "Age";
  return (
    <details className="budget" open={!isAge}>
      <summary>
        {title}
        {other && total(other) !== total(steps) ? (
          <>
            : <span className="old">{shownTime(total(steps))}</span> <strong>{shownTime(total(other))}</strong>
          </>
        ) : (
          `: ${shownTime(total(steps))}`
        )}
      </summary>
      <Parts steps={steps} most={most} label={`The parts of the ${title.toLowerCase()} now`} />
      {other && <Parts steps={other} most={most} label={`The parts of the ${title.toLowerCase()} with the new rates`} />}
      <ol>
        {shown.map((step, at) => (
          <li key={at}>
            <span className={`swatch ${shadeOf(step)}`} />
            <span>{saidStep(step, isAge)}</span>
            <span className="ns">{shownTime(step.ns)}</span>
          </li>
        ))}
      </ol>
    </details>
  );
}

const shadeOf = ({ kind }: TimedStep) =>
  kind === "takes" || kind === "foreign"
    ? "part-works"
    : kind === "until_read" || kind === "network"
      ? "part-stands"
      : kind === "processor" || kind === "latency"
        ? "part-late"
        : "part-waits";

/** One bar: each subsystem has its share, and within it the parts. */
function Parts({ steps, most, label }: { steps: readonly TimedStep[]; most: number; label: string }) {
  const shares = sharesOf(steps);
  const words = shares.map(({ subsystem, ns }) => `${subsystem} ${shownTime(ns)}`).join(", ");
  return (
    <div className="shares" role="img" aria-label={`${label}: ${words}`} style={{ width: `${(100 * total(steps)) / most}%` }}>
      {shares.map(({ subsystem, ns, parts }, at) => (
        <div key={at} className="share" style={{ flexGrow: ns }} title={`${subsystem}: ${shownTime(ns)}`}>
          <div className="parts">
            {parts.map((step, part) => (
              <i key={part} className={shadeOf(step)} style={{ flexGrow: step.ns }} title={shownTime(step.ns)} />
            ))}
          </div>
          <span>{subsystem.slice(subsystem.indexOf(".") + 1)}</span>
        </div>
      ))}
    </div>
  );
}
