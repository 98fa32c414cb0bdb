/** The hierarchical net as the server sends it, and the relations in it. No React here. */

import { FoldedElements, joined, type List, type Names } from "./folded_net";
import type { FlatPlace, FlatTransition, FoldedNet, Page, Span } from "./net_json";

export type {
  Condition,
  FlatArc,
  FlatPlace,
  FlatTransition,
  FoldedNet,
  Layer,
  Operation,
  Page,
  PageNode,
  Span,
} from "./net_json";
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

/**
 * The net with the relations in it: by path, and from drawn elements to flat ones and back. A large net opens
 * without a pass over all of it: an element is made at its first use.
 */
export class NetModel {
  readonly pages: List<Page>;
  readonly places: List<FlatPlace>;
  readonly transitions: List<FlatTransition>;
  /** Page index by path; the system is "". */
  readonly pageByPath: Names;
  readonly placeByName: Names;
  readonly transitionByName: Names;
  readonly elements: FoldedElements;
  private readonly flatPlacesOf = new Map<number, Int32Array>();
  private readonly flatTransitionsOf = new Map<number, Int32Array>();

  constructor(
    net: FoldedNet,
    /** Its hash, if known. */
    readonly hash = "",
    /** The specification that it was made of. */
    readonly text = "",
  ) {
    this.elements = new FoldedElements(net);
    ({
      pages: this.pages,
      places: this.places,
      transitions: this.transitions,
      pageByPath: this.pageByPath,
      placeByName: this.placeByName,
      transitionByName: this.transitionByName,
    } = this.elements);
  }

  /** The flat place behind each node of a page; -1: a page. */
  flatPlaces(index: number): Int32Array {
    let known = this.flatPlacesOf.get(index);
    if (!known) this.flatPlacesOf.set(index, (known = this.elements.drawnPlaces(index)));
    return known;
  }

  /** The flat transition behind each bar of a page. */
  flatTransitions(index: number): Int32Array {
    let known = this.flatTransitionsOf.get(index);
    if (!known) this.flatTransitionsOf.set(index, (known = this.elements.drawnTransitions(index)));
    return known;
  }

  /** Whether data that was made for the net with that hash belongs to this one. */
  isNamed(hash: string | null | undefined): boolean {
    return !hash || !this.hash || hash === this.hash;
  }

  page(index: number): Page {
    return this.pages.at(index)!;
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
    if (flat !== undefined && flat >= this.elements.firstFused) return this.elements.firstPageWith(flat);
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
      const flat = this.places.at(this.flatPlaces(index)[at]!);
      return {
        path: flat?.name ?? joined(page.path, node.name),
        kind: "place",
        page: index,
        index: at,
        span: flat?.span ?? page.span,
      };
    });
    const bars = page.transitions.map((t, at): Element => ({
      path: joined(page.path, t.name),
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

  /** The name of that behaviour, with the groups around it: "charge.ask". */
  behaviourName(page: number | null): string | undefined {
    const own = this.behaviourOf(page);
    if (!own) return undefined;
    let name = own.name;
    for (let at = own.parent; at !== null; at = this.page(at).parent) {
      const { parent, layer } = this.page(at);
      // The page of a group is of the layer of subsystems, and stands in one of it.
      if (layer !== "subsystem" || parent === null || this.page(parent).layer !== "subsystem") break;
      name = `${this.page(at).name}.${name}`;
    }
    return name;
  }

  /** The subsystem pages, in the order of the specification. */
  subsystemPages(): number[] {
    return this.elements.subsystemPages();
  }
}
