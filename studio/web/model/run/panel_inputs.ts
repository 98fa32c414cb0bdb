import type { PanelControl } from "../protocol";

/** The values of the controls of an operator's panel (docs/use/drivers.md, Teleoperation). */

export type Inputs = Readonly<Record<string, number | boolean>>;

const isStick = ({ control }: PanelControl) => control === "stick_x" || control === "stick_y";
/** The controls that return to neutral when they are released. */
export const springsBack = (control: PanelControl) => isStick(control) || control.control === "button";

/**
 * False, zero, or the number of the range that is nearest to zero: the controller uses the same without an
 * operator.
 */
export function neutralOf({ minimum, maximum }: PanelControl): number | boolean {
  return minimum === null || maximum === null ? false : Math.min(Math.max(0, minimum), maximum);
}

export function neutralInputs(controls: readonly PanelControl[]): Inputs {
  return Object.fromEntries(controls.map((one) => [one.field, neutralOf(one)]));
}

/** The same with all released controls at rest. */
export function released(controls: readonly PanelControl[], inputs: Inputs): Inputs {
  return { ...inputs, ...neutralInputs(controls.filter(springsBack)) };
}

/** A deflection from -1 to 1 in the range of the control, whose zero stays zero. */
export function deflected({ minimum, maximum, whole }: PanelControl, deflection: number): number {
  const part = Math.min(Math.max(deflection, -1), 1);
  const value = part < 0 ? -part * (minimum ?? -1) : part * (maximum ?? 1);
  return whole ? Math.round(value) : Number(value.toPrecision(4));
}

/** The position of a value, from -1 to 1. */
export function deflectionOf({ minimum, maximum }: PanelControl, value: number): number {
  const end = value < 0 ? -(minimum ?? -1) : (maximum ?? 1);
  return end === 0 ? 0 : value / end;
}

/** The deflection of a stick by the arrow keys: [to the right, up]. With Shift a third of it. */
export function pushOf(keys: ReadonlySet<string>, gently: boolean): [number, number] {
  const push = (more: string, less: string) => ((keys.has(more) ? 1 : 0) - (keys.has(less) ? 1 : 0)) * (gently ? 1 / 3 : 1);
  return [push("ArrowRight", "ArrowLeft"), push("ArrowUp", "ArrowDown")];
}

export interface Pad {
  axes: readonly number[];
  buttons: readonly { pressed: boolean }[];
}

const deadZone = 0.12;

/**
 * The input of a gamepad for the panel with that number: its left stick and, in order, its buttons for the
 * first panel, its right stick for the second. Controls at rest are left out.
 */
export function padInputs(controls: readonly PanelControl[], pad: Pad, panel: number): Inputs {
  const found: Record<string, number | boolean> = {};
  const buttons = controls.filter(({ control }) => control === "button");
  for (const one of controls) {
    const axis = one.control === "stick_x" ? 2 * panel : one.control === "stick_y" ? 2 * panel + 1 : -1;
    // A gamepad counts downwards as positive.
    const moved = (pad.axes[axis] ?? 0) * (one.control === "stick_y" ? -1 : 1);
    if (axis >= 0 && Math.abs(moved) > deadZone) found[one.field] = deflected(one, moved);
    if (panel === 0 && one.control === "button" && pad.buttons[buttons.indexOf(one)]?.pressed) found[one.field] = true;
  }
  return found;
}

/** The step of a slider: about a hundred of them, a round number, and whole for whole numbers. */
export function stepOfSlider({ minimum, maximum, whole }: PanelControl): number {
  const fine = 10 ** Math.floor(Math.log10(((maximum ?? 1) - (minimum ?? 0)) / 100));
  return whole ? Math.max(1, fine) : fine;
}
