import type { FlatPlace, FlatTransition, FoldedNet, Operation, Page, Shape } from "./net_json";

/** A list whose elements are made at their first use. */
export class List<T> implements Iterable<T> {
  private readonly made = new Map<number, T>();

  constructor(
    readonly length: number,
    private readonly make: (index: number) => T,
  ) {}

  at(index: number): T | undefined {
    if (!(index >= 0 && index < this.length)) return undefined;
    let one = this.made.get(index);
    if (one === undefined) this.made.set(index, (one = this.make(index)));
    return one;
  }

  *[Symbol.iterator](): Iterator<T> {
    for (let index = 0; index < this.length; index += 1) yield this.at(index)!;
  }
}

/** Finds elements by their names. */
export interface Names {
  get(name: string): number | undefined;
  has(name: string): boolean;
}

export const joined = (path: string, name: string) => (path && name ? `${path}.${name}` : path || name);

const byName = (all: readonly { name: string }[]) => new Map(all.map(({ name }, index) => [name, index]));

/** A shape, with its frequently used parts. */
class Kind {
  readonly pages: ReadonlyMap<string, number>;
  readonly places: ReadonlyMap<string, number>;
  readonly transitions: ReadonlyMap<string, number>;
  /** All input arcs in a row: place, weight; and for each transition the begin of its arcs. */
  readonly inputs: Int32Array;
  readonly begins: Int32Array;
  readonly marked: readonly [number, number][];
  readonly subsystemPages: readonly number[];
  private readonly drawn = new Map<number, Int32Array>();

  constructor(readonly shape: Shape) {
    this.pages = new Map(shape.pages.map(({ path }, index) => [path, index]));
    this.places = byName(shape.places);
    this.transitions = byName(shape.transitions);
    this.marked = shape.places.flatMap(({ tokens }, index) => (tokens > 0 ? [[index, tokens] as [number, number]] : []));
    // The page of a group of behaviours is of that layer, too, and stands in one of it.
    const isSubsystem = ({ layer, parent }: Shape["pages"][number]) =>
      layer === "subsystem" && (parent === null || shape.pages[parent]!.layer !== "subsystem");
    this.subsystemPages = shape.pages.flatMap((page, index) => (isSubsystem(page) ? [index] : []));
    this.inputs = Int32Array.from(
      shape.transitions.flatMap(({ inputs }) => inputs.flatMap(({ place, weight }) => [place, weight])),
    );
    this.begins = new Int32Array(shape.transitions.length + 1);
    shape.transitions.forEach(({ inputs }, at) => (this.begins[at + 1] = this.begins[at]! + 2 * inputs.length));
  }

  /** The place behind each node of a page; -1: a page. */
  drawnPlaces(page: number): Int32Array {
    let known = this.drawn.get(page);
    if (!known) {
      const { path, nodes } = this.shape.pages[page]!;
      known = Int32Array.from(nodes, (node) =>
        node.page !== null ? -1 : (node.fusion ?? this.places.get(joined(path, node.name)) ?? -1),
      );
      this.drawn.set(page, known);
    }
    return known;
  }
}

/**
 * The elements of a net whose agents come folded: equal agents share one shape. An element of an agent is
 * made from its shape at its first use, so a net of ten thousand agents opens as fast as one of ten.
 */
export class FoldedElements {
  readonly pages: List<Page>;
  readonly places: List<FlatPlace>;
  readonly transitions: List<FlatTransition>;
  /** The number of the first place of a channel; the others follow until the end. */
  readonly firstFused: number;
  readonly pageByPath: Names;
  readonly placeByName: Names;
  readonly transitionByName: Names;
  private readonly kinds: readonly Kind[];
  private readonly kindOf: readonly Kind[];
  /** For each agent and for the end, the numbers of its first elements. */
  private readonly firsts: Record<"pages" | "places" | "transitions" | "subsystems", Int32Array>;
  /** The first place of each channel. */
  private readonly memories: Int32Array;
  private known: { agents?: ReadonlyMap<string, number>; channels?: ReadonlyMap<string, number> } = {};

  constructor(private readonly net: FoldedNet) {
    const { system, agents, channels } = net;
    this.kinds = net.shapes.map((shape) => new Kind(shape));
    this.kindOf = agents.map(({ shape }) => this.kinds[shape]!);
    const following = (before: number, size: (shape: Shape) => number) => {
      const firsts = new Int32Array(agents.length + 1);
      firsts[0] = before;
      this.kindOf.forEach(({ shape }, agent) => (firsts[agent + 1] = firsts[agent]! + size(shape)));
      return firsts;
    };
    this.firsts = {
      pages: following(system.pages.length, ({ pages }) => pages.length),
      places: following(system.places.length, ({ places }) => places.length),
      transitions: following(system.transitions.length, ({ transitions }) => transitions.length),
      subsystems: following(0, ({ subsystems }) => subsystems),
    };
    this.firstFused = this.firsts.places.at(-1)!;
    this.memories = new Int32Array(channels.length + 1);
    this.memories[0] = this.firstFused;
    channels.forEach(({ memory }, at) => (this.memories[at + 1] = this.memories[at]! + net.memories[memory]!.length));
    this.pages = new List(this.firsts.pages.at(-1)!, (index) => this.makePage(index));
    this.places = new List(this.memories.at(-1)!, (index) => this.makePlace(index));
    this.transitions = new List(this.firsts.transitions.at(-1)!, (index) => this.makeTransition(index));
    this.pageByPath = this.names("pages", new Map([["", 0]]));
    this.placeByName = this.names("places", byName(system.places), (name) => this.fusedPlace(name));
    this.transitionByName = this.names("transitions", byName(system.transitions));
  }

  get agents(): FoldedNet["agents"] {
    return this.net.agents;
  }

  // ------------------------------------------------------------------------------------------ elements

  /** The agent that has the element; -1: the system. */
  private agentAt(firsts: Int32Array, index: number): number {
    let [low, high] = [-1, firsts.length - 1];
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (firsts[middle]! <= index) low = middle;
      else high = middle;
    }
    return low;
  }

  /** The number of a place that an agent's shape names. */
  private place(agent: number, own: number): number {
    const { places, memory } = this.kindOf[agent]!.shape;
    if (own < places.length) return this.firsts.places[agent]! + own;
    const [channel, at] = memory[own - places.length]!;
    return this.memories[this.net.agents[agent]!.channels[channel]!]! + at;
  }

  private operation(agent: number, operation: Operation | null): Operation | null {
    if (operation === null || operation.subject === null || !/^(read|write)$/.test(operation.kind)) return operation;
    return { ...operation, subject: this.net.agents[agent]!.channels[operation.subject]! };
  }

  private condition<T extends FlatTransition["condition"]>(agent: number, condition: T): T {
    if (condition?.kind !== "elapsed" || condition.subject === null) return condition;
    return { ...condition, subject: this.net.agents[agent]!.channels[condition.subject]! };
  }

  private makePage(index: number): Page {
    const agent = this.agentAt(this.firsts.pages, index);
    if (agent < 0) return this.net.system.pages[index]!;
    const first = this.firsts.pages[agent]!;
    const page = this.kindOf[agent]!.shape.pages[index - first]!;
    const { name } = this.net.agents[agent]!;
    return {
      ...page,
      path: joined(name, page.path),
      name: page.name || name,
      parent: page.parent === null ? 0 : first + page.parent,
      subsystem: page.subsystem === null ? null : this.firsts.subsystems[agent]! + page.subsystem,
      nodes: page.nodes.map((node) => ({
        ...node,
        page: node.page === null ? null : first + node.page,
        fusion: node.fusion === null ? null : this.place(agent, node.fusion),
        operation: this.operation(agent, node.operation),
      })),
      transitions: page.transitions.map((one) => ({ ...one, condition: this.condition(agent, one.condition) })),
    };
  }

  private makePlace(index: number): FlatPlace {
    if (index >= this.firstFused) return this.makeFused(index);
    const agent = this.agentAt(this.firsts.places, index);
    if (agent < 0) return this.net.system.places[index]!;
    const place = this.kindOf[agent]!.shape.places[index - this.firsts.places[agent]!]!;
    return { ...place, ...this.owned(agent, place), operation: this.operation(agent, place.operation) };
  }

  private makeFused(index: number): FlatPlace {
    const channel = this.agentAt(this.memories, index);
    const { name, memory } = this.net.channels[channel]!;
    const place = this.net.memories[memory]![index - this.memories[channel]!]!;
    const operation = place.operation && { ...place.operation, subject: channel };
    return { ...place, name: joined(name, place.name), channel, operation };
  }

  private makeTransition(index: number): FlatTransition {
    const agent = this.agentAt(this.firsts.transitions, index);
    if (agent < 0) return this.net.system.transitions[index]!;
    const transition = this.kindOf[agent]!.shape.transitions[index - this.firsts.transitions[agent]!]!;
    const arcs = (all: FlatTransition["inputs"]) => all.map(({ place, weight }) => ({ place: this.place(agent, place), weight }));
    return {
      ...transition,
      ...this.owned(agent, transition),
      inputs: arcs(transition.inputs),
      outputs: arcs(transition.outputs),
      condition: this.condition(agent, transition.condition),
    };
  }

  private owned(agent: number, one: { name: string; page: number | null; subsystem: number | null }) {
    return {
      name: joined(this.net.agents[agent]!.name, one.name),
      page: one.page === null ? null : this.firsts.pages[agent]! + one.page,
      subsystem: one.subsystem === null ? null : this.firsts.subsystems[agent]! + one.subsystem,
    };
  }

  // --------------------------------------------------------------------------------------------- names

  private names(
    what: "pages" | "places" | "transitions",
    system: ReadonlyMap<string, number>,
    fused: (name: string) => number | undefined = () => undefined,
  ): Names {
    const get = (name: string) => {
      const own = system.get(name);
      if (own !== undefined) return own;
      const cut = name.indexOf(".");
      const agent = this.agentNamed(cut < 0 ? name : name.slice(0, cut));
      const found = agent === undefined ? undefined : this.kindOf[agent]![what].get(cut < 0 ? "" : name.slice(cut + 1));
      return found === undefined ? fused(name) : this.firsts[what][agent!]! + found;
    };
    return { get, has: (name) => get(name) !== undefined };
  }

  private agentNamed(name: string): number | undefined {
    return (this.known.agents ??= byName(this.net.agents)).get(name);
  }

  private fusedPlace(name: string): number | undefined {
    this.known.channels ??= byName(this.net.channels);
    for (let cut = name.lastIndexOf("."); cut > 0; cut = name.lastIndexOf(".", cut - 1)) {
      const channel = this.known.channels.get(name.slice(0, cut));
      if (channel === undefined) continue;
      const at = this.net.memories[this.net.channels[channel]!.memory]!.findIndex((place) => place.name === name.slice(cut + 1));
      return at < 0 ? undefined : this.memories[channel]! + at;
    }
    return undefined;
  }

  // --------------------------------------------------------------------------------- from pages and back

  /** The place behind each node of a page; -1: a page. */
  drawnPlaces(page: number): Int32Array {
    const agent = this.agentAt(this.firsts.pages, page);
    if (agent >= 0) {
      const own = this.kindOf[agent]!.drawnPlaces(page - this.firsts.pages[agent]!);
      return own.map((place) => (place < 0 ? -1 : this.place(agent, place)));
    }
    const { nodes } = this.net.system.pages[page]!;
    return Int32Array.from(nodes, (node) => (node.page !== null ? -1 : (node.fusion ?? this.placeByName.get(node.name) ?? -1)));
  }

  /** The transition behind each bar of a page. */
  drawnTransitions(page: number): Int32Array {
    const { path, transitions } = this.pages.at(page)!;
    return Int32Array.from(transitions, ({ name }) => this.transitionByName.get(joined(path, name)) ?? -1);
  }

  /** The first page that draws a place of a channel. */
  firstPageWith(place: number): number {
    if (this.net.system.pages[0]!.nodes.some(({ fusion }) => fusion === place)) return 0;
    const channel = this.agentAt(this.memories, place);
    const agents = this.net.agents.flatMap(({ channels }, agent) => (channels.includes(channel) ? [agent] : []));
    for (const agent of agents) {
      const [first, end] = [this.firsts.pages[agent]!, this.firsts.pages[agent + 1]!];
      for (let page = first; page < end; page += 1) if (this.drawnPlaces(page).includes(place)) return page;
    }
    return 0;
  }

  /** The subsystems' pages, in the order of the specification. */
  subsystemPages(): number[] {
    return this.kindOf.flatMap(({ subsystemPages }, agent) => subsystemPages.map((page) => this.firsts.pages[agent]! + page));
  }

  /** A page of each kind: those of the system, and of the first agent of each shape. */
  pagesOfEachKind(): number[] {
    const agents = this.kinds.map((kind) => this.kindOf.indexOf(kind));
    const own = this.net.system.pages.map((_, page) => page);
    return [...own, ...agents.flatMap((agent) => this.range("pages", agent))];
  }

  /** The corresponding pages in all agents of its shape. */
  twins(page: number): number[] {
    const agent = this.agentAt(this.firsts.pages, page);
    if (agent < 0) return [page];
    const at = page - this.firsts.pages[agent]!;
    return this.kindOf.flatMap((kind, other) => (kind === this.kindOf[agent] ? [this.firsts.pages[other]! + at] : []));
  }

  /** The numbers of all elements of a kind in an agent; -1: the system's own. */
  range(what: "pages" | "places" | "transitions", agent: number): number[] {
    const [first, end] = [this.firsts[what][agent] ?? 0, this.firsts[what][agent + 1]!];
    return Array.from({ length: end - first }, (_, at) => first + at);
  }

  // --------------------------------------------------------------------------------------------- firing

  initialMarking(): Int32Array {
    const marking = new Int32Array(this.places.length);
    this.net.system.places.forEach(({ tokens }, place) => (marking[place] = tokens));
    this.kindOf.forEach(({ marked }, agent) => {
      for (const [place, tokens] of marked) marking[this.firsts.places[agent]! + place] = tokens;
    });
    this.net.channels.forEach(({ memory }, channel) =>
      this.net.memories[memory]!.forEach(({ tokens }, at) => (marking[this.memories[channel]! + at] = tokens)),
    );
    return marking;
  }

  /** The transitions whose input places hold enough tokens, whatever their conditions. */
  enabled(marking: Int32Array): number[] {
    const found = this.net.system.transitions.flatMap(({ inputs }, at) =>
      inputs.every(({ place, weight }) => marking[place]! >= weight) ? [at] : [],
    );
    this.kindOf.forEach(({ begins, inputs }, agent) => {
      for (let own = 0; own + 1 < begins.length; own += 1) {
        let enough = true;
        for (let at = begins[own]!; enough && at < begins[own + 1]!; at += 2)
          enough = marking[this.place(agent, inputs[at]!)]! >= inputs[at + 1]!;
        if (enough) found.push(this.firsts.transitions[agent]! + own);
      }
    });
    return found;
  }

  /** Transitions whose condition can be true or false, up to that many. */
  free(most: number): number[] {
    const isFree = (index: number) => this.transitions.at(index)!.condition?.truth === "free";
    const found: number[] = [];
    for (let agent = 0; agent < this.kindOf.length && found.length < most; agent += 1)
      found.push(...this.range("transitions", agent).filter(isFree));
    return found.slice(0, most);
  }
}
