import { Store } from "./store";

const visited = "tessera.visited";

/** The parts of the page that the tour shows, in its order. */
export const tourSteps = ["structure", "edit", "verify", "run", "values"] as const;
export type TourStep = (typeof tourSteps)[number];

export interface GuideState {
  /** The help with the shortcuts is open. */
  open: boolean;
  /** The step of the tour that is shown; null: no tour. */
  step: TourStep | null;
  /** The tour is offered: this browser has not shown the page before. */
  offered: boolean;
}

/** The help of the page: shortcuts, and the tour, which is offered once. */
export class Guide {
  readonly store: Store<GuideState>;

  constructor(private readonly kept: Pick<Storage, "getItem" | "setItem">) {
    this.store = new Store<GuideState>({ open: false, step: null, offered: kept.getItem(visited) === null });
  }

  open(open: boolean): void {
    this.store.set({ open });
  }

  /** Begins the tour, or goes on with another step of it; null: leaves it. */
  go(step: TourStep | null): void {
    this.refuse();
    this.store.set({ step, open: false });
  }

  /** The step after the shown one, or before it; null at the end. */
  beside(by: 1 | -1): TourStep | null {
    const { step } = this.store.get();
    return step === null ? null : (tourSteps[tourSteps.indexOf(step) + by] ?? null);
  }

  /** The tour is not offered again. */
  refuse(): void {
    this.kept.setItem(visited, "1");
    this.store.set({ offered: false });
  }
}
