import { panelsIn, pruned, readTree, restored, seenIn, tabSets, withTabSet, type Row } from "../../model/dock/dock_tree";
import {
  closedIn,
  layoutNames,
  readyLayout,
  widthName,
  type LayoutName,
  type Places,
  type WidthName,
} from "../../model/dock/ready_layouts";
import { Store } from "../store";

/** One arrangement of the user: where every panel stands, and which ones are closed. */
interface Arranged {
  tree: Row;
  closed: readonly string[];
}

export interface DockState {
  layout: LayoutName;
  /** The panels on the page and where they stand; null before the project is known. */
  shown: Row | null;
  /** Panels that are on the page, also behind another tab. */
  open: readonly string[];
  /** Panels that have something to show, open or not. */
  available: readonly string[];
  /** Those that can be seen. */
  seen: readonly string[];
  /** The one that the user has chosen last. */
  chosen: string;
}

/**
 * The panels around the drawing: which are open and where they stand, kept for each project. A panel that has nothing to show
 * is not on the page, and is back in its place when it has.
 */
export class Dock {
  readonly store = new Store<DockState>({ layout: "edit", shown: null, open: [], available: [], seen: [], chosen: "" });
  private panels: readonly Places[] = [];
  private key = "";
  private width: WidthName = "wide";
  private pixels = 1440;
  private arranged: Partial<Record<string, Arranged>> = {};

  constructor(private readonly storage: Pick<Storage, "getItem" | "setItem"> = localStorage) {}

  /** Begins with the layout that was kept for a project. `pixels`: the width of the window. */
  begin(project: string, panels: readonly Places[], pixels: number): void {
    this.panels = panels;
    this.key = `tessera.panels ${project}`;
    this.pixels = pixels;
    this.width = widthName(pixels);
    this.arranged = {};
    const kept = this.kept();
    const layout = layoutNames.find((one) => one === kept.layout) ?? "edit";
    const layouts = typeof kept.layouts === "object" && kept.layouts !== null ? kept.layouts : {};
    for (const [name, one] of Object.entries(layouts)) {
      const read = this.read(one);
      if (read) this.arranged[name] = read;
    }
    this.store.set({ layout });
    this.show();
  }

  private kept(): { layout?: unknown; layouts?: object | null } {
    try {
      const kept: unknown = JSON.parse(this.storage.getItem(this.key) ?? "{}");
      return typeof kept === "object" && kept !== null ? kept : {};
    } catch {
      return {};
    }
  }

  private read(kept: unknown): Arranged | null {
    const { tree, closed } = (kept ?? {}) as Record<string, unknown>;
    const known = (name: string) => this.panels.some((panel) => panel.name === name);
    const read = readTree(tree, known);
    if (!read || !Array.isArray(closed)) return null;
    return { tree: read, closed: closed.filter((name): name is string => typeof name === "string" && name !== "drawing") };
  }

  private keep(): void {
    try {
      this.storage.setItem(this.key, JSON.stringify({ layout: this.store.get().layout, layouts: this.arranged }));
    } catch {
      // A browser that keeps nothing begins with the ready layout again.
    }
  }

  /** The arrangement of the present layout in a window of the present width. */
  private get now(): Arranged {
    const { layout } = this.store.get();
    const ready = readyLayout(layout, this.panels, this.pixels);
    const mine = this.arranged[`${layout} ${this.width}`];
    if (!mine) return { tree: ready, closed: closedIn(layout, this.panels) };
    // Panels that are new since it was kept.
    const missing = panelsIn(ready).filter((name) => !panelsIn(mine.tree).includes(name));
    return { tree: restored(mine.tree, ready, missing), closed: mine.closed };
  }

  private set(next: Arranged): void {
    this.arranged[`${this.store.get().layout} ${this.width}`] = next;
    this.keep();
    this.show();
  }

  private show(): void {
    const { available } = this.store.get();
    if (this.panels.length === 0 || available.length === 0) return;
    const { tree, closed } = this.now;
    const shown = pruned(tree, (name) => available.includes(name) && !closed.includes(name));
    const seen = seenIn(shown);
    const open = panelsIn(shown);
    const chosen = this.store.get().chosen;
    this.store.set({ shown, seen, open, chosen: seen.includes(chosen) ? chosen : this.instead(shown, tree, chosen) });
  }

  /** The panel that is seen where the chosen one was. */
  private instead(shown: Row, tree: Row, chosen: string): string {
    const home = tabSets(tree).find(({ tabs }) => tabs.includes(chosen));
    return tabSets(shown).find(({ id }) => id === home?.id)?.front ?? "drawing";
  }

  /** The width of the window has changed. */
  resized(pixels: number): void {
    this.pixels = pixels;
    if (widthName(pixels) === this.width) return;
    const { chosen } = this.store.get();
    this.width = widthName(pixels);
    // The one that the user works with stays in front.
    if (this.store.get().available.includes(chosen)) this.open(chosen);
    else this.show();
  }

  /** The panels that have something to show now. */
  offer(available: readonly string[]): void {
    const before = this.store.get().available;
    if (before.length === available.length && available.every((name) => before.includes(name))) return;
    this.store.set({ available });
    this.show();
  }

  /** Opens a panel, in front of others, and chooses it. One that has nothing to show yet comes when it has. */
  open(name: string): void {
    if (!this.panels.some((panel) => panel.name === name)) return;
    const { tree, closed } = this.now;
    const whole = tabSets(tree).find(({ maximised }) => maximised);
    const covered = whole && !whole.tabs.includes(name);
    const uncovered = covered ? withTabSet(tree, whole.front, ({ maximised: _, ...one }) => one) : tree;
    const next = withTabSet(uncovered, name, (one) => ({ ...one, front: name }));
    this.store.set({ chosen: name });
    this.set({ tree: next, closed: closed.filter((one) => one !== name) });
  }

  /** Closes a panel. The drawing stays. */
  close(name: string): void {
    if (name === "drawing") return;
    const { tree, closed } = this.now;
    this.set({ tree, closed: [...closed.filter((one) => one !== name), name] });
  }

  /** Shows the tab set of a panel in the whole page, or in its place again. */
  maximise(name: string): void {
    const { tree } = this.now;
    const isWhole = tabSets(tree).some(({ tabs, maximised }) => maximised && tabs.includes(name));
    const none = tabSets(tree).reduce(
      (now, one) => (one.maximised ? withTabSet(now, one.front, ({ maximised: _, ...rest }) => rest) : now),
      tree,
    );
    if (!this.store.get().open.includes(name)) return;
    const front = isWhole ? none : withTabSet(none, name, (one) => ({ ...one, front: name, maximised: true }));
    this.set({ tree: front, closed: this.now.closed });
  }

  /** The user has rearranged what is shown. */
  arrange(shown: Row): void {
    const { tree, closed } = this.now;
    const before = this.store.get().open;
    const left = panelsIn(shown);
    const gone = before.filter((name) => !left.includes(name));
    const missing = panelsIn(tree).filter((name) => !left.includes(name));
    this.set({ tree: restored(shown, tree, missing), closed: [...closed.filter((name) => !left.includes(name)), ...gone] });
  }

  /** The user has chosen a panel. */
  choose(name: string): void {
    if (this.store.get().chosen !== name) this.store.set({ chosen: name });
  }

  use(layout: LayoutName): void {
    this.store.set({ layout });
    this.keep();
    this.show();
  }

  /** The present layout as it comes with the page. */
  reset(): void {
    delete this.arranged[`${this.store.get().layout} ${this.width}`];
    this.keep();
    this.show();
  }
}
