import { foldedPage, header, intersects, type Box } from "../../../model/net/geometry";
import { conditionText, operationText, pageName } from "../../../model/net/labels";
import type { Folded } from "../../../model/net/layout";
import type { NetModel } from "../../../model/net/net";
import type { Placed, Window } from "../../../model/net/sheets";
import { closedName, layerSize, runningSize, type ClosedName } from "../closed_name";
import { isBare } from "../crowd";
import { nearness, steps } from "../../detail";
import type { Marks } from "../marks";
import { paintArcs } from "./arcs";
import { Batches } from "./batches";
import type { Ink, LetterInk, ShapeInk } from "./ink";

export interface Scene {
  net: NetModel;
  folded: Folded;
  /** The visible sheets, parents first. */
  visible: readonly Placed[];
  selected: string | null;
  flags: ReadonlyMap<string, "error" | "warning">;
}

/** Draws the visible sheets of a net on a canvas, as symbols.tsx does with elements of SVG. */
export function paintNet(
  context: CanvasRenderingContext2D,
  ink: Ink,
  scene: Scene,
  marks: Marks,
  window: Window,
  ratio: number,
): void {
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.clearRect(0, 0, context.canvas.width, context.canvas.height);
  const open = new Set(scene.visible.map(({ page }) => page));
  for (const placed of scene.visible) {
    const pixel = placed.scale * window.zoom;
    const size = pixel * ratio;
    context.setTransform(
      size,
      0,
      0,
      size,
      (placed.x - window.x) * window.zoom * ratio,
      (placed.y - window.y) * window.zoom * ratio,
    );
    new SheetPainter(context, ink, scene, marks, window, placed, open).paint();
  }
}

/** Pixels of the line around a page that is so small that it has no name; as in canvas.css. */
const bareLine = 0.5;
/** Names far outside of the window cannot reach into it, in units of a sheet. */
const rim = 80;

const names = new Map<string, ClosedName>();

/** The layout of a closed name relative to its box, made once for each name and size. */
function nameIn(name: string, { width, height }: Box): ClosedName {
  const key = `${name}/${width}/${height}`;
  let known = names.get(key);
  if (!known) {
    if (names.size > 20_000) names.clear();
    names.set(key, (known = closedName(name, { x: 0, y: 0, width, height })));
  }
  return known;
}

class SheetPainter {
  private readonly near: number;
  private readonly far: boolean;
  private readonly classes: string;
  private readonly clip: Box;
  private readonly pixel: number;
  /** Pixels of a unit, in the steps by which letters grow. */
  private readonly at: number;
  private readonly batches = new Batches();
  private readonly bare: boolean;
  private readonly thin = new Map<ShapeInk, ShapeInk>();

  constructor(
    private readonly context: CanvasRenderingContext2D,
    private readonly ink: Ink,
    private readonly scene: Scene,
    private readonly marks: Marks,
    window: Window,
    private readonly placed: Placed,
    private readonly open: ReadonlySet<number>,
  ) {
    const { page, scale, x, y } = placed;
    this.pixel = scale * window.zoom;
    this.at = scale * steps(window.zoom);
    this.near = nearness(this.pixel);
    this.far = this.near <= -3;
    this.bare = isBare(placed.sheet, this.pixel);
    this.classes = `sheet layer-${scene.net.page(page).layer} near${this.near}${marks.runs(page) ? " runs" : ""}`;
    this.clip = {
      x: (window.x - x) / scale - rim,
      y: (window.y - y) / scale - rim,
      width: window.width / scale + 2 * rim,
      height: window.height / scale + 2 * rim,
    };
  }

  paint(): void {
    const { scene, placed, classes, pixel, clip, far } = this;
    const { page, sheet } = placed;
    const on = scene.net.page(page);
    paintArcs(this.context, this.ink, { net: scene.net, page, sheet, classes, pixel, clip, far });
    on.nodes.forEach((node, index) => {
      const box = sheet.nodes[index]!;
      if (!intersects(box, clip)) return;
      if (node.page === null) this.place(index, box);
      else this.page(node.page, box);
    });
    on.transitions.forEach((_, index) => {
      const box = sheet.transitions[index]!;
      if (intersects(box, clip)) this.bar(index, box);
    });
    this.batches.draw(this.context, pixel);
  }

  /** Adds a text with letters as large as the style sheet makes them, if they can be read. grown: by `u`. */
  private letters(text: string, ink: LetterInk, x: number, y: number, align: CanvasTextAlign, u = ink.u, more = ink.more): void {
    const largest = u * more * ink.k;
    if (!ink.shown || text === "" || largest * this.at < 10) return;
    this.batches.text(text, ink, Math.max(u * ink.k, Math.min(10 / this.at, largest)), x, y, align);
  }

  private labels(element: string, box: Box, direction: "down" | "right", lines: { text: string; kind: string }[]): void {
    const shown = lines.filter(({ text }) => text !== "");
    const down = direction === "down";
    const x = down ? box.x + box.width + 6 : box.x + box.width / 2;
    const first = down ? box.y + box.height / 2 + 4 - (shown.length - 1) * 6.5 : box.y + box.height + 13;
    shown.forEach(({ text, kind }, at) =>
      this.letters(
        text,
        this.ink.letters(this.classes, element, `text.label.${kind}`),
        x,
        first + at * 13,
        down ? "left" : "center",
      ),
    );
  }

  private place(index: number, box: Box): void {
    const { net, selected } = this.scene;
    const { page, sheet } = this.placed;
    const node = net.page(page).nodes[index]!;
    const flat = net.flatPlaces(page)[index]!;
    const isSelected = selected !== null && net.places.at(flat)?.name === selected;
    const element = `element place${node.fusion === null ? "" : " fused"}${isSelected ? " selected" : ""} ${this.marks.place(flat)}`;
    const [cx, cy] = [box.x + box.width / 2, box.y + box.height / 2];
    this.batches.circle(this.shape(element, "circle.shape"), cx, cy, box.width / 2);
    const tokens = this.marks.tokens(flat);
    if (tokens > 0) this.batches.circle(this.shape(element, "g.tokens circle.token"), cx, cy, 5);
    if (tokens > 1) {
      const ink = this.ink.letters(this.classes, element, "g.tokens text.token-count");
      this.batches.text(String(tokens), ink, ink.u, cx, cy + 4, "center");
    }
    if (this.near > -2)
      this.labels(element, box, sheet.direction, [
        { text: node.name, kind: "name" },
        { text: operationText(net.page(page), node.operation), kind: "operation" },
      ]);
  }

  private bar(index: number, box: Box): void {
    const { net, selected } = this.scene;
    const { page, sheet } = this.placed;
    const transition = net.page(page).transitions[index]!;
    const flat = net.flatTransitions(page)[index]!;
    const isSelected = selected !== null && net.transitions.at(flat)?.name === selected;
    const never = transition.condition?.truth === "never";
    const element = `element bar${never ? " never" : ""}${isSelected ? " selected" : ""} ${this.marks.transition(flat)}`;
    const wide = box.width > 80;
    this.batches.rectangle(this.shape(element, "rect.reach"), box.x - 6, box.y - 6, box.width + 12, box.height + 12, 5);
    this.batches.rectangle(this.shape(element, "rect.shape"), box.x, box.y, box.width, box.height, 1.5);
    if (this.near <= -2) return;
    if (!wide)
      this.labels(element, box, sheet.direction, [
        { text: transition.name, kind: "name" },
        { text: conditionText(transition), kind: "condition" },
      ]);
    const firings = this.marks.firings(flat);
    const x = wide ? box.x + box.width + 5 : box.x - 5;
    const y = box.y + (sheet.direction === "down" ? 5 : -4);
    if (firings)
      this.letters(firings, this.ink.letters(this.classes, element, "text.label.firings"), x, y, wide ? "left" : "right");
  }

  private page(child: number, box: Box): void {
    const { net, folded, selected, flags } = this.scene;
    const { sheet } = this.placed;
    const page = net.page(child);
    const closed = folded(child);
    const element = `element page ${page.layer}${closed ? " folded" : ""}${selected === page.path ? " selected" : ""} ${this.marks.page(child)}`;
    if (closed) this.foldedPage(element, page.name, box, sheet.grid ? "right" : sheet.direction);
    else this.openPage(element, child, box);
    const flag = flags.get(page.path);
    if (flag)
      this.batches.circle(
        this.shape(element, `circle.flag.${flag}`),
        box.x + box.width - (closed ? 4 : 14),
        box.y + (closed ? 4 : 11),
        4.5,
      );
  }

  private foldedPage(element: string, name: string, box: Box, direction: "down" | "right"): void {
    const [cx, cy] = [box.x + box.width / 2, box.y + box.height / 2];
    this.batches.circle(this.shape(element, "circle.shape"), cx, cy, foldedPage / 2);
    if (this.far) return;
    this.batches.circle(this.shape(element, "circle.ring"), cx, cy, foldedPage / 2 - 4);
    this.batches.circle(this.shape(element, "circle.token.inside"), cx, cy, 6);
    this.labels(element, box, direction, [{ text: name, kind: "name" }]);
  }

  private openPage(element: string, child: number, box: Box): void {
    const { x, y, width, height } = box;
    if (this.bare) {
      const ink = this.shape(element, "rect.shape.bare");
      let thin = this.thin.get(ink);
      if (!thin) this.thin.set(ink, (thin = { ...ink, width: bareLine / this.at }));
      return this.batches.rectangle(thin, x, y, width, height, 16);
    }
    this.batches.rectangle(this.shape(element, "rect.shape"), x, y, width, height, 16);
    this.batches.rectangle(this.shape(element, "rect.ring"), x + 3.5, y + 3.5, width - 7, height - 7, 13);
    const page = this.scene.net.page(child);
    if (!this.open.has(child)) return this.closedName(element, child, box);
    const ink = (kind: string) => this.ink.letters(this.classes, element, `text.label.${kind}`);
    this.letters(pageName(page), ink("frame-name"), x + 14, y + header - 6, "left");
    this.letters(this.marks.running(child), ink("running"), x + width - 26, y + header - 6, "right");
  }

  private closedName(element: string, child: number, box: Box): void {
    const page = this.scene.net.page(child);
    const { x, y, lines, cuts, size, more, layerAt, runningAt } = nameIn(pageName(page), box);
    const ink = (kind: string) => this.ink.letters(this.classes, element, `g.closed-name text.label.${kind}`);
    const [cx, cy] = [box.x + x, box.y + y];
    const large = ink("large");
    const letters = Math.max(size * large.k, Math.min(10 / this.at, size * more * large.k));
    for (const { text, shift } of lines) this.letters(text, large, cx, cy + shift * letters, "center", size, more);
    const cut = cuts.find(({ from, to }) => this.at > from && this.at < to);
    if (cut) this.batches.text(cut.text, ink("cut"), 10 / this.at, cx, cy, "center", true);
    this.letters(page.layer, ink("layer"), cx, box.y + layerAt, "center", layerSize(size));
    this.letters(this.marks.running(child), ink("running"), cx, box.y + runningAt, "center", runningSize(size));
  }

  private shape(element: string, part: string) {
    return this.ink.shape(this.classes, element, part);
  }
}
