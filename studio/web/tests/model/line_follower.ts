import Elk from "elkjs/lib/elk.bundled.js";
import type { ElkNode } from "../../model/net/layout";
import { NetModel, type FoldedNet } from "../../model/net/net";
import json from "./line_follower.json";

/** The example 01_line_follower in the form of the server. */
export const lineFollower = () => new NetModel(json as unknown as FoldedNet);

const engine = new Elk();
export const elk = (graph: ElkNode) => engine.layout(graph as never) as unknown as Promise<ElkNode>;
