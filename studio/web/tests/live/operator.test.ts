import { afterAll, beforeEach, describe, expect, it, vi } from "vitest";
import { Operator } from "../../live/operator";
import type { ControlRequest, PanelShown } from "../../model/protocol";
import { Store } from "../../live/store";
import type { Runner } from "../../live/runner";
import type { RunnerState } from "../../live/runner_state";

const panel: PanelShown = {
  path: "robot.console.drive",
  stale_s: 0.5,
  controls: [
    { field: "forward", control: "stick_y", unit: "m/s", minimum: -0.5, maximum: 0.5, whole: false },
    { field: "light", control: "switch", unit: "", minimum: null, maximum: null, whole: false },
  ],
};

afterAll(() => vi.useRealTimers());
beforeEach(() => {
  vi.useFakeTimers();
});

function operating() {
  const sent: ControlRequest[] = [];
  let refuse = "";
  /** Requests wait until `answer`, if it is set. */
  const slow: (() => void)[] = [];
  let isSlow = false;
  const api = {
    control: async (_run: string, request: ControlRequest) => {
      sent.push(request);
      if (isSlow) await new Promise<void>((answer) => slow.push(answer));
      if (refuse) throw new Error(refuse);
      return {};
    },
    lastControl: async (_run: string, request: ControlRequest) => {
      sent.push(request);
      return {};
    },
  };
  const store = new Store({ run: "1", state: "running" } as RunnerState);
  const operator = new Operator(api, { store } as Pick<Runner, "store">, () => []);
  return {
    operator,
    store,
    sent,
    inputs: () => sent.map(({ inputs }) => inputs),
    refuse: (why: string) => (refuse = why),
    answerSlowly: () => (isSlow = true),
    answer: () => slow.splice(0).forEach((one) => one()),
  };
}

describe("Operator", () => {
  it("repeats what the controls give until it lets go", async () => {
    const { operator, inputs, sent } = operating();
    operator.take(panel);
    await vi.advanceTimersByTimeAsync(1);
    expect(inputs()).toEqual([{ forward: 0, light: false }]);
    operator.move(panel.path, { forward: 0.5 });
    await vi.advanceTimersByTimeAsync(480);
    expect(sent.length).toBeGreaterThan(5);
    expect(inputs().at(-1)).toEqual({ forward: 0.5, light: false });
    operator.letGo(panel.path);
    expect(sent.at(-1)).toEqual({ command: "panel", path: panel.path, operator: sent[0]!.operator });
    const count = sent.length;
    await vi.advanceTimersByTimeAsync(1000);
    expect(sent.length).toBe(count);
  });

  it("has one request on its way, and sends the newest values after it", async () => {
    const { operator, inputs, answerSlowly, answer } = operating();
    answerSlowly();
    operator.take(panel);
    for (const forward of [0.1, 0.2, 0.3]) operator.move(panel.path, { forward });
    await vi.advanceTimersByTimeAsync(1000);
    expect(inputs()).toEqual([{ forward: 0, light: false }]);
    answer();
    await vi.advanceTimersByTimeAsync(1);
    expect(inputs().slice(1)).toEqual([{ forward: 0.3, light: false }]);
  });

  it("lets go when it is refused, and says why", async () => {
    const { operator, refuse, sent } = operating();
    refuse("another operator has the panel");
    operator.take(panel);
    await vi.advanceTimersByTimeAsync(1000);
    expect(sent.length).toBe(1);
    expect(operator.store.get().inputs.size).toBe(0);
    expect(operator.store.get().problems.get(panel.path)).toContain("another operator");
  });

  it("stops with the run", async () => {
    const { operator, store, sent } = operating();
    operator.take(panel);
    await vi.advanceTimersByTimeAsync(1);
    store.set({ state: "ended" });
    const count = sent.length;
    await vi.advanceTimersByTimeAsync(1000);
    expect(sent.length).toBe(count);
  });

  it("lets go when the page is hidden or closed, and springs back when it loses the focus", async () => {
    const { operator, sent, inputs } = operating();
    const page = new EventTarget() as EventTarget & { visibilityState: string };
    const frame = new EventTarget();
    page.visibilityState = "visible";
    operator.watch(page as unknown as Document, frame as unknown as Window);
    operator.take(panel);
    operator.move(panel.path, { forward: 0.5, light: true });
    frame.dispatchEvent(new Event("blur"));
    await vi.advanceTimersByTimeAsync(1);
    expect(inputs().at(-1)).toEqual({ forward: 0, light: true });
    page.visibilityState = "hidden";
    page.dispatchEvent(new Event("visibilitychange"));
    expect(sent.at(-1)!.inputs).toBeUndefined();
    operator.take(panel);
    frame.dispatchEvent(new Event("pagehide"));
    expect(sent.at(-1)!.inputs).toBeUndefined();
    expect(operator.store.get().inputs.size).toBe(0);
  });
});
