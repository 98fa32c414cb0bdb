import { eventNames } from "./event_names";
import type { FromHub, ToHub } from "./stream_hub";

/** The events of the server, until the stream breaks. */
export interface Stream {
  close: () => void;
}
export interface StreamTakers {
  opened: () => void;
  /** The stream is of no use any more. */
  broken: () => void;
  event: (name: string, data: string) => void;
}

/** A stream of this tab alone, for browsers without shared workers. */
function ownStream(address: string, to: StreamTakers): Stream {
  const source = new EventSource(address);
  source.onopen = to.opened;
  source.onerror = to.broken;
  for (const name of eventNames) source.addEventListener(name, (event) => to.event(name, (event as MessageEvent<string>).data));
  return { close: () => source.close() };
}

const ping_ms = 4_000;
/** So long the worker may be busy. */
const patience_ms = 15_000;
/** A worker that hangs is given up after so many streams that broke without a word. */
const mostFailures = 2;
let failures = 0;

/** The stream that a shared worker holds for all tabs. */
function sharedStream(address: string, to: StreamTakers): Stream {
  const worker = new SharedWorker(new URL("./stream_worker.ts", import.meta.url), { type: "module", name: "tessera" });
  const { port } = worker;
  const say = (message: ToHub) => port.postMessage(message);
  let over = false;
  let [heard, last] = [performance.now(), performance.now()];
  const end = () => {
    over = true;
    clearInterval(timer);
    removeEventListener("pagehide", leave);
    removeEventListener("pageshow", back);
    say({ close: true });
    port.close();
  };
  const broken = () => {
    if (over) return;
    end();
    to.broken();
  };
  const fail = () => {
    failures += 1;
    broken();
  };
  const beat = () => {
    const now = performance.now();
    // A tab that slept has heard nothing, but the worker may be well.
    if (now - last > 3 * ping_ms) heard = now;
    last = now;
    if (now - heard > patience_ms) fail();
    else say({ ping: true });
  };
  const leave = () => say({ close: true });
  const back = (event: PageTransitionEvent) => event.persisted && broken();
  const timer = setInterval(beat, ping_ms);
  // Its script cannot be loaded.
  worker.onerror = () => {
    failures = mostFailures;
    broken();
  };
  port.onmessage = ({ data }: MessageEvent<FromHub>) => {
    if (over) return;
    heard = performance.now();
    if ("event" in data) to.event(data.event, data.data);
    else if ("opened" in data) to.opened();
    else if ("broken" in data) broken();
    else failures = 0;
  };
  addEventListener("pagehide", leave);
  addEventListener("pageshow", back);
  say({ open: address });
  return { close: end };
}

export function openStream(address: string, to: StreamTakers): Stream {
  if (typeof SharedWorker === "undefined" || failures >= mostFailures) return ownStream(address, to);
  try {
    return sharedStream(address, to);
  } catch {
    failures = mostFailures;
    return ownStream(address, to);
  }
}
