// A shared worker: it lives as long as any tab of this address, and holds the event stream for all of them.
import { eventNames } from "./event_names";
import { StreamHub, type Source, type ToHub } from "./stream_hub";

const hub = new StreamHub(eventNames, (address) => new EventSource(address) as unknown as Source);
setInterval(() => hub.sweep(), 60_000);
addEventListener("connect", (event) => {
  const port = (event as MessageEvent).ports[0]!;
  port.onmessage = ({ data }: MessageEvent<ToHub>) => hub.say(port, data);
});
