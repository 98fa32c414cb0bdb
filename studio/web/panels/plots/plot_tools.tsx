import { useStore, useStudio } from "../../hooks/use";
import type { Source } from "../../live/plots/plotted";
import type { Alignment } from "../../live/plots/plots";
import type { Drawing } from "./plot_charts";
import type { PlotLine } from "./plot_lines";
import type { Span } from "./plot_panel";
import { svgOf } from "./plot_svg";
import { csvOfLines, save } from "./save_plot";

interface PlotToolsProps {
  /** The visible ones. */
  lines: readonly PlotLine[];
  sources: readonly Source[];
  drawing: Drawing;
  span: Span | null;
  onSpan: (span: Span | null) => void;
  onCursors: (cursors: readonly (number | null)[]) => void;
  picture: () => HTMLCanvasElement | undefined;
}

/** The row above a plot: which one, of what span, with which recordings, the two cursors, and its files. */
export function PlotTools({ lines, sources, drawing, span, onSpan, onCursors, picture }: PlotToolsProps) {
  const studio = useStudio();
  const { plots, active } = useStore(studio.plots.store, (all) => all);
  const kept = plots[active]!;
  const list = useStore(studio.recordings.store, (all) => all.list);
  const named = (name: string) => list.find((one) => one.name === name)?.notes?.title || name;
  const rest = list.filter(({ name }) => !sources.some((one) => one.name === name) && !kept.recordings.includes(name));
  const { cursors, from, to } = drawing;
  const fileName = kept.title.replace(/[^\w-]+/g, "_");
  const ofSpan = span === null ? "" : span === "all" ? "all" : "last" in span ? String(span.last) : "own";
  const cursor = (which: 0 | 1, text: string) => {
    const time = text === "" ? null : Number(text) * 1e9;
    if (time === null || Number.isFinite(time)) onCursors(cursors.map((one, at) => (at === which ? time : one)));
  };
  return (
    <div className="plot-tools">
      <select
        aria-label="Shown plot"
        value={active}
        onChange={({ target }) => (target.value === "new" ? studio.plots.open() : studio.plots.show(Number(target.value)))}
      >
        {plots.map(({ title }, at) => (
          <option key={title} value={at}>
            {title}
          </option>
        ))}
        <option value="new">New plot</option>
      </select>
      <select
        aria-label="Visible time"
        value={ofSpan}
        onChange={({ target: { value } }) =>
          onSpan(value === "" ? null : value === "all" ? "all" : value === "own" ? { from, to } : { last: Number(value) })
        }
      >
        <option value="">usual time</option>
        <option value="all">whole run</option>
        {[1, 3, 10, 60, 600].map((seconds) => (
          <option key={seconds} value={seconds}>
            last {seconds < 60 ? `${seconds} s` : `${seconds / 60} min`}
          </option>
        ))}
        {ofSpan === "own" && <option value="own">own time</option>}
      </select>
      {span !== null && (
        <button className="quiet" title="Shows the usual span again (Home)" onClick={() => onSpan(null)}>
          Reset zoom
        </button>
      )}
      {(["A", "B"] as const).map((name, which) => (
        <label
          key={name}
          className="plot-cursor"
          title={`Cursor ${name}: ${which === 0 ? "click" : "Shift and click"} in the plot`}
        >
          {name}
          <input
            type="number"
            step="any"
            aria-label={`Cursor ${name} in seconds`}
            placeholder={which === 0 ? "click" : "⇧ click"}
            value={cursors[which] == null ? "" : Number((cursors[which] / 1e9).toFixed(6))}
            onChange={({ target }) => cursor(which as 0 | 1, target.value)}
          />
        </label>
      ))}
      {cursors[0] != null && cursors[1] != null && (
        <span className="faint" data-testid="cursor-difference">
          {Number(((cursors[1] - cursors[0]) / 1e9).toFixed(6))} s
        </span>
      )}
      {cursors[0] != null && sources[0]?.replay && (
        <button
          className="quiet"
          title="The recording shows the time of cursor A"
          onClick={() => sources[0]!.replay!.seek(cursors[0]! - sources[0]!.shift)}
        >
          Go to A
        </button>
      )}
      <select
        aria-label="Add a recording to the plot"
        value=""
        onFocus={() => void studio.recordings.refresh()}
        onChange={({ target }) => target.value && studio.plots.change({ recordings: [...kept.recordings, target.value] })}
      >
        <option value="">+ recording</option>
        {rest.map(({ name }) => (
          <option key={name} value={name}>
            {named(name)}
          </option>
        ))}
      </select>
      {kept.recordings.map((name) => (
        <span key={name} className="plot-recording">
          {named(name)}
          <button
            className="quiet"
            aria-label={`Remove the recording ${name} from the plot`}
            onClick={() => studio.plots.change({ recordings: kept.recordings.filter((one) => one !== name) })}
          >
            ×
          </button>
        </span>
      ))}
      {sources.length > 1 && <AlignmentChoice sources={sources} alignment={kept.alignment} />}
      <span className="spring" />
      <button
        className="quiet"
        title="The visible values as a table"
        onClick={() => save(`${fileName}.csv`, new Blob([csvOfLines(lines, from, to)], { type: "text/csv" }))}
      >
        CSV
      </button>
      <button
        className="quiet"
        title="The plot as a picture"
        onClick={() => picture()?.toBlob((blob) => blob && save(`${fileName}.png`, blob))}
      >
        PNG
      </button>
      <button
        className="quiet"
        title="The plot as a drawing for documents"
        onClick={() => save(`${fileName}.svg`, new Blob([svgOf(lines, from, to)], { type: "image/svg+xml" }))}
      >
        SVG
      </button>
      <button className="quiet" title="Removes this plot" aria-label={`Close ${kept.title}`} onClick={() => studio.plots.close()}>
        ×
      </button>
    </div>
  );
}

/** The event that several runs have at the same place. */
function AlignmentChoice({ sources, alignment }: { sources: readonly Source[]; alignment: Alignment }) {
  const studio = useStudio();
  const lanes = sources[0]!.track.timeline.lanes.slice(0, 60);
  const value = JSON.stringify(alignment);
  return (
    <select
      aria-label="The runs lie above each other at"
      value={value}
      onChange={({ target }) => studio.plots.change({ alignment: JSON.parse(target.value) as Alignment })}
    >
      <option value={JSON.stringify({ by: "clock" })}>same clock</option>
      <option value={JSON.stringify({ by: "begin" })}>from their begin</option>
      {lanes.map(({ path, behaviours }) => (
        <optgroup key={path} label={path}>
          {behaviours.map((behaviour) => (
            <option key={behaviour} value={JSON.stringify({ by: "behaviour", path, behaviour })}>
              first {behaviour} of {path}
            </option>
          ))}
        </optgroup>
      ))}
    </select>
  );
}
