/** The hierarchical net as `tessera show --json` writes it, and an index over it. No React here. */

export type Layer = "system" | "agent" | "subsystem" | "behaviour" | "communication";

export interface Span {
  line: number;
  column: number;
  length: number;
}
export interface Operation {
  kind: "transition_function" | "next_iteration" | "write" | "read";
  subject: number | null;
}
export interface Condition {
  kind: "go_on" | "terminal" | "error" | "next" | "elapsed";
  truth: "free" | "always" | "never";
  subject: number | null;
  text: string;
}
export interface PageNode {
  name: string;
  page: number | null;
  fusion: number | null;
  tokens: number;
  operation: Operation | null;
}
export interface PageTransition {
  name: string;
  inputs: number[];
  outputs: number[];
  condition: Condition | null;
  span: Span;
}
export interface Page {
  path: string;
  name: string;
  layer: Layer;
  parent: number | null;
  subsystem: number | null;
  input: number;
  output: number;
  span: Span;
  nodes: PageNode[];
  transitions: PageTransition[];
}
export interface FlatArc {
  place: number;
  weight: number;
}
export interface FlatPlace {
  name: string;
  tokens: number;
  operation: Operation | null;
  layer: Layer;
  page: number | null;
  subsystem: number | null;
  channel: number | null;
  span: Span;
}
export interface FlatTransition {
  name: string;
  inputs: FlatArc[];
  outputs: FlatArc[];
  condition: Condition | null;
  layer: Layer;
  page: number | null;
  subsystem: number | null;
  span: Span;
}
export interface NetJson {
  pages: Page[];
  fusions: { name: string; tokens: number; channel: number | null; span: Span }[];
  flat: { places: FlatPlace[]; transitions: FlatTransition[] };
}

/** One thing that can be looked for, selected and flown to. */
export interface Element {
  path: string;
  kind: "page" | "place" | "transition";
  page: number;
  /** Index within the page's nodes or transitions; of a page: within its parent (-1: the root). */
  index: number;
  span: Span;
}

const join = (path: string, name: string) => (path ? `${path}.${name}` : name);

/** The net with the ways through it: by path, from drawn elements to flat ones and back. */
export class NetModel {
  readonly pages: Page[];
  readonly places: FlatPlace[];
  readonly transitions: FlatTransition[];
  /** Page index by path; the system is "". */
  readonly pageByPath = new Map<string, number>();
  readonly placeByName = new Map<string, number>();
  readonly transitionByName = new Map<string, number>();
  /** For each page, the flat place behind each node (-1: a page), and the flat transition behind each bar. */
  readonly flatPlaces: Int32Array[];
  readonly flatTransitions: Int32Array[];
  /** Transitions that consume from a place. */
  readonly consumers: number[][];

  constructor(
    readonly json: NetJson,
    /** Its name among nets, where one is known. */
    readonly hash = "",
  ) {
    this.pages = json.pages;
    this.places = json.flat.places;
    this.transitions = json.flat.transitions;
    this.pages.forEach((page, index) => this.pageByPath.set(page.path, index));
    this.places.forEach((place, index) => this.placeByName.set(place.name, index));
    this.transitions.forEach((transition, index) => this.transitionByName.set(transition.name, index));
    this.flatPlaces = this.pages.map((page) => Int32Array.from(page.nodes, (node) => this.flatPlace(page, node)));
    this.flatTransitions = this.pages.map((page) =>
      Int32Array.from(page.transitions, (t) => this.transitionByName.get(join(page.path, t.name)) ?? -1),
    );
    this.consumers = this.places.map(() => []);
    this.transitions.forEach((t, index) => t.inputs.forEach((arc) => this.consumers[arc.place]?.push(index)));
  }

  private flatPlace(page: Page, node: PageNode): number {
    if (node.page !== null) return -1;
    const name = node.fusion !== null ? this.json.fusions[node.fusion]!.name : join(page.path, node.name);
    return this.placeByName.get(name) ?? -1;
  }

  /** Whether something that was made of the net of that name belongs to this one. */
  isNamed(hash: string | null | undefined): boolean {
    return !hash || !this.hash || hash === this.hash;
  }

  page(index: number): Page {
    return this.pages[index]!;
  }

  /** Pages drawn inside a page, in drawing order. */
  children(index: number): number[] {
    return this.page(index).nodes.flatMap((node) => (node.page === null ? [] : [node.page]));
  }

  /** From the system down to the page. */
  ancestry(index: number): number[] {
    const chain: number[] = [];
    for (let at: number | null = index; at !== null; at = this.page(at).parent) chain.unshift(at);
    return chain;
  }

  /** The element with that path, drawn on the page that owns it. A fused place is drawn on several; the first is meant. */
  find(path: string): Element | undefined {
    const page = this.pageByPath.get(path);
    if (page !== undefined) return this.pageElement(page);
    return this.elementsOf(this.ownerOf(path)).find((element) => element.path === path);
  }

  private ownerOf(path: string): number {
    const flat = this.placeByName.get(path);
    if (flat !== undefined && this.places[flat]!.page === null)
      return Math.max(
        0,
        this.flatPlaces.findIndex((places) => places.includes(flat)),
      );
    for (let end = path.length; end > 0; end = path.lastIndexOf(".", end - 1)) {
      const page = this.pageByPath.get(path.slice(0, end));
      if (page !== undefined) return page;
    }
    return 0;
  }

  pageElement(index: number): Element {
    const { parent, path, span } = this.page(index);
    const at = parent === null ? -1 : this.page(parent).nodes.findIndex((node) => node.page === index);
    return { path, kind: "page", page: parent ?? 0, index: at, span };
  }

  /** What is drawn on one page. */
  elementsOf(index: number): Element[] {
    const page = this.page(index);
    const nodes = page.nodes.map((node, at): Element => {
      if (node.page !== null) return this.pageElement(node.page);
      const flat = this.places[this.flatPlaces[index]![at]!];
      return {
        path: flat?.name ?? join(page.path, node.name),
        kind: "place",
        page: index,
        index: at,
        span: flat?.span ?? page.span,
      };
    });
    const bars = page.transitions.map((t, at): Element => ({
      path: join(page.path, t.name),
      kind: "transition",
      page: index,
      index: at,
      span: t.span,
    }));
    return [...nodes, ...bars];
  }

  /** The behaviour page that each page lies in, or null above the behaviours. */
  behaviourOf(page: number | null): Page | null {
    for (let at = page; at !== null; at = this.page(at).parent) if (this.page(at).layer === "behaviour") return this.page(at);
    return null;
  }

  /** The subsystem pages, in the order of the specification. */
  subsystemPages(): number[] {
    return this.pages.flatMap((page, index) => (page.layer === "subsystem" ? [index] : []));
  }
}
