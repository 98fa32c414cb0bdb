import type { PanelControl } from "../protocol";
import { deflected, type Inputs } from "./panel_inputs";

/** The part of a gamepad of the browser that is used here. */
export interface Pad {
  axes: readonly number[];
  buttons: readonly { pressed: boolean }[];
  /** "standard": the browser knows which axis and button is which. */
  mapping?: string;
  id?: string;
}

/** The parts of a gamepad that move the controls of one panel. */
export interface PadSetup {
  /** An axis that is moved less than this counts as at rest. */
  deadZone: number;
  /** The button that must be held for anything to have an effect; null: none. */
  enable: number | null;
  /** By field of a stick or slider; null: no axis moves it. */
  axes: Readonly<Record<string, { axis: number; inverted: boolean } | null>>;
  /** By field of a button or switch; null: no button does. */
  buttons: Readonly<Record<string, number | null>>;
}

/** The controls that an axis can move. */
export const takesAxis = ({ control }: PanelControl) => control === "stick_x" || control === "stick_y" || control === "slider";

/** Button 4 is the left shoulder of a standard gamepad. */
const standardButtons = [
  "A, below",
  "B, right",
  "X, left",
  "Y, above",
  "left shoulder",
  "right shoulder",
  "left trigger",
  "right trigger",
  "back",
  "start",
  "left stick, pressed",
  "right stick, pressed",
  "cross up",
  "cross down",
  "cross left",
  "cross right",
  "home",
];
const standardAxes = ["left stick, sideways", "left stick, up and down", "right stick, sideways", "right stick, up and down"];

/** The name of a button, as printed on a standard gamepad, or its number. */
export function buttonName(button: number, { mapping }: Pad): string {
  return (mapping === "standard" && standardButtons[button]) || `button ${button}`;
}

/** The name of an axis, or its number. */
export function axisName(axis: number, { mapping }: Pad): string {
  return (mapping === "standard" && standardAxes[axis]) || `axis ${axis}`;
}

/**
 * The setup of a panel that nobody has changed: the left stick and, in order, the buttons for the first panel, the right
 * stick for the second.
 */
export function usualSetup(controls: readonly PanelControl[], panel: number): PadSetup {
  const axes: Record<string, { axis: number; inverted: boolean } | null> = {};
  const buttons: Record<string, number | null> = {};
  let button = 0;
  for (const one of controls) {
    if (takesAxis(one)) {
      const axis = one.control === "stick_x" ? 2 * panel : 2 * panel + 1;
      // A gamepad counts downwards as positive.
      axes[one.field] = one.control === "slider" || axis > 3 ? null : { axis, inverted: one.control === "stick_y" };
    } else if (one.control === "button" && panel === 0) {
      buttons[one.field] = button;
      button += 1;
    } else buttons[one.field] = null;
  }
  return { deadZone: 0.12, enable: null, axes, buttons };
}

const isIndex = (value: unknown): value is number => Number.isInteger(value) && (value as number) >= 0 && (value as number) < 64;

/** A kept setup for the controls as they are now. Parts that do not fit any more are as usual. */
export function setupFrom(kept: unknown, usual: PadSetup): PadSetup {
  if (typeof kept !== "object" || kept === null) return usual;
  const { deadZone, enable, axes, buttons } = kept as Partial<Record<keyof PadSetup, unknown>>;
  const of = (all: unknown, field: string): unknown =>
    typeof all === "object" && all !== null ? (all as Record<string, unknown>)[field] : undefined;
  const axisOf = (field: string) => {
    const one = of(axes, field);
    if (one === null) return null;
    const { axis, inverted } = (one ?? {}) as { axis?: unknown; inverted?: unknown };
    return isIndex(axis) ? { axis, inverted: inverted === true } : usual.axes[field]!;
  };
  const buttonOf = (field: string) => {
    const one = of(buttons, field);
    return one === null || isIndex(one) ? one : usual.buttons[field]!;
  };
  return {
    deadZone: typeof deadZone === "number" && deadZone >= 0 && deadZone <= 0.5 ? deadZone : usual.deadZone,
    enable: isIndex(enable) ? enable : null,
    axes: Object.fromEntries(Object.keys(usual.axes).map((field) => [field, axisOf(field)])),
    buttons: Object.fromEntries(Object.keys(usual.buttons).map((field) => [field, buttonOf(field)])),
  };
}

/** The deflection beyond the dead zone, from -1 to 1; it begins with 0 at its edge. */
export function beyond(value: number, deadZone: number): number {
  const size = Math.min(1, Math.abs(value));
  return size <= deadZone ? 0 : (Math.sign(value) * (size - deadZone)) / (1 - deadZone);
}

/** Whether the gamepad may move anything now: its enable button is held, or it needs none. */
export const isEnabled = (setup: PadSetup, pad: Pad): boolean =>
  setup.enable === null || pad.buttons[setup.enable]?.pressed === true;

/**
 * The inputs of a gamepad for the sticks, sliders and buttons of a panel. Controls at rest are left out. armed: the axes
 * that were at rest once; the others do not count yet.
 */
export function padInputs(
  controls: readonly PanelControl[],
  pad: Pad,
  setup: PadSetup,
  armed: (axis: number) => boolean = () => true,
): Inputs {
  const found: Record<string, number | boolean> = {};
  if (!isEnabled(setup, pad)) return found;
  for (const one of controls) {
    const part = setup.axes[one.field];
    if (takesAxis(one) && part && armed(part.axis)) {
      const moved = beyond(pad.axes[part.axis] ?? 0, setup.deadZone) * (part.inverted ? -1 : 1);
      if (moved !== 0) found[one.field] = deflected(one, moved);
    }
    const button = setup.buttons[one.field];
    if (one.control === "button" && isIndex(button) && pad.buttons[button]?.pressed) found[one.field] = true;
  }
  return found;
}
