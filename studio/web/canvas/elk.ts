import type { ElkNode } from "../model/net/layout";

/** ELK in a separate worker, loaded when the first page needs it. */
let ready: Promise<{ layout: (graph: unknown) => Promise<unknown> }> | undefined;

/** Loads ELK before the first drawing needs it: that takes longer than most layouts. */
export function warmElk(): Promise<unknown> {
  return (ready ??= (async () => {
    const [{ default: Elk }, { default: address }] = await Promise.all([
      import("elkjs/lib/elk-api.js"),
      import("elkjs/lib/elk-worker.min.js?url"),
    ]);
    return new Elk({ workerFactory: () => new Worker(address) });
  })());
}

export async function elk(graph: ElkNode): Promise<ElkNode> {
  void warmElk();
  return (await (await ready!).layout(graph)) as ElkNode;
}
