import type { ElkNode } from "../model/net/layout";

/** ELK in a separate worker, loaded when the first page needs it. */
let ready: Promise<{ layout: (graph: unknown) => Promise<unknown> }> | undefined;

export async function elk(graph: ElkNode): Promise<ElkNode> {
  ready ??= (async () => {
    const [{ default: Elk }, { default: address }] = await Promise.all([
      import("elkjs/lib/elk-api.js"),
      import("elkjs/lib/elk-worker.min.js?url"),
    ]);
    return new Elk({ workerFactory: () => new Worker(address) });
  })();
  return (await (await ready).layout(graph)) as ElkNode;
}
