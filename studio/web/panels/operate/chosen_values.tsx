import { Fragment, useEffect, useState } from "react";
import { useStructure } from "../../hooks/use_structure";
import { useStore, useStudio } from "../../hooks/use";
import { shown } from "../../model/run/series";
import { unitOf } from "../../model/text/units";
import { useTrack } from "./seen_world";

/** So many values are listed at once. */
const most = 60;
const keptFor = (folder: string) => `tessera.operate.values.${folder}`;

function kept(storage: Pick<Storage, "getItem">, folder: string): readonly string[] {
  try {
    const read: unknown = JSON.parse(storage.getItem(keptFor(folder)) ?? "[]");
    return Array.isArray(read) ? read.filter((one) => typeof one === "string") : [];
  } catch {
    return [];
  }
}

/** A path that is broken between its names, if it must be broken. */
const breakable = (path: string) =>
  path.split(".").map((name, at) => (
    <Fragment key={at}>
      {at > 0 && (
        <>
          .<wbr />
        </>
      )}
      {name}
    </Fragment>
  ));

/** The values that the operator has chosen, in large letters. The choice is kept for the project. */
export function ChosenValues() {
  const studio = useStudio();
  const folder = useStore(studio.project, (all) => all.project?.folder ?? "");
  const track = useTrack();
  const structure = useStructure();
  const [chosen, setChosen] = useState<readonly string[]>([]);
  const [wanted, setWanted] = useState("");
  const [, look] = useState(0);
  useEffect(() => setChosen(kept(studio.arrangement, folder)), [studio, folder]);
  useEffect(() => {
    const timer = setInterval(() => look((at) => at + 1), 150);
    return () => clearInterval(timer);
  }, []);
  if (!track) return null;
  const choose = (path: string) => {
    const next = chosen.includes(path) ? chosen.filter((one) => one !== path) : [...chosen, path];
    setChosen(next);
    try {
      studio.arrangement.setItem(keptFor(folder), JSON.stringify(next));
    } catch {
      // Without storage the choice counts until the page is closed.
    }
  };
  const listed = track.series.paths.filter((path) => path.toLowerCase().includes(wanted.trim().toLowerCase()));
  return (
    <section className="chosen-values" aria-label="Values">
      <dl>
        {chosen
          .filter((path) => track.series.paths.includes(path))
          .map((path) => {
            const unit = unitOf(structure, path);
            return (
              <div key={path}>
                <dt className="path">{breakable(path)}</dt>
                <dd>
                  {shown(track.series.at(path, track.now))} {unit}
                </dd>
              </div>
            );
          })}
      </dl>
      <details>
        <summary>Choose values</summary>
        <input
          type="text"
          aria-label="Values whose path contains"
          placeholder="part of a path"
          value={wanted}
          onChange={(event) => setWanted(event.target.value)}
        />
        {listed.slice(0, most).map((path) => (
          <label key={path} className="operator-switch">
            <input type="checkbox" checked={chosen.includes(path)} onChange={() => choose(path)} />
            <span className="path">{path}</span>
          </label>
        ))}
        {listed.length > most && <p className="faint">{listed.length - most} more: type a part of their path.</p>}
        {listed.length === 0 && <p className="faint">No value has come yet that fits.</p>}
      </details>
    </section>
  );
}
