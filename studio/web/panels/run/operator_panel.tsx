import { useEffect, useState } from "react";
import { useStore, useStudio } from "../../hooks/use";
import type { PanelShown } from "../../model/protocol";
import { neutralOf, type Inputs, type StickKeys } from "../../model/run/panel_inputs";
import { HeldButton, Slider, Switch, type ControlProps } from "../operate/controls";
import { GamepadSettings } from "../operate/gamepad_settings";
import { Stick } from "../operate/stick";

/** The limit for fleets, which have too many panels to operate. */
const few = 6;

/** The panels of the running controller that are shown, and the field that chooses them among many. */
export function useShownPanels() {
  const studio = useStudio();
  const { panels, kind, state } = useStore(studio.runner.store, (all) => all);
  const [filter, setFilter] = useState("");
  const going = state === "running" || state === "paused";
  const all = kind === "deployment" || !going ? [] : panels;
  const found = all.filter(({ path }) => path.includes(filter));
  const chooser = all.length > few && (
    <div className="field">
      <label htmlFor="panel-filter">Show</label>
      <input id="panel-filter" placeholder="part of a path" value={filter} onChange={(event) => setFilter(event.target.value)} />
      {found.length > few && <p className="faint">{found.length - few} more: type a part of their path.</p>}
    </div>
  );
  return { panels: found.slice(0, few), chooser };
}

/** The panels of the running controller: an operator moves their controls. */
export function OperatorPanels() {
  const studio = useStudio();
  const { panels, chooser } = useShownPanels();
  const some = panels.length > 0;
  useEffect(() => (some ? studio.operator.lookAtOthers() : undefined), [studio, some]);
  if (panels.length === 0 && !chooser) return null;
  return (
    <details open>
      <summary>
        <h3>Teleoperation</h3>
      </summary>
      <p>
        <button className="link" onClick={() => studio.openOperatingPage()}>
          Open the page for operators
        </button>
      </p>
      {chooser}
      {panels.map((panel) => (
        <OperatorPanel key={panel.path} panel={panel} />
      ))}
    </details>
  );
}

interface OperatorPanelProps {
  panel: PanelShown;
  /** Keys of the whole page that move its stick. */
  pageKeys?: StickKeys | null;
}

export function OperatorPanel({ panel, pageKeys = null }: OperatorPanelProps) {
  const { operator } = useStudio();
  const { inputs: all, padInputs, problems, others, rests, springing } = useStore(operator.store, (state) => state);
  const inputs = all.get(panel.path);
  const problem = problems.get(panel.path);
  const operated = inputs !== undefined;
  // A panel that is not visible is not operated.
  useEffect(() => () => operator.letGo(panel.path), [operator, panel.path]);
  const move = (change: Inputs) => operator.move(panel.path, change);
  const neutral = Object.fromEntries(panel.controls.map((one) => [one.field, neutralOf(one)]));
  const held: Inputs = { ...neutral, ...inputs, ...padInputs.get(panel.path) };
  const stick = { x: panel.controls.find(isOf("stick_x")), y: panel.controls.find(isOf("stick_y")) };
  const number = operated ? [...all.keys()].indexOf(panel.path) : all.size;
  return (
    <section className="operator-panel" aria-label={`Panel ${panel.path}`} data-panel={panel.path} data-operated={operated}>
      <div className="operator-head">
        <span className="path">{panel.path}</span>
        <button
          className={operated ? "" : "primary"}
          aria-pressed={operated}
          onClick={() => (operated ? operator.letGo(panel.path) : operator.take(panel))}
        >
          {operated ? "Stop operating" : "Operate"}
        </button>
      </div>
      <p className={others.has(panel.path) ? "faint by-other" : "faint"} role="status">
        {operated ? "You operate it. It is neutral when this page is hidden or closed." : notOperated(others.get(panel.path))}
      </p>
      {problem && (
        <p className="problem-hint" role="alert">
          {problem}
        </p>
      )}
      <div className="operator-controls">
        {(stick.x || stick.y) && (
          <Stick {...stick} inputs={held} disabled={!operated} rests={rests} pageKeys={pageKeys} onMove={move} />
        )}
        <div className="operator-others">
          {panel.controls.map((control) => {
            const Shown = shownAs[control.control];
            if (!Shown) return null;
            const value = held[control.field]!;
            const props = { control, value, disabled: !operated, rests, springs: springing.has(panel.path), onMove: move };
            return <Shown key={control.field} {...props} />;
          })}
        </div>
      </div>
      {panel.controls.some(isOf("slider")) && (
        <label className="operator-switch">
          <input
            type="checkbox"
            checked={springing.has(panel.path)}
            onChange={(event) => operator.letSpring(panel.path, event.target.checked)}
          />
          Sliders spring back when they are released
        </label>
      )}
      <GamepadSettings panel={panel} number={number} />
    </section>
  );
}

const isOf =
  (kind: string) =>
  ({ control }: { control: string }) =>
    control === kind;

const shownAs: Partial<Record<string, (props: ControlProps) => React.ReactNode>> = {
  button: HeldButton,
  switch: Switch,
  slider: Slider,
};

const notOperated = (other: string | undefined) =>
  other === undefined
    ? "This page does not operate it."
    : `Another page operates it (${other.slice(0, 4)}). You can take it when that page releases it.`;
