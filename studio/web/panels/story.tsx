import { useStudio } from "../hooks/use";
import { sentence } from "../model/net/labels";
import type { Act } from "../model/protocol";

/** A run in words: in the order of the acts, which subsystem does what. */
export function Story({ acts, label }: { acts: readonly Act[]; label: string }) {
  const studio = useStudio();
  if (acts.length === 0) return <p className="faint">It is so from the start.</p>;
  return (
    <ol className="acts" tabIndex={0} aria-label={label}>
      {acts.map(({ first, who, text }) => (
        <li key={first}>
          {who.includes(".") ? (
            <button className="link" onClick={() => studio.select(who)}>
              {sentence(who)}
            </button>
          ) : (
            who
          )}{" "}
          {sentence(who === "" ? text : ` ${text}`)}
        </li>
      ))}
    </ol>
  );
}
