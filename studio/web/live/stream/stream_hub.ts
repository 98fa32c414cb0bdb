/** The part of the shared worker that needs no worker: one event stream for all tabs of a browser. */

/** A message of a tab to the hub. */
export type ToHub = { open: string } | { ping: true } | { close: true };
/** A message of the hub to a tab. `broken`: there is no stream any more; the tab asks for one again. */
export type FromHub = { opened: true } | { broken: true } | { pong: true } | { event: string; data: string };

/** The end of a tab. A tab that is gone takes messages all the same, and nobody says so. */
export interface Tab {
  postMessage: (message: FromHub) => void;
}
/** An EventSource. */
export interface Source {
  onopen: (() => void) | null;
  onerror: (() => void) | null;
  addEventListener: (name: string, take: (event: MessageEvent<string>) => void) => void;
  close: () => void;
}

interface Stream {
  source: Source;
  open: boolean;
  /** The first event, with the newest revision of the file, for tabs that come later. */
  hello: string | null;
  tabs: Set<Tab>;
}

/** A tab in the background may be allowed to do something only once a minute; one that is frozen, nothing. */
export const longestSilence_ms = 300_000;

/** A browser allows six connections to a server: if each tab held one, the seventh could neither save nor stop a run. */
export class StreamHub {
  private readonly streams = new Map<string, Stream>();
  private readonly heard = new Map<Tab, number>();

  constructor(
    private readonly names: readonly string[],
    private readonly connect: (address: string) => Source,
    private readonly now: () => number = () => Date.now(),
  ) {}

  say(tab: Tab, message: ToHub): void {
    if ("open" in message) this.join(tab, message.open);
    else if ("close" in message) this.leave(tab);
    // It was taken for gone.
    else if (!this.heard.has(tab)) tab.postMessage({ broken: true });
    else {
      this.heard.set(tab, this.now());
      tab.postMessage({ pong: true });
    }
  }

  /** Forgets the tabs that are gone. */
  sweep(): void {
    const since = this.now() - longestSilence_ms;
    for (const [tab, heard] of this.heard) if (heard < since) this.leave(tab);
  }

  private join(tab: Tab, address: string): void {
    this.leave(tab);
    this.heard.set(tab, this.now());
    const stream = this.streams.get(address) ?? this.begin(address);
    stream.tabs.add(tab);
    if (!stream.open) return;
    tab.postMessage({ opened: true });
    if (stream.hello !== null) tab.postMessage({ event: "hello", data: stream.hello });
  }

  private leave(tab: Tab): void {
    this.heard.delete(tab);
    for (const [address, stream] of this.streams) {
      stream.tabs.delete(tab);
      if (stream.tabs.size > 0) continue;
      stream.source.close();
      this.streams.delete(address);
    }
  }

  private begin(address: string): Stream {
    const stream: Stream = { source: this.connect(address), open: false, hello: null, tabs: new Set() };
    this.streams.set(address, stream);
    const all = (message: FromHub) => stream.tabs.forEach((tab) => tab.postMessage(message));
    stream.source.onopen = () => {
      stream.open = true;
      all({ opened: true });
    };
    stream.source.onerror = () => {
      stream.source.close();
      if (this.streams.get(address) !== stream) return;
      this.streams.delete(address);
      all({ broken: true });
      for (const tab of stream.tabs) this.heard.delete(tab);
    };
    for (const name of this.names)
      stream.source.addEventListener(name, ({ data }) => {
        if (name === "hello") stream.hello = data;
        if (name === "spec" && stream.hello !== null)
          stream.hello = JSON.stringify({ ...(JSON.parse(stream.hello) as object), ...(JSON.parse(data) as object) });
        all({ event: name, data });
      });
    return stream;
  }
}
