import { afterAll, beforeEach, describe, expect, it, vi } from "vitest";
import { ApiError } from "../../live/api";
import { Gamepads } from "../../live/operate/gamepads";
import { Operator } from "../../live/operate/operator";
import type { Pad } from "../../model/run/gamepad";
import type { ControlRequest, Operators, PanelShown } from "../../model/protocol";
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
  const pad: { now: Pad | null } = { now: null };
  const answered: Operators = { stamp: 7, operators: [] };
  const api = {
    operate: async (_run: string, request: ControlRequest, signal: AbortSignal) => {
      sent.push(request);
      const givenUp = new Promise<void>((_, fail) => (signal.onabort = () => fail(new ApiError(0, "no answer"))));
      if (isSlow) await Promise.race([givenUp, new Promise<void>((answer) => slow.push(answer))]);
      if (refuse) throw new Error(refuse);
      return answered;
    },
    operators: async () => answered,
    lastControl: async (_run: string, request: ControlRequest) => {
      sent.push(request);
      return {};
    },
  };
  const store = new Store({ run: "1", state: "running" } as RunnerState);
  const operator = new Operator(api, { store } as Pick<Runner, "store">, new Gamepads(() => [pad.now], null));
  return {
    pad,
    answered,
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

  it("lets go of a server that does not answer, and says so", async () => {
    const { operator, sent, answerSlowly } = operating();
    operator.take(panel);
    await vi.advanceTimersByTimeAsync(1);
    answerSlowly();
    operator.move(panel.path, { forward: 0.5 });
    await vi.advanceTimersByTimeAsync(1400);
    expect(operator.store.get().inputs.size).toBe(1);
    await vi.advanceTimersByTimeAsync(400);
    expect(operator.store.get().inputs.size).toBe(0);
    expect(operator.store.get().problems.get(panel.path)).toContain("after 0.5 s by itself");
    const count = sent.length;
    await vi.advanceTimersByTimeAsync(1000);
    expect(sent.length).toBe(count);
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

  it("names the newest stamp, and lets go when its inputs come too late again and again", async () => {
    const { operator, sent, answered } = operating();
    operator.take(panel);
    await vi.advanceTimersByTimeAsync(1);
    expect(sent[0]).not.toHaveProperty("after");
    answered.stamp = 8;
    await vi.advanceTimersByTimeAsync(170);
    expect(sent.at(-1)).toMatchObject({ after: 8, within: 0.5 });
    answered.late = true;
    await vi.advanceTimersByTimeAsync(90);
    expect(operator.store.get().inputs.size, "one late input is no reason").toBe(1);
    await vi.advanceTimersByTimeAsync(1000);
    expect(operator.store.get().inputs.size).toBe(0);
    expect(operator.store.get().problems.get(panel.path)).toContain("too slow");
  });

  it("knows the other operators", async () => {
    const { operator, answered } = operating();
    answered.operators.push({ path: "crane.cabin.lever", operator: "another" });
    const leave = operator.lookAtOthers();
    await vi.advanceTimersByTimeAsync(1);
    expect(operator.store.get().others).toEqual(new Map([["crane.cabin.lever", "another"]]));
    leave();
  });

  it("follows a gamepad after its axes were at rest, and rests when it is unplugged", async () => {
    const { operator, inputs, pad } = operating();
    const buttons = Array.from({ length: 4 }, () => ({ pressed: false }));
    pad.now = { axes: [0, -1], buttons };
    operator.take(panel);
    await vi.advanceTimersByTimeAsync(200);
    expect(inputs().at(-1), "it was pushed before").toEqual({ forward: 0, light: false });
    pad.now = { axes: [0, 0], buttons };
    await vi.advanceTimersByTimeAsync(40);
    pad.now = { axes: [0, -1], buttons };
    await vi.advanceTimersByTimeAsync(40);
    expect(inputs().at(-1)).toEqual({ forward: 0.5, light: false });
    pad.now = null;
    await vi.advanceTimersByTimeAsync(40);
    expect(inputs().at(-1)).toEqual({ forward: 0, light: false });
    pad.now = { axes: [0, -1], buttons };
    await vi.advanceTimersByTimeAsync(200);
    expect(inputs().at(-1), "plugged in with its stick pushed").toEqual({ forward: 0, light: false });
  });

  it("moves a switch once for each press of its button, and never for one from before", async () => {
    const { operator, inputs, pad } = operating();
    const press = (pressed: boolean) => (pad.now = { axes: [0, 0], buttons: [{ pressed }] });
    operator.gamepads.change(panel, { deadZone: 0.1, enable: null, axes: {}, buttons: { light: 0 } });
    press(true);
    operator.take(panel);
    await vi.advanceTimersByTimeAsync(100);
    expect(inputs().at(-1)).toEqual({ forward: 0, light: false });
    for (const light of [true, false]) {
      press(false);
      await vi.advanceTimersByTimeAsync(40);
      press(true);
      await vi.advanceTimersByTimeAsync(200);
      expect(inputs().at(-1)).toEqual({ forward: 0, light });
    }
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
