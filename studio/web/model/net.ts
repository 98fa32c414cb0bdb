/** The hierarchical net as `tessera show --json` writes it, and an index over it. No React here. */

import type { FlatPlace, FlatTransition, NetJson, Page, PageNode, Span } from "./net_json";

export type { Condition, FlatArc, FlatPlace, FlatTransition, Layer, NetJson, Operation, Page, PageNode, Span } from "./net_json";
export type { PageTransition } from "./net_json";

/** An element that can be searched, selected and flown to. */
export interface Element {
  path: string;
  kind: "page" | "place" | "transition";
  page: number;
  /** Index within the page's nodes or transitions; for a page, within its parent (-1: the root). */
  index: number;
  span: Span;
}

const join = (path: string, name: string) => (path ? `${path}.${name}` : name);

/**
 * The elements of a list by page, without a list per page: the last one of each page, and for
 * each element the one before.
 */
class ByPage {
  private readonly last: Int32Array;
  private readonly before: Int32Array;

  constructor(all: readonly { page: number | null }[], pages: number) {
    this.last = new Int32Array(pages).fill(-1);
    this.before = new Int32Array(all.length);
    all.forEach(({ page }, index) => {
      if (page === null) return;
      this.before[index] = this.last[page]!;
      this.last[page] = index;
    });
  }

  find(page: number, is: (index: number) => boolean): number {
    for (let at = this.last[page]!; at >= 0; at = this.before[at]!) if (is(at)) return at;
    return -1;
  }
}

const indexByName = (all: readonly { name: string }[]) => new Map(all.map(({ name }, index) => [name, index]));

/**
 * The net with the relations in it: by path, and from drawn elements to flat ones and back. A large net
 * opens without a pass over all of it: data for single views is made when they need it.
 */
export class NetModel {
  readonly pages: Page[];
  readonly places: FlatPlace[];
  readonly transitions: FlatTransition[];
  private paths: Map<string, number> | undefined;
  private placeNames: Map<string, number> | undefined;
  private transitionNames: Map<string, number> | undefined;
  private fused: Map<string, number> | undefined;
  private placesByPage: ByPage | undefined;
  private transitionsByPage: ByPage | undefined;
  private readonly flatPlacesOf = new Map<number, Int32Array>();
  private readonly flatTransitionsOf = new Map<number, Int32Array>();

  constructor(
    readonly json: NetJson,
    /** Its hash, if known. */
    readonly hash = "",
  ) {
    this.pages = json.pages;
    this.places = json.flat.places;
    this.transitions = json.flat.transitions;
  }

  /** Page index by path; the system is "". */
  get pageByPath(): ReadonlyMap<string, number> {
    return (this.paths ??= new Map(this.pages.map(({ path }, index) => [path, index])));
  }
  get placeByName(): ReadonlyMap<string, number> {
    return (this.placeNames ??= indexByName(this.places));
  }
  get transitionByName(): ReadonlyMap<string, number> {
    return (this.transitionNames ??= indexByName(this.transitions));
  }

  /** The flat place behind each node of a page; -1: a page. */
  flatPlaces(index: number): Int32Array {
    let known = this.flatPlacesOf.get(index);
    if (!known) {
      const page = this.page(index);
      known = Int32Array.from(page.nodes, (node) => this.flatPlace(index, page, node));
      this.flatPlacesOf.set(index, known);
    }
    return known;
  }

  /** The flat transition behind each bar of a page. */
  flatTransitions(index: number): Int32Array {
    let known = this.flatTransitionsOf.get(index);
    if (!known) {
      const of = (this.transitionsByPage ??= new ByPage(this.transitions, this.pages.length));
      const { path, transitions } = this.page(index);
      known = Int32Array.from(transitions, ({ name }) => {
        const whole = join(path, name);
        return of.find(index, (at) => this.transitions[at]!.name === whole);
      });
      this.flatTransitionsOf.set(index, known);
    }
    return known;
  }

  private flatPlace(index: number, page: Page, node: PageNode): number {
    if (node.page !== null) return -1;
    if (node.fusion !== null) return this.fusedPlaces.get(this.json.fusions[node.fusion]!.name) ?? -1;
    const of = (this.placesByPage ??= new ByPage(this.places, this.pages.length));
    const name = join(page.path, node.name);
    return of.find(index, (at) => this.places[at]!.name === name);
  }

  /** Places that belong to no page, by name. */
  private get fusedPlaces(): ReadonlyMap<string, number> {
    return (this.fused ??= new Map(
      this.places.flatMap(({ name, page }, index) => (page === null ? [[name, index] as const] : [])),
    ));
  }

  /** Whether data that was made for the net with that hash belongs to this one. */
  isNamed(hash: string | null | undefined): boolean {
    return !hash || !this.hash || hash === this.hash;
  }

  page(index: number): Page {
    return this.pages[index]!;
  }

  /** Pages inside a page, in the order of drawing. */
  children(index: number): number[] {
    return this.page(index).nodes.flatMap((node) => (node.page === null ? [] : [node.page]));
  }

  /** The pages from the system down to the page. */
  ancestry(index: number): number[] {
    const chain: number[] = [];
    for (let at: number | null = index; at !== null; at = this.page(at).parent) chain.unshift(at);
    return chain;
  }

  /**
   * The element with that path, on the page that owns it. A fused place is drawn on several
   * pages; the result is the first.
   */
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
        this.pages.findIndex((_, page) => this.flatPlaces(page).includes(flat)),
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

  /** The elements drawn on one page. */
  elementsOf(index: number): Element[] {
    const page = this.page(index);
    const nodes = page.nodes.map((node, at): Element => {
      if (node.page !== null) {
        const { path, span } = this.page(node.page);
        return { path, kind: "page", page: index, index: at, span };
      }
      const flat = this.places[this.flatPlaces(index)[at]!];
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

  /** The behaviour page that contains the page; null above the behaviours. */
  behaviourOf(page: number | null): Page | null {
    for (let at = page; at !== null; at = this.page(at).parent) if (this.page(at).layer === "behaviour") return this.page(at);
    return null;
  }

  /** The subsystem pages, in the order of the specification. */
  subsystemPages(): number[] {
    return this.pages.flatMap((page, index) => (page.layer === "subsystem" ? [index] : []));
  }
}
