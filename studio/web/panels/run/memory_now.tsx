import { useEffect, useState } from "react";
import { useStore, useStudio } from "../../hooks/use";
import { useStructure } from "../../hooks/use_structure";
import type { Track } from "../../live/run/track";
import { memoryOf } from "../../model/run/memory";
import { shown } from "../../model/run/series";
import { findThing } from "../../model/structure/structure";
import { unitOf } from "../../model/text/units";
import { usePaneTitle } from "../pane_title";

/** The limit for large structures and fleets, which have too many values to read. */
const most = 24;

/** The memory of a subsystem at the shown time, of each run and recording in view. */
export function MemoryNow({ subsystem }: { subsystem: string }) {
  const studio = useStudio();
  const panes = useStore(studio.scene.store, (all) => all.panes);
  const title = usePaneTitle();
  const watched = panes.filter(({ track }) => track !== null);
  return watched.map((pane) => (
    <MemoryOfRun
      key={pane.id}
      track={pane.track!}
      subsystem={subsystem}
      title={watched.length > 1 ? `Memory now in ${title(pane)}` : "Memory now"}
    />
  ));
}

function MemoryOfRun({ track, subsystem, title }: { track: Track; subsystem: string; title: string }) {
  const [, look] = useState(0);
  const structure = useStructure();
  useEffect(() => {
    const timer = setInterval(() => look((at) => at + 1), 150);
    return () => clearInterval(timer);
  }, []);
  // A buffer may have that name.
  const fields = findThing(structure, `${subsystem}.memory`) ? [] : memoryOf(track.series.paths, subsystem);
  if (fields.length === 0) return null;
  return (
    <section aria-label={title} className="memory-now">
      <h3>{title}</h3>
      <dl>
        {fields.slice(0, most).map(({ path, label }) => [
          <dt key={path} title={path}>
            {label}
          </dt>,
          <dd key={`${path}=`}>
            {shown(track.series.at(path, track.now))} {unitOf(structure, path)}
          </dd>,
        ])}
      </dl>
      {fields.length > most && <p className="faint">and {fields.length - most} more: filter the values for "memory"</p>}
    </section>
  );
}
