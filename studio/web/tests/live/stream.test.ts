import { describe, expect, it } from "vitest";
import { longestSilence_ms, StreamHub, type FromHub, type Source, type Tab } from "../../live/stream/stream_hub";

class FakeSource implements Source {
  onopen: (() => void) | null = null;
  onerror: (() => void) | null = null;
  closed = false;
  private readonly takers = new Map<string, (event: MessageEvent<string>) => void>();
  addEventListener(name: string, take: (event: MessageEvent<string>) => void): void {
    this.takers.set(name, take);
  }
  close(): void {
    this.closed = true;
  }
  send(name: string, data: object): void {
    this.takers.get(name)!({ data: JSON.stringify(data) } as MessageEvent<string>);
  }
}

/** A hub, its sources, and tabs that note what they hear. */
function hubbed() {
  const clock = { now: 0 };
  const sources: FakeSource[] = [];
  const connect = () => {
    sources.push(new FakeSource());
    return sources.at(-1)!;
  };
  const hub = new StreamHub(["hello", "spec", "run"], connect, () => clock.now);
  const tab = () => {
    const heard: FromHub[] = [];
    return { heard, postMessage: (message: FromHub) => void heard.push(message) } satisfies Tab & { heard: FromHub[] };
  };
  return { hub, sources, tab, clock };
}

describe("the event stream of all tabs", () => {
  it("is one, and each tab hears all of it", () => {
    const { hub, sources, tab } = hubbed();
    const tabs = Array.from({ length: 8 }, tab);
    for (const one of tabs) hub.say(one, { open: "/events" });
    expect(sources).toHaveLength(1);
    sources[0]!.onopen!();
    sources[0]!.send("run", { run: "1" });
    for (const { heard } of tabs) expect(heard).toEqual([{ opened: true }, { event: "run", data: '{"run":"1"}' }]);
  });
  it("greets a tab that comes later with the newest revision", () => {
    const { hub, sources, tab } = hubbed();
    hub.say(tab(), { open: "/events" });
    sources[0]!.onopen!();
    sources[0]!.send("hello", { server_start: "s", revision: "1" });
    sources[0]!.send("spec", { revision: "2" });
    const late = tab();
    hub.say(late, { open: "/events" });
    expect(late.heard).toEqual([{ opened: true }, { event: "hello", data: '{"server_start":"s","revision":"2"}' }]);
  });
  it("begins again after it broke, once for all", () => {
    const { hub, sources, tab } = hubbed();
    const [one, other] = [tab(), tab()];
    for (const each of [one, other]) hub.say(each, { open: "/events" });
    sources[0]!.onerror!();
    for (const { heard } of [one, other]) expect(heard).toEqual([{ broken: true }]);
    for (const each of [one, other]) hub.say(each, { open: "/events" });
    expect(sources).toHaveLength(2);
    expect(sources[0]!.closed).toBe(true);
  });
  it("ends with the last tab, also with one that says nothing", () => {
    const { hub, sources, tab, clock } = hubbed();
    const [one, silent] = [tab(), tab()];
    for (const each of [one, silent]) hub.say(each, { open: "/events" });
    clock.now = longestSilence_ms;
    hub.say(one, { ping: true });
    clock.now += 1;
    hub.sweep();
    hub.say(one, { close: true });
    expect(sources[0]!.closed).toBe(true);
    // It only slept, and is told to begin again.
    hub.say(silent, { ping: true });
    expect(silent.heard).toEqual([{ broken: true }]);
    expect(one.heard).toEqual([{ pong: true }]);
  });
  it("is one for each key of a server", () => {
    const { hub, sources, tab } = hubbed();
    const one = tab();
    hub.say(one, { open: "/events?token=1" });
    hub.say(tab(), { open: "/events?token=2" });
    expect(sources).toHaveLength(2);
    hub.say(one, { open: "/events?token=2" });
    expect([sources.length, sources[0]!.closed]).toEqual([2, true]);
  });
});
