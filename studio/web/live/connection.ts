import { Api, ApiError } from "./api";
import type { Events } from "./protocol";
import { Store } from "./store";

export interface ConnectionState {
  /** refused: the token is not that of the server (it was restarted). */
  state: "connecting" | "open" | "lost" | "refused";
  attempt: number;
}
type Handler = (data: never) => void;
const listened: Record<keyof Events, true> = {
  hello: true,
  spec: true,
  verify: true,
  build: true,
  log: true,
  run: true,
  firings: true,
  values: true,
  arrays: true,
  pose: true,
  scene: true,
  poses: true,
  subsystems: true,
  deployment: true,
  parameters: true,
};

/** The event stream. It is opened again whenever it breaks. */
export class Connection {
  readonly store = new Store<ConnectionState>({ state: "connecting", attempt: 0 });
  private readonly handlers = new Map<string, Set<Handler>>();
  private source: EventSource | undefined;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly api: Api) {}

  on<Name extends keyof Events>(name: Name, handler: (data: Events[Name]) => void): void {
    const set = this.handlers.get(name) ?? new Set();
    set.add(handler as Handler);
    this.handlers.set(name, set);
  }

  /** Connects with another key after the current one was refused. */
  openWith(token: string): void {
    if (this.store.get().state !== "refused") return;
    this.api.token = token;
    this.open();
  }

  open(): void {
    clearTimeout(this.timer);
    this.source?.close();
    const source = new EventSource(this.api.eventsAddress());
    this.source = source;
    source.onopen = () => this.store.set({ state: "open", attempt: 0 });
    source.onerror = () => void this.broken();
    for (const name of Object.keys(listened))
      source.addEventListener(name, (event) => {
        const data = JSON.parse((event as MessageEvent<string>).data) as never;
        this.handlers.get(name)?.forEach((handler) => handler(data));
      });
  }

  /** A broken stream gives no reason; a plain request does. */
  private async broken(): Promise<void> {
    this.source?.close();
    const attempt = this.store.get().attempt + 1;
    this.store.set({ state: "lost", attempt });
    try {
      await this.api.project();
    } catch (error) {
      if (error instanceof ApiError && error.status === 401) {
        this.store.set({ state: "refused" });
        return;
      }
    }
    this.timer = setTimeout(() => this.open(), Math.min(3000, 250 * 2 ** Math.min(attempt, 4)));
  }
}
