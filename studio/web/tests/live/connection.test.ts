import { describe, expect, it, vi } from "vitest";
import { ApiError, type Api } from "../../live/api";
import { Connection } from "../../live/stream/connection";

const sources: FakeEventSource[] = [];
class FakeEventSource {
  onopen: (() => void) | null = null;
  onerror: (() => void) | null = null;
  constructor(readonly address: string) {
    sources.push(this);
  }
  addEventListener(): void {}
  close(): void {}
}

describe("the connection of a tab", () => {
  it("goes on with the key that another tab tells while its own is being refused", async () => {
    vi.useFakeTimers();
    vi.stubGlobal("EventSource", FakeEventSource);
    let refuse = () => {};
    const api = {
      token: "old",
      eventsAddress: () => `/events?${api.token}`,
      project: () => new Promise((_, reject) => (refuse = () => reject(new ApiError(401, "no")))),
    };
    const connection = new Connection(api as unknown as Api);
    connection.open();
    sources[0]!.onerror!();
    connection.openWith("new");
    refuse();
    await vi.advanceTimersByTimeAsync(5000);
    expect(sources.at(-1)!.address).toBe("/events?new");
    sources.at(-1)!.onerror!();
    refuse();
    await vi.advanceTimersByTimeAsync(5000);
    expect(connection.store.get().state).toBe("refused");
    vi.useRealTimers();
    vi.unstubAllGlobals();
  });
});
