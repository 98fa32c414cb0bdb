import type { Api } from "./api";

/** The part of the browser's storage that is used here. */
type Kept = Pick<Storage, "getItem" | "setItem" | "removeItem">;

/** The names under which the server keeps the texts, by the beginnings of the keys in the browser. */
const names = { "tessera.panels": "panels", "tessera.plots": "plots", "tessera.operate.values": "values" };
type Name = (typeof names)[keyof typeof names];
const nameOf = (key: string): Name | undefined => Object.entries(names).find(([start]) => key.startsWith(start))?.[1];

const unsent = (key: string) => `tessera.unsent ${key}`;

/**
 * How the user has arranged the page for this project. A browser keeps it for one port only, and the next server may have
 * another: so the server keeps it, too. Without a server that does, it is kept in the browser alone.
 */
export class Arrangement {
  private entries: Readonly<Record<string, string>> = {};
  private readonly waiting = new Map<string, string>();
  private sending = false;

  constructor(
    private readonly api: Pick<Api, "arrangement" | "arrange">,
    private readonly storage: Kept | null = globalThis.localStorage ?? null,
  ) {}

  /** Asks the server for what it has kept. An answer that does not come changes nothing. */
  async load(): Promise<void> {
    try {
      this.entries = (await this.api.arrangement()).entries;
    } catch {
      // The connection reports a server that is gone.
    }
  }

  getItem(key: string): string | null {
    const name = nameOf(key);
    // A page that was closed at once may not have told the server its last change.
    const isNewer = this.storage?.getItem(unsent(key)) != null;
    return (isNewer || name === undefined ? undefined : this.entries[name]) ?? this.storage?.getItem(key) ?? null;
  }

  /** Throws if the browser keeps nothing, as its storage does. The server is told all the same. */
  setItem(key: string, text: string): void {
    const name = nameOf(key);
    if (name !== undefined) {
      this.entries = { ...this.entries, [name]: text };
      this.waiting.set(key, text);
      void this.send();
    }
    this.storage?.setItem(key, text);
    if (name !== undefined) this.storage?.setItem(unsent(key), "1");
  }

  /** The last one of several texts under one key is sent. */
  private async send(): Promise<void> {
    if (this.sending) return;
    this.sending = true;
    for (let next = first(this.waiting); next; next = first(this.waiting)) {
      const [key, text] = next;
      this.waiting.delete(key);
      try {
        const { kept } = await this.api.arrange(nameOf(key)!, text);
        if (kept && !this.waiting.has(key)) this.storage?.removeItem(unsent(key));
      } catch {
        // The mark stays: this browser has the newer text.
      }
    }
    this.sending = false;
  }
}

const first = (all: ReadonlyMap<string, string>) => all.entries().next().value;
