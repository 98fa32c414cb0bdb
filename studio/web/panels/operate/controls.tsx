import { useEffect, useId, useRef, type KeyboardEvent, type SyntheticEvent } from "react";
import type { PanelControl } from "../../model/protocol";
import { neutralOf, stepOfSlider, type Inputs } from "../../model/run/panel_inputs";

/** The controls of a panel that are no stick. */

export interface ControlProps {
  control: PanelControl;
  value: number | boolean;
  disabled: boolean;
  /** Counts the moments at which everything that is held counts as released. */
  rests: number;
  /** A slider that is released goes to its neutral value. */
  springs: boolean;
  onMove: (change: Inputs) => void;
}

/** "0.5 m/s". */
export const withUnit = (value: number | boolean, { unit }: PanelControl) => `${value}${unit && ` ${unit}`}`;

/** A long press of a finger must not open a menu over the controls. */
export const noMenu = (event: SyntheticEvent) => event.preventDefault();

/** True while a pointer or a key holds it. Several fingers may. */
export function HeldButton({ control, value, disabled, rests, onMove }: ControlProps) {
  const holders = useRef(new Set<number | "key">());
  const change = () => {
    const held = holders.current.size > 0;
    if (held !== value) onMove({ [control.field]: held });
  };
  const hold = (who: number | "key") => {
    holders.current.add(who);
    change();
  };
  const release = (who: number | "key") => {
    if (holders.current.delete(who)) change();
  };
  useEffect(() => holders.current.clear(), [rests, disabled]);
  const isHold = ({ key }: KeyboardEvent) => key === " " || key === "Enter";
  return (
    <button
      className="held-button"
      disabled={disabled}
      aria-pressed={value === true}
      onContextMenu={noMenu}
      onPointerDown={(event) => {
        if (event.button !== 0) return;
        event.currentTarget.setPointerCapture(event.pointerId);
        hold(event.pointerId);
      }}
      onPointerUp={(event) => release(event.pointerId)}
      onPointerCancel={(event) => release(event.pointerId)}
      onLostPointerCapture={(event) => release(event.pointerId)}
      onKeyDown={(event) => isHold(event) && !event.repeat && hold("key")}
      onKeyUp={(event) => isHold(event) && release("key")}
      onBlur={() => release("key")}
    >
      {control.field}
    </button>
  );
}

export function Switch({ control, value, disabled, onMove }: ControlProps) {
  return (
    <label className="operator-switch">
      <input
        type="checkbox"
        disabled={disabled}
        checked={value === true}
        onChange={(event) => onMove({ [control.field]: event.target.checked })}
      />
      {control.field}
    </label>
  );
}

/** It stays where it is, unless it springs back. */
export function Slider({ control, value, disabled, springs, onMove }: ControlProps) {
  const id = useId();
  const release = () => springs && !disabled && onMove({ [control.field]: neutralOf(control) });
  return (
    <div className="operator-slider">
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
        onPointerUp={release}
        onPointerCancel={release}
        onLostPointerCapture={release}
        onKeyUp={({ key }) => key !== "Tab" && release()}
        onBlur={release}
        onChange={(event) => onMove({ [control.field]: Number(event.target.value) })}
      />
    </div>
  );
}
