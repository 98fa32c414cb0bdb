declare module "elkjs/lib/elk-api.js" {
  export default class Elk {
    constructor(options: { workerFactory: () => Worker });
    layout(graph: unknown): Promise<unknown>;
  }
}
declare module "*.css";
