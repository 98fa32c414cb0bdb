import { describe, expect, it } from "vitest";
import { againFrom } from "../../live/again";

describe("a run that is made again", () => {
  const request = { kind: "simulate", for: "60s", seed: 7, track: "oval.png", speed: 1 } as const;
  it("is the same run up to the moment", () => {
    expect(againFrom(request, 12.5, true)).toEqual({ ...request, skip_to: 12.5, paused: true });
  });
  it("gets as much time again if its time was over", () => {
    expect(againFrom(request, 60, false)).toMatchObject({ for: "120s", skip_to: 60 });
    expect(againFrom({ ...request, for: "2min" }, 120, false)).toMatchObject({ for: "240s" });
    expect(againFrom({ ...request, for: "2min" }, 60, false)).toMatchObject({ for: "2min" });
    expect(againFrom({ kind: "simulate" }, 600, false)).toMatchObject({ for: "1200s" });
    expect(againFrom({ kind: "simulate" }, 599, false)).not.toHaveProperty("for");
  });
});
