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

/** The same with all released controls at rest. sliders: they spring back, too. */
export function released(controls: readonly PanelControl[], inputs: Inputs, sliders = false): Inputs {
  const back = controls.filter((one) => springsBack(one) || (sliders && one.control === "slider"));
  return { ...inputs, ...neutralInputs(back) };
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

/** The directions in which keys push a stick. */
export type Direction = "up" | "down" | "left" | "right";

const arrows: Readonly<Record<string, Direction>> = { ArrowUp: "up", ArrowDown: "down", ArrowLeft: "left", ArrowRight: "right" };
const letters: Readonly<Record<string, Direction>> = { w: "up", s: "down", a: "left", d: "right" };

/** The keys that move a stick: both kinds while it has the focus, or one kind wherever the focus is. */
export type StickKeys = "letters" | "arrows" | "both";

/** The direction of a key; undefined: it does not move the stick. */
export function directionOf(key: string, keys: StickKeys): Direction | undefined {
  const letter = keys === "arrows" ? undefined : letters[key.toLowerCase()];
  return letter ?? (keys === "letters" ? undefined : arrows[key]);
}

/** The deflection of a stick by keys: [to the right, up]. Gently: a third of it. */
export function pushOf(held: Iterable<Direction>, gently: boolean): [number, number] {
  const all = new Set(held);
  const push = (more: Direction, less: Direction) => ((all.has(more) ? 1 : 0) - (all.has(less) ? 1 : 0)) * (gently ? 1 / 3 : 1);
  return [push("right", "left"), push("up", "down")];
}

/** The step of a slider: about a hundred of them, a round number, and whole for whole numbers. */
export function stepOfSlider({ minimum, maximum, whole }: PanelControl): number {
  const fine = 10 ** Math.floor(Math.log10(((maximum ?? 1) - (minimum ?? 0)) / 100));
  return whole ? Math.max(1, fine) : fine;
}
