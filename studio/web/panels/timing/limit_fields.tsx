import { useStudio } from "../../hooks/use";
import type { TimedChain, Timing } from "../../model/protocol";
import type { Structure } from "../../model/structure/structure";
import { shownTime } from "../../model/timing";
import { givenName, limitEdits } from "../../model/timing_edits";
import { structureOf } from "../../model/structure/structure";
import { Field } from "../forms/field";

interface LimitProps {
  structure: Structure;
  found: Timing;
  chain: TimedChain;
}

const limits = [
  {
    limit: "reaction",
    label: "Reaction at most",
    placeholder: "100 ms",
    hint: "The longest reaction that this robot may have. Verify judges it.",
  },
  { limit: "age", label: "Age at most", placeholder: "80 ms", hint: "The oldest reading that a command may be based on." },
] as const;

/** The limits that the specification asks for. */
export function LimitFields({ structure, found, chain }: LimitProps) {
  const studio = useStudio();
  const write = (limit: "age" | "reaction") => async (text: string) => {
    const edits = limitEdits(structureOf(studio.draft.text), found, chain, limit, text.trim());
    if (edits.length === 0) return true;
    const written = await studio.change(edits);
    if (written && !chain.named) studio.timing.choose(givenName(chain));
    return written;
  };
  const asked = (ns: number | null) => (ns === null ? "" : shownTime(ns));
  return (
    <div className="limits">
      {limits.map(({ limit, label, placeholder, hint }) => (
        <Field
          key={limit}
          label={label}
          value={asked(chain[limit].asked_ns)}
          placeholder={placeholder}
          hint={hint}
          onChange={write(limit)}
        />
      ))}
      {chain.agents > 1 && <p className="faint">A limit counts for each of the {chain.agents} agents.</p>}
      {!chain.named && structure.yaml.pair(["timing", "chains"]) === undefined && found.chains.length > 1 && (
        <p className="faint">The first limit writes the {found.chains.length} chains into the specification, under `timing`.</p>
      )}
    </div>
  );
}
