import { intersects, type Box, type Sheet } from "./geometry";
import { inset, layoutPage, signature, type Elk, type Folded } from "./layout";
import type { NetModel } from "./net";

/** A sheet in the coordinates of the whole drawing. */
export interface Placed {
  page: number;
  sheet: Sheet;
  x: number;
  y: number;
  /** Size of a unit of the sheet in units of the drawing. */
  scale: number;
}

/** The visible window: a box of the drawing, and pixels per unit. */
export interface Window extends Box {
  zoom: number;
}

/** The inside of a page is drawn if one of its units takes at least this number of pixels. */
export const legible = 0.24;

/** A page that fills the window is drawn even smaller: a large net would stay an empty box otherwise. */
const recognizable = 0.06;
const fills = (box: Box, window: Window) => box.width > window.width / 2 || box.height > window.height / 2;

/**
 * The sheets of a net, laid out when they are first needed. A net with few differences keeps the
 * sheets of all unchanged pages.
 */
export class Sheets {
  private readonly bySignature: Map<string, Sheet>;
  private readonly waiting = new Set<string>();
  private readonly signatures = new Map<number, string>();

  /** changed: called when a requested sheet has arrived. */
  constructor(
    readonly net: NetModel,
    readonly folded: Folded,
    private readonly elk: Elk,
    private readonly changed: () => void,
    before?: Sheets,
  ) {
    this.bySignature = before?.bySignature ?? new Map();
  }

  private signature(page: number): string {
    let known = this.signatures.get(page);
    if (known === undefined) this.signatures.set(page, (known = signature(this.net, page, this.folded)));
    return known;
  }

  /** The sheet; undefined while it is being made. */
  get(page: number): Sheet | undefined {
    const key = this.signature(page);
    const sheet = this.bySignature.get(key);
    if (!sheet && !this.waiting.has(key)) {
      this.waiting.add(key);
      void layoutPage(this.net, page, this.folded, this.elk).then((made) => {
        this.bySignature.set(key, made);
        this.changed();
      });
    }
    return sheet;
  }

  /**
   * The position of a page's sheet. Requests every sheet on the way; undefined as long as one is missing.
   */
  placed(page: number): Placed | undefined {
    const parent = this.net.page(page).parent;
    const sheet = this.get(page);
    if (parent === null) return sheet && { page, sheet, x: 0, y: 0, scale: 1 };
    const above = this.placed(parent);
    if (!sheet || !above) return undefined;
    const node = this.net.page(parent).nodes.findIndex((candidate) => candidate.page === page);
    return this.within(above, page, node, sheet);
  }

  private within(above: Placed, page: number, node: number, sheet: Sheet): Placed {
    const inner = inset(above.sheet.nodes[node]!, sheet);
    return {
      page,
      sheet,
      x: above.x + inner.x * above.scale,
      y: above.y + inner.y * above.scale,
      scale: above.scale * inner.scale,
    };
  }

  /** The sheets to draw in a window, parents first: those that are in it and large enough to be read. */
  visible(window: Window): Placed[] {
    const found: Placed[] = [];
    const visit = (at: Placed) => {
      found.push(at);
      const inside: { placed: Placed; filling: boolean }[] = [];
      const own = windowOn(at, window);
      this.net.page(at.page).nodes.forEach((node, index) => {
        // Most of a large net is outside of the window or too small, so that is asked first.
        const on = at.sheet.nodes[index]!;
        if (on.width * own.zoom < 60 || !intersects(on, own) || node.page === null || this.folded(node.page)) return;
        const sheet = this.get(node.page);
        const filling = fills(boxWithin(at, on), window);
        if (sheet) inside.push({ placed: this.within(at, node.page, index, sheet), filling });
      });
      // If one sheet is legible, neighbours that are nearly legible are shown, too.
      const enough = inside.some(({ placed }) => placed.scale * window.zoom >= legible) ? 0.8 * legible : legible;
      for (const { placed, filling } of inside)
        if (placed.scale * window.zoom >= (filling ? recognizable : enough)) visit(placed);
    };
    const root = this.placed(0);
    if (root) visit(root);
    return found;
  }

  /** The box of a page, place or transition in the drawing. */
  boxOf(path: string): Box | undefined {
    const element = this.net.find(path);
    if (!element) return undefined;
    const on = this.placed(element.page);
    if (!on) return undefined;
    if (element.index < 0) return { x: 0, y: 0, width: on.sheet.width, height: on.sheet.height };
    const box = element.kind === "transition" ? on.sheet.transitions[element.index] : on.sheet.nodes[element.index];
    return box && boxWithin(on, box);
  }
}

/** The window in the units of a sheet. */
export const windowOn = (at: Placed, window: Window): Window => ({
  x: (window.x - at.x) / at.scale,
  y: (window.y - at.y) / at.scale,
  width: window.width / at.scale,
  height: window.height / at.scale,
  zoom: window.zoom * at.scale,
});

export const boxWithin = (at: Placed, box: Box): Box => ({
  x: at.x + box.x * at.scale,
  y: at.y + box.y * at.scale,
  width: box.width * at.scale,
  height: box.height * at.scale,
});
