import { describe, expect, it } from "vitest";
import type { Api } from "../../live/api";
import type { Connection } from "../../live/stream/connection";
import { Emergency, stoppedOf } from "../../live/emergency";
import type { Driving } from "../../model/protocol";

const controller = (name: string, more: Partial<Driving["controllers"][number]> = {}) => ({
  name,
  system: name.split(".")[0]!,
  process: 1,
  deployed: false,
  answers: true,
  emergency: null,
  ...more,
});

describe("the emergency stop", () => {
  it("says that nobody was told if the server does not answer", async () => {
    const api = { emergencyStop: () => Promise.reject(new Error("The server does not answer.")) } as unknown as Api;
    const emergency = new Emergency(api, { on: () => {} } as unknown as Connection);
    await emergency.stop();
    const { told, asked } = emergency.store.get();
    expect(asked).toBeNull();
    expect(told).toEqual({ what: "stop", done: false, lines: ["The page could not tell them: The server does not answer."] });
  });
  it("resets the processes of a deployed system together", () => {
    const all = [
      controller("yard.gate.1", { deployed: true, emergency: "smoke" }),
      controller("yard.rover.2", { deployed: true, emergency: "smoke" }),
      controller("arm.3", { emergency: "too close" }),
      controller("belt.4"),
    ];
    expect(stoppedOf(all)).toEqual([
      { title: "yard", name: "yard.gate.1", why: "smoke" },
      { title: "arm.3", name: "arm.3", why: "too close" },
    ]);
  });
});
