import type { Elk, ElkNode } from "../net/layout";

/** Layouts of graphs by their texts. An edit changes few of them, and many subsystems are equal but for their paths. */
const known = new WeakMap<Elk, Map<string, string>>();
const most = 500;
/** Stands for the identifier of a graph; no name has it. */
const mark = "@";

/** A text of a graph that is equal for equal graphs. The identifiers in it begin with that of the graph. */
const general = (graph: ElkNode, id = graph.id) => JSON.stringify(graph).replaceAll(`"${id}`, `"${mark}`);
const special = (text: string, id: string) => JSON.parse(text.replaceAll(`"${mark}`, `"${id}`)) as ElkNode;

/** Lays out graphs that have nothing to do with each other, and those only that are not known yet. */
export async function laidOutEach(
  elk: Elk,
  graphs: readonly ElkNode[],
  options: Record<string, string>,
): Promise<Map<string, ElkNode>> {
  const layouts = known.get(elk) ?? new Map<string, string>();
  known.set(elk, layouts);
  const keys = graphs.map((graph) => general(graph));
  const fresh = new Map(graphs.flatMap((graph, at) => (layouts.has(keys[at]!) ? [] : [[keys[at]!, graph] as const])));
  if (fresh.size > 0) {
    const root = await elk({ id: "all", layoutOptions: options, children: [...fresh.values()] });
    const laidOut = new Map((root.children ?? []).map((one) => [one.id, one]));
    for (const [key, { id }] of fresh) layouts.set(key, general(laidOut.get(id)!));
  }
  const found = new Map(graphs.map(({ id }, at) => [id, special(layouts.get(keys[at]!)!, id)]));
  for (const key of layouts.keys()) {
    if (layouts.size <= most) break;
    layouts.delete(key);
  }
  return found;
}
