import { useEffect, useId } from "react";
import { useStore, useStudio } from "../../hooks/use";
import type { PanelShown } from "../../model/protocol";
import { axisName, buttonName, isEnabled, takesAxis, usualSetup, type Pad, type PadSetup } from "../../model/run/gamepad";

const none = "none";

/** The axes and buttons of the gamepad that move the controls of a panel. */
export function GamepadSettings({ panel, number }: { panel: PanelShown; number: number }) {
  const { gamepads } = useStudio().operator;
  const { pad } = useStore(gamepads.store, (all) => all);
  useEffect(() => {
    const timer = setInterval(() => gamepads.show(), 100);
    return () => clearInterval(timer);
  }, [gamepads]);
  if (pad === null)
    return (
      <details className="operator-pad">
        <summary>Gamepad</summary>
        <p className="faint">No gamepad: connect one and press a button on it. The browser shows it to this page only then.</p>
      </details>
    );
  const setup = gamepads.setup(panel, number);
  const change = (part: Partial<PadSetup>) => gamepads.change(panel, { ...setup, ...part });
  const isUsual = JSON.stringify(setup) === JSON.stringify(usualSetup(panel.controls, number));
  return (
    <details className="operator-pad">
      <summary>
        Gamepad{setup.enable !== null && `: ${isEnabled(setup, pad) ? "enabled" : `hold ${buttonName(setup.enable, pad)}`}`}
      </summary>
      <p className="faint">
        {pad.id || "Gamepad"} {pad.mapping === "standard" ? "(usual buttons)" : "(axes and buttons by number)"}. It counts while
        this window has the focus.
      </p>
      {panel.controls.map((control) => {
        const { field } = control;
        if (!takesAxis(control))
          return (
            <ButtonChoice
              key={field}
              label={field}
              pad={pad}
              value={setup.buttons[field] ?? null}
              onChange={(button) => change({ buttons: { ...setup.buttons, [field]: button } })}
            />
          );
        const part = setup.axes[field] ?? null;
        const give = (axis: typeof part) => change({ axes: { ...setup.axes, [field]: axis } });
        return (
          <div key={field} className="pad-axis">
            <PadChoice
              label={field}
              value={part?.axis ?? null}
              choices={pad.axes.map((value, axis) => `${axisName(axis, pad)}: ${value.toFixed(2)}`)}
              onChange={(axis) =>
                give(axis === null ? null : { axis, inverted: part?.inverted ?? control.control === "stick_y" })
              }
            />
            {part && (
              <label className="operator-switch">
                <input
                  type="checkbox"
                  checked={part.inverted}
                  onChange={(event) => give({ axis: part.axis, inverted: event.target.checked })}
                />
                reversed
              </label>
            )}
          </div>
        );
      })}
      <ButtonChoice
        label="Must be held to move anything"
        pad={pad}
        value={setup.enable}
        onChange={(enable) => change({ enable })}
      />
      <DeadZone value={setup.deadZone} onChange={(deadZone) => change({ deadZone })} />
      <button disabled={isUsual} onClick={() => gamepads.change(panel, null)}>
        As usual
      </button>
    </details>
  );
}

function DeadZone({ value, onChange }: { value: number; onChange: (value: number) => void }) {
  const id = useId();
  return (
    <div className="operator-slider">
      <label htmlFor={id}>
        Dead zone <strong>{Math.round(value * 100)} %</strong>
      </label>
      <input
        id={id}
        type="range"
        min={0}
        max={0.5}
        step={0.01}
        value={value}
        onChange={(event) => onChange(Number(event.target.value))}
      />
    </div>
  );
}

interface ChoiceProps {
  label: string;
  value: number | null;
  onChange: (value: number | null) => void;
}

/** Buttons that are pressed now say so, so that one finds theirs by pressing it. */
function ButtonChoice({ pad, ...rest }: ChoiceProps & { pad: Pad }) {
  const choices = pad.buttons.map(({ pressed }, button) => `${buttonName(button, pad)}${pressed ? ": pressed" : ""}`);
  return <PadChoice choices={choices} {...rest} />;
}

function PadChoice({ label, value, choices, onChange }: ChoiceProps & { choices: readonly string[] }) {
  const id = useId();
  return (
    <div className="pad-choice">
      <label htmlFor={id}>{label}</label>
      <select
        id={id}
        value={value ?? none}
        onChange={(event) => onChange(event.target.value === none ? null : Number(event.target.value))}
      >
        <option value={none}>nothing</option>
        {value !== null && value >= choices.length && <option value={value}>{value}: this gamepad has none</option>}
        {choices.map((title, at) => (
          <option key={at} value={at}>
            {title}
          </option>
        ))}
      </select>
    </div>
  );
}
