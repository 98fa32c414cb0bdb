import { useEffect, useMemo, useRef } from "react";
import { useStore, useStudio } from "../../hooks/use";
import { breakable } from "../../model/net/labels";
import type { NetModel } from "../../model/net/net";

/** The token game, and the steps of a run that shows a violation. */
export function PlayPanel() {
  const studio = useStudio();
  const net = useStore(studio.draft.store, (draft) => draft.net);
  const play = useStore(studio.play.store, (all) => all);
  if (!net) return <p className="faint">There is no net to play on yet.</p>;
  if (play.what === "nothing")
    return (
      <>
        <div className="buttons" style={{ marginTop: 0 }}>
          <button className="primary" onClick={() => (studio.view.set({ view: "net" }), studio.play.game(net))}>
            Play the token game
          </button>
        </div>
        <p className="faint">
          Fire what can fire by clicking it in the drawing, choose which conditions hold, or press Play. Nothing is compiled.
        </p>
      </>
    );
  const shown = studio.play.net ?? net;
  return (
    <>
      <h2>{play.what === "game" ? "Token game" : `How ${play.title.replaceAll("_", " ")} breaks`}</h2>
      {play.waits.length > 0 && play.position === play.length && (
        <div className="waits">
          <h3>Who waits for whom</h3>
          {play.waits.map((wait) => (
            <p key={wait}>{breakable(wait)}</p>
          ))}
        </div>
      )}
      {play.what === "game" && <Choices net={shown} />}
      <Channels net={shown} />
      {play.length > 0 && <h3>{play.what === "game" ? "Fired so far" : "The run"}</h3>}
      <Steps net={shown} />
    </>
  );
}

/** The number of elements that a list shows. */
const most = 500;

function Choices({ net }: { net: NetModel }) {
  const studio = useStudio();
  const { active, conditions } = useStore(studio.play.store, (all) => all);
  const free = useMemo(() => net.elements.free(most), [net]);
  return (
    <>
      <h3>Can fire now</h3>
      <ul className="choice-list">
        {active.slice(0, most).map((index) => (
          <li key={index}>
            <button
              className="choice"
              onClick={() => studio.play.choose(index)}
              onFocus={() => studio.select(net.transitions.at(index)!.name, false)}
            >
              {net.transitions.at(index)!.name}
              {net.transitions.at(index)!.condition?.text && (
                <span className="faint"> [{net.transitions.at(index)!.condition!.text}]</span>
              )}
            </button>
          </li>
        ))}
        {active.length > most && <li className="faint">and {active.length - most} more: click them in the drawing</li>}
        {active.length === 0 && <li className="faint">Nothing: the net has stopped.</li>}
      </ul>
      {free.length > 0 && (
        <>
          <h3>Conditions</h3>
          <ul className="choice-list">
            {free.map((index) => (
              <li key={index}>
                <select
                  aria-label={`Condition of ${net.transitions.at(index)!.name}`}
                  value={conditions.has(index) ? String(conditions.get(index)) : ""}
                  onChange={(event) =>
                    studio.play.setCondition(index, event.target.value === "" ? undefined : event.target.value === "true")
                  }
                >
                  <option value="">either way</option>
                  <option value="true">holds</option>
                  <option value="false">does not hold</option>
                </select>
                <span className="path">
                  [{net.transitions.at(index)!.condition!.text}] {net.transitions.at(index)!.name}
                </span>
              </li>
            ))}
          </ul>
        </>
      )}
    </>
  );
}

/** The states of the channels: which of their places hold a token. */
function Channels({ net }: { net: NetModel }) {
  const studio = useStudio();
  useStore(studio.play.store, (all) => all.position);
  const { marking } = studio.desk;
  const first = net.elements.firstFused;
  if (first === net.places.length) return null;
  const held: string[] = [];
  (studio.play.marking ?? marking).subarray(first).forEach((tokens, at) => {
    if (tokens > 0 && held.length < most) held.push(net.places.at(first + at)!.name);
  });
  return (
    <>
      <h3>Channels</h3>
      <ul>
        {held.map((name) => {
          const cut = name.lastIndexOf(".");
          return (
            <li key={name} className="path">
              {breakable(name.slice(0, cut))} <strong>{name.slice(cut + 1)}</strong>
            </li>
          );
        })}
      </ul>
    </>
  );
}

function Steps({ net }: { net: NetModel }) {
  const studio = useStudio();
  const { position, length } = useStore(studio.play.store, (all) => all);
  const current = useRef<HTMLButtonElement>(null);
  useEffect(() => void current.current?.scrollIntoView({ block: "nearest" }), [position]);
  const { steps } = studio.play;
  // Only the end of a long game is shown.
  const first = Math.max(0, Math.min(position, length) - 300);
  return (
    <ol className="step-list">
      {steps.slice(first, first + 600).map((transition, at) => {
        const number = first + at + 1;
        const name = net.transitions.at(transition)?.name ?? "?";
        return (
          <li key={number}>
            <button
              ref={number === position ? current : undefined}
              aria-current={number === position ? "step" : undefined}
              className={number > position ? "future" : ""}
              onClick={() => (studio.play.seek(number), studio.select(name))}
            >
              <span className="number">{number}</span> {name}
            </button>
          </li>
        );
      })}
    </ol>
  );
}
