import { roundedPath } from "../../model/net/geometry";
import { markOf } from "../../model/structure/machine";
import { chipHeight, chipText, type DrawnArrow, type Machine } from "../../model/structure/machine_layout";
import { nextSelection, withoutIndex, type Behaviour, type Subsystem } from "../../model/structure/structure";
import { fontSize, lineHeight } from "../../model/structure/text_size";
import { Flag, type Complaint } from "./flag";

interface Shown {
  subsystem: Subsystem;
  machine: Machine;
  selected: string | null;
  complaints: ReadonlyMap<string, Complaint>;
  /** The running behaviour, as a path in the subsystem: "charge.dock"; undefined: nothing runs. */
  now: string | undefined;
}

/** The behaviours of a subsystem as a state machine: the entries of `next` are arrows with their conditions. */
export function MachineView({ subsystem, machine, selected, complaints, now }: Shown) {
  const own = (path: string) => path.slice(subsystem.path.length + 1);
  const running = now && withoutIndex(now);
  const runs = (one: Behaviour) => running === own(one.path) || (one.isGroup && running?.startsWith(`${own(one.path)}.`));
  const groups = subsystem.behaviours.filter(({ isGroup }) => isGroup);
  return (
    <>
      {groups.map(({ path }) => {
        const box = machine.states.get(path);
        return box && <div key={path} className="group-frame" style={{ left: box.x, top: box.y, ...sizeOf(box) }} />;
      })}
      <svg className="machine-arrows" width={machine.width} height={machine.height}>
        {machine.arrows.map((arrow, at) => (
          <ArrowView key={at} arrow={arrow} selected={selected} />
        ))}
        {[...machine.states].map(([path, box]) => {
          const mark = markOf(path);
          if (!mark) return null;
          const [x, y, r] = [box.x + box.width / 2, box.y + box.height / 2, box.width / 2 - 1];
          return (
            <g key={path} className={`mark ${mark}`}>
              <title>{markTitle[mark]}</title>
              <circle cx={x} cy={y} r={r} />
              {mark === "end" && <circle className="inner" cx={x} cy={y} r={r - 3} />}
            </g>
          );
        })}
      </svg>
      {subsystem.behaviours.map((behaviour) => {
        const box = machine.states.get(behaviour.path);
        if (!box) return null;
        const name = own(behaviour.path);
        const what = behaviour.isGroup ? "group" : "behaviour";
        const place = behaviour.isGroup
          ? { left: box.x + 4, top: box.y + 4, height: chipHeight }
          : { left: box.x, top: box.y, ...sizeOf(box) };
        return (
          <button
            key={behaviour.path}
            style={place}
            className={`chip${behaviour.isGroup ? " group" : ""}${runs(behaviour) ? " running" : ""}`}
            data-path={behaviour.path}
            aria-pressed={selected === behaviour.path}
            title={behaviour.for ? `${name}, for ${behaviour.for}` : name}
            aria-label={`${what} ${name}${behaviour.for ? "[i]" : ""}${runs(behaviour) ? ", running" : ""}`}
          >
            {chipText(behaviour)}
            <Flag of={complaints.get(behaviour.path)} />
          </button>
        );
      })}
    </>
  );
}

const sizeOf = ({ width, height }: { width: number; height: number }) => ({ width, height });

const markTitle = {
  start: "It begins here.",
  end: "It ends here.",
  failures: "Failures that no entry of next names lead from here (on_error).",
};

function ArrowView({ arrow, selected }: { arrow: DrawnArrow; selected: string | null }) {
  const { points, place, lines, kind, from, to, entry } = arrow;
  const own = selected === from || selected === to;
  const chosen = entry !== null && selected === nextSelection(from, entry);
  const [, begin = from] = /([^.#]*)$/.exec(from) ?? [];
  const end = to.split(/[.#]/).at(-1);
  return (
    <g
      className={`arrow ${kind}${own ? " of-selected" : ""}${chosen ? " selected" : ""}`}
      data-from={from}
      data-to={to}
      data-entry={entry ?? undefined}
      tabIndex={-1}
    >
      <title>{kind === "begin" ? `It begins with ${end}.` : `${begin} → ${end}${arrow.label ? `: ${arrow.label}` : ""}`}</title>
      {entry !== null && <path className="arrow-reach" d={roundedPath(points, 5)} />}
      <path d={roundedPath(points, 5)} markerEnd={kind === "failure" ? "url(#failure-tip)" : "url(#machine-tip)"} />
      {place &&
        lines.map((line, at) => (
          <text key={at} x={place.x + 4} y={place.y + (at + 0.78) * fontSize.text * lineHeight}>
            {line}
          </text>
        ))}
    </g>
  );
}
