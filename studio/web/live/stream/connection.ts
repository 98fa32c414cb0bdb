import { Api, ApiError } from "../api";
import type { Events } from "../../model/protocol";
import { Store } from "../store";
import { openStream, type Stream } from "./stream";

export interface ConnectionState {
  /** refused: the token is not that of the server (it was restarted). */
  state: "connecting" | "open" | "lost" | "refused";
  attempt: number;
}
type Handler = (data: never) => void;

/** The event stream, which all tabs of a browser share. It is opened again whenever it breaks. */
export class Connection {
  readonly store = new Store<ConnectionState>({ state: "connecting", attempt: 0 });
  private readonly handlers = new Map<string, Set<Handler>>();
  private stream: Stream | undefined;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly api: Api) {}

  on<Name extends keyof Events>(name: Name, handler: (data: Events[Name]) => void): void {
    const set = this.handlers.get(name) ?? new Set();
    set.add(handler as Handler);
    this.handlers.set(name, set);
  }

  /** Another tab knows the key of the server that runs now. This one connects with it as soon as its own is refused. */
  openWith(token: string): void {
    this.api.token = token;
    if (this.store.get().state === "refused") this.open();
  }

  open(): void {
    clearTimeout(this.timer);
    this.stream?.close();
    this.stream = openStream(this.api.eventsAddress(), {
      opened: () => this.store.set({ state: "open", attempt: 0 }),
      broken: () => void this.broken(),
      event: (name, data) => {
        const parsed = JSON.parse(data) as never;
        this.handlers.get(name)?.forEach((handler) => handler(parsed));
      },
    });
  }

  /** A broken stream gives no reason; a plain request does. */
  private async broken(): Promise<void> {
    this.stream?.close();
    const attempt = this.store.get().attempt + 1;
    this.store.set({ state: "lost", attempt });
    const { token } = this.api;
    try {
      await this.api.project();
    } catch (error) {
      // Another tab may have told the new key while the old one was refused.
      if (error instanceof ApiError && error.status === 401 && token === this.api.token) {
        this.store.set({ state: "refused" });
        return;
      }
    }
    this.timer = setTimeout(() => this.open(), Math.min(3000, 250 * 2 ** Math.min(attempt, 4)));
  }
}
