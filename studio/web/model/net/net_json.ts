// Made by scripts/protocol.mjs of share/tessera/net.schema.json: change that, and run `npm run protocol`.

export type Layer = "system" | "agent" | "subsystem" | "behaviour" | "communication";

/**
 * A hierarchical net and the flat net made of it, as `tessera show --json` writes them. Numbers are indices of
 * the lists: `page` of `pages`, `place` of `flat.places`, and so on; null: none.
 */
export interface NetJson {
  /** The first is the system. */
  pages: Page[];
  /** Sets of nodes that are one place. */
  fusions: Fusion[];
  flat: { places: FlatPlace[]; transitions: FlatTransition[] };
  counts: Counts;
}
export interface Page {
  path: string;
  name: string;
  layer: Layer;
  parent: number | null;
  subsystem: number | null;
  /** The node that takes the token. */
  input: number;
  /** The node that gives it back. */
  output: number;
  span: Span;
  nodes: PageNode[];
  transitions: PageTransition[];
}
/** The origin of an element. */
export interface Span {
  /** In the specification, from 1; 0: none. */
  line: number;
  column: number;
  length: number;
  /** A line of an included file, such as parts/docking.yaml:3; line is 0 then. */
  included?: string;
}
/** A place, or the page behind a node. */
export interface PageNode {
  name: string;
  page: number | null;
  fusion: number | null;
  tokens: number;
  operation: Operation | null;
}
/** The operation that a token starts in a place. */
export interface Operation {
  kind: "transition_function" | "next_iteration" | "write" | "read";
  subject: number | null;
}
export interface PageTransition {
  name: string;
  /** Nodes of the page. */
  inputs: number[];
  outputs: number[];
  condition: Condition | null;
  /** Its role in the five layers; null: none. */
  role:
    | "start_system"
    | "end_system"
    | "start_agent"
    | "end_agent"
    | "start"
    | "leave"
    | "begin_group"
    | "leave_group"
    | "begin_sending"
    | "end_sending"
    | "begin_receiving"
    | "end_receiving"
    | "go_on"
    | "terminal"
    | "error"
    | "page"
    | "transfer"
    | "overwrite"
    | "skip"
    | "timeout"
    | "deliver"
    | "replace"
    | "deliver_older"
    | "lose_older"
    | null;
  span: Span;
}
/** The condition of a transition. */
export interface Condition {
  kind: "go_on" | "terminal" | "error" | "next" | "elapsed" | "send" | "skip";
  truth: "free" | "always" | "never";
  /** The truth where transition functions may fail. */
  truth_with_failures: "free" | "always" | "never";
  subject: number | null;
  text: string;
}
export interface Fusion {
  name: string;
  tokens: number;
  channel: number | null;
  span: Span;
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
export interface FlatArc {
  place: number;
  weight: number;
}
export interface Counts {
  flat: {
    places: number;
    /** Places that stand for a fusion set. */
    fused: number;
    transitions: number;
    arcs: number;
  };
  layers: { system: LayerCounts; agent: LayerCounts; subsystem: LayerCounts; behaviour: LayerCounts; communication: LayerCounts };
}
export interface LayerCounts {
  places: number;
  transitions: number;
  pages: number;
}
/**
 * The same net with each kind of agent written once, as the studio sends it. The numbers of an agent's pages,
 * places and transitions follow those of the agent before; the system's own come first, the places of channels
 * last.
 */
export interface FoldedNet {
  system: NetPart;
  shapes: Shape[];
  agents: FoldedAgent[];
  /** The places of a channel, named without it; `channel` is 0. */
  memories: FlatPlace[][];
  channels: FoldedChannel[];
}
/**
 * The system's own page, places and transitions. Numbers are those of the whole net; `fusion` of a node is the
 * number of its place.
 */
export interface NetPart {
  pages: Page[];
  places: FlatPlace[];
  transitions: FlatTransition[];
}
/**
 * The contents of equal agents. Names are without the agent's; numbers count from the first one of the agent. A
 * place beyond `places` (also as `fusion` of a node) is one of `memory`. A channel is one of the agent's.
 */
export interface Shape {
  pages: Page[];
  places: FlatPlace[];
  transitions: FlatTransition[];
  /** Their number. */
  subsystems: number;
  /** The agent's channel, and which of its places. */
  memory: [number, number][];
}
export interface FoldedAgent {
  name: string;
  shape: number;
  channels: number[];
}
export interface FoldedChannel {
  name: string;
  /** One of `memories`. */
  memory: number;
}
