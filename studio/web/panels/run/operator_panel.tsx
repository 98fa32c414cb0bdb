import { useEffect, useId, useRef, useState, type KeyboardEvent, type PointerEvent } from "react";
import { useStore, useStudio } from "../../hooks/use";
import type { PanelControl, PanelShown } from "../../model/protocol";
import { deflected, deflectionOf, neutralOf, pushOf, stepOfSlider, type Inputs } from "../../model/run/panel_inputs";

/** The limit for fleets, which have too many panels to operate. */
const few = 6;

/** The panels of the running controller: an operator moves their controls. */
export function OperatorPanels() {
  const studio = useStudio();
  const { panels, kind } = useStore(studio.runner.store, (all) => all);
  const [filter, setFilter] = useState("");
  if (kind === "deployment" || panels.length === 0) return null;
  const found = panels.filter(({ path }) => path.includes(filter));
  return (
    <details open>
      <summary>
        <h3>Teleoperation</h3>
      </summary>
      {panels.length > few && (
        <div className="field">
          <label htmlFor="panel-filter">Show</label>
          <input
            id="panel-filter"
            placeholder="part of a path"
            value={filter}
            onChange={(event) => setFilter(event.target.value)}
          />
        </div>
      )}
      {found.slice(0, few).map((panel) => (
        <OperatorPanel key={panel.path} panel={panel} />
      ))}
      {found.length > few && <p className="faint">{found.length - few} more: type a part of their path.</p>}
    </details>
  );
}

function OperatorPanel({ panel }: { panel: PanelShown }) {
  const { operator } = useStudio();
  const { inputs: all, problems } = useStore(operator.store, (state) => state);
  const inputs = all.get(panel.path);
  const problem = problems.get(panel.path);
  const operated = inputs !== undefined;
  // A panel that is not visible is not operated.
  useEffect(() => () => operator.letGo(panel.path), [operator, panel.path]);
  const move = (change: Inputs) => operator.move(panel.path, change);
  const held = inputs ?? Object.fromEntries(panel.controls.map((one) => [one.field, neutralOf(one)]));
  const x = panel.controls.find(({ control }) => control === "stick_x");
  const y = panel.controls.find(({ control }) => control === "stick_y");
  return (
    <section className="operator-panel" aria-label={`Panel ${panel.path}`} data-panel={panel.path}>
      <div className="operator-head">
        <span className="path">{panel.path}</span>
        <button aria-pressed={operated} onClick={() => (operated ? operator.letGo(panel.path) : operator.take(panel))}>
          {operated ? "Stop operating" : "Operate"}
        </button>
      </div>
      <p className="faint" role="status">
        {operated ? "This page operates it. It is neutral when the page is hidden or closed." : "This page does not operate it."}
      </p>
      {problem && (
        <p className="problem-hint" role="alert">
          {problem}
        </p>
      )}
      {(x || y) && <Stick x={x} y={y} inputs={held} disabled={!operated} onMove={move} />}
      {panel.controls.map((control) => {
        const shared = { key: control.field, control, value: held[control.field]!, disabled: !operated, onMove: move };
        const { key, ...rest } = shared;
        if (control.control === "button") return <HeldButton key={key} {...rest} />;
        if (control.control === "switch") return <Switch key={key} {...rest} />;
        return control.control === "slider" ? <Slider key={key} {...rest} /> : null;
      })}
    </section>
  );
}

interface ControlProps {
  control: PanelControl;
  value: number | boolean;
  disabled: boolean;
  onMove: (change: Inputs) => void;
}

const withUnit = (value: number | boolean, { unit }: PanelControl) => `${value}${unit && ` ${unit}`}`;

/** True while the pointer or the key holds it. */
function HeldButton({ control, value, disabled, onMove }: ControlProps) {
  const hold = (held: boolean) => held !== value && onMove({ [control.field]: held });
  const isHold = ({ key }: KeyboardEvent) => key === " " || key === "Enter";
  return (
    <button
      className="held-button"
      disabled={disabled}
      aria-pressed={value === true}
      onPointerDown={(event) => {
        event.currentTarget.setPointerCapture(event.pointerId);
        hold(true);
      }}
      onPointerUp={() => hold(false)}
      onPointerCancel={() => hold(false)}
      onKeyDown={(event) => isHold(event) && hold(true)}
      onKeyUp={(event) => isHold(event) && hold(false)}
      onBlur={() => hold(false)}
    >
      {control.field}
    </button>
  );
}

function Switch({ control, value, disabled, onMove }: ControlProps) {
  const id = useId();
  return (
    <div className="field operator-switch">
      <input
        id={id}
        type="checkbox"
        disabled={disabled}
        checked={value === true}
        onChange={(event) => onMove({ [control.field]: event.target.checked })}
      />
      <label htmlFor={id}>{control.field}</label>
    </div>
  );
}

function Slider({ control, value, disabled, onMove }: ControlProps) {
  const id = useId();
  return (
    <div className="field">
      <label htmlFor={id}>
        {control.field} <strong>{withUnit(value, control)}</strong>
      </label>
      <input
        id={id}
        type="range"
        min={control.minimum!}
        max={control.maximum!}
        step={stepOfSlider(control)}
        disabled={disabled}
        value={Number(value)}
        aria-valuetext={withUnit(value, control)}
        onChange={(event) => onMove({ [control.field]: Number(event.target.value) })}
      />
    </div>
  );
}

interface StickProps {
  x: PanelControl | undefined;
  y: PanelControl | undefined;
  inputs: Inputs;
  disabled: boolean;
  onMove: (change: Inputs) => void;
}

/** A square with a knob, moved by the pointer or the arrow keys; without both it springs back. */
function Stick({ x, y, inputs, disabled, onMove }: StickProps) {
  const keys = useRef(new Set<string>());
  const [dragged, setDragged] = useState(false);
  const axes = [x, y].filter((axis) => axis !== undefined);
  const push = (right: number, up: number) =>
    onMove({
      ...(x && { [x.field]: deflected(x, right) }),
      ...(y && { [y.field]: deflected(y, up) }),
    });
  const rest = () => {
    keys.current.clear();
    setDragged(false);
    if (!disabled) push(0, 0);
  };
  const key = (event: KeyboardEvent, down: boolean) => {
    if (!(event.key.startsWith("Arrow") || event.key === "Shift")) return;
    if (event.key !== "Shift") keys.current[down && !disabled ? "add" : "delete"](event.key);
    if (disabled) return;
    event.preventDefault();
    if (event.repeat) return;
    push(...pushOf(keys.current, event.shiftKey));
  };
  const drag = (event: PointerEvent<HTMLDivElement>) => {
    const box = event.currentTarget.getBoundingClientRect();
    const half = box.width / 2;
    push((event.clientX - box.left - half) / half, -(event.clientY - box.top - half) / half);
  };
  const at = (axis: PanelControl | undefined) => (axis ? deflectionOf(axis, Number(inputs[axis.field])) : 0);
  const said = axes.map((axis) => `${axis.field} ${withUnit(inputs[axis.field]!, axis)}`).join(", ");
  const name = axes.map((axis) => `${axis.field} ${axis === x ? "to the right" : "up"}`).join(", ");
  return (
    <div className="operator-stick">
      <div
        className="stick"
        role="application"
        aria-roledescription="joystick"
        aria-label={`Stick: ${name}. Arrow keys move it.`}
        aria-disabled={disabled}
        tabIndex={0}
        onKeyDown={(event) => key(event, true)}
        onKeyUp={(event) => key(event, false)}
        onBlur={rest}
        onPointerDown={(event) => {
          if (disabled) return;
          event.currentTarget.setPointerCapture(event.pointerId);
          setDragged(true);
          drag(event);
        }}
        onPointerMove={(event) => dragged && drag(event)}
        onPointerUp={rest}
        onPointerCancel={rest}
      >
        <span className="knob" style={{ left: `${50 + 40 * at(x)}%`, top: `${50 - 40 * at(y)}%` }} />
      </div>
      <output>{said}</output>
    </div>
  );
}
