import { useStore, useStudio } from "../hooks/use";
import { sentence } from "../model/net/labels";
import { Story } from "./story";

/** The runs that violate properties, in words, in a panel of their own. */
export function Narratives() {
  const studio = useStudio();
  const verdicts = useStore(studio.verifier.store, (all) => all.verdicts);
  const told = verdicts.filter(({ narrative, verdict }) => narrative && verdict === "violated");
  return (
    <div className="panel">
      {told.map(({ name, narrative }) => (
        <section key={name} className="story" aria-label={name.replaceAll("_", " ")}>
          <h3>{sentence(name.replaceAll("_", " "))}</h3>
          <Story acts={narrative!} label={`The run that violates ${name.replaceAll("_", " ")}`} />
        </section>
      ))}
    </div>
  );
}
