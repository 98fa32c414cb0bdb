import type { NetModel } from "./net";

/** The values of the free conditions of a net by transition; absent: both are possible. */
export type Conditions = ReadonlyMap<number, boolean>;

/** A marking of the flat net: tokens per place. */
export type Marking = Int32Array;

export const initialMarking = (net: NetModel): Marking => net.elements.initialMarking();

/** Whether every input place holds enough tokens. Conditions are not considered. */
export function isEnabled(net: NetModel, marking: Marking, transition: number): boolean {
  return net.transitions.at(transition)!.inputs.every((arc) => marking[arc.place]! >= arc.weight);
}

/** Whether the transition is enabled and its condition can hold. */
export function isActive(net: NetModel, marking: Marking, transition: number, conditions?: Conditions): boolean {
  const condition = net.transitions.at(transition)!.condition;
  if (condition?.truth === "never" || conditions?.get(transition) === false) return false;
  return isEnabled(net, marking, transition);
}

/** Takes tokens from the input places and puts tokens into the output places; `times` -1 undoes that. */
export function fire(net: NetModel, marking: Marking, transition: number, times: 1 | -1 = 1): void {
  const { inputs, outputs } = net.transitions.at(transition)!;
  for (const arc of inputs) marking[arc.place]! -= times * arc.weight;
  for (const arc of outputs) marking[arc.place]! += times * arc.weight;
}

/**
 * The smallest marking with which a run can have begun: the tokens that it takes from a place before it puts
 * any there.
 */
export function markingBefore(net: NetModel, run: Iterable<number>): Marking {
  const before: Marking = new Int32Array(net.places.length);
  const now = before.slice();
  for (const transition of run) {
    for (const { place, weight } of net.transitions.at(transition)!.inputs) {
      const missing = Math.max(0, weight - now[place]!);
      before[place]! += missing;
      now[place]! += missing;
    }
    fire(net, now, transition);
  }
  return before;
}

export function activeTransitions(net: NetModel, marking: Marking, conditions?: Conditions): number[] {
  return net.elements.enabled(marking).filter((index) => isActive(net, marking, index, conditions));
}

/** The behaviours that hold a token, by subsystem index: those that run now. */
export function runningBehaviours(net: NetModel, marking: Marking): Map<number, string> {
  const running = new Map<number, string>();
  marking.forEach((tokens, index) => {
    if (tokens === 0) return;
    const place = net.places.at(index)!;
    const behaviour = place.subsystem === null ? undefined : net.behaviourName(place.page);
    if (behaviour) running.set(place.subsystem!, behaviour);
  });
  return running;
}

/** A run of firings with steps in both directions. */
export class Walk {
  readonly steps: number[];
  position = 0;
  readonly marking: Marking;

  constructor(
    private readonly net: NetModel,
    steps: readonly number[] = [],
  ) {
    this.steps = [...steps];
    this.marking = initialMarking(net);
  }

  /** false: the next step cannot be fired, so the run does not belong to this net. */
  forward(): boolean {
    const next = this.steps[this.position];
    if (next === undefined || !isEnabled(this.net, this.marking, next)) return false;
    fire(this.net, this.marking, next);
    this.position += 1;
    return true;
  }

  back(): boolean {
    if (this.position === 0) return false;
    this.position -= 1;
    fire(this.net, this.marking, this.steps[this.position]!, -1);
    return true;
  }

  /** Moves to the marking after `position` steps. */
  seek(position: number): void {
    while (this.position < position && this.forward());
    while (this.position > position && this.back());
  }

  /** Fires another transition here; the later steps are dropped. */
  choose(transition: number): boolean {
    if (!isEnabled(this.net, this.marking, transition)) return false;
    this.steps.length = this.position;
    this.steps.push(transition);
    return this.forward();
  }
}
