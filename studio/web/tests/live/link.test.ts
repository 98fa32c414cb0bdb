import { expect, it } from "vitest";
import { linkTo, readLink } from "../../live/link";

it("an address leads back to what it was made of", () => {
  const shown = { view: "structure", panel: "verify", selected: "robot[3].control" } as const;
  expect(readLink(linkTo(shown))).toEqual(shown);
  expect(readLink(linkTo({ ...shown, selected: null }))).toEqual({ view: "structure", panel: "verify" });
});

it("an address leads back to a moment of a recording, to the nanosecond", () => {
  for (const time of [0, 1, 1_234_567_891, 599_999_999_999]) {
    const shown = {
      view: "net",
      panel: "recordings",
      selected: "robot",
      moment: { recording: "2026-11-24 10:00 a&b.trec", time },
    } as const;
    expect(readLink(linkTo(shown))).toEqual(shown);
  }
  expect(readLink("#recording=a.trec&t=soon")).toEqual({ moment: { recording: "a.trec", time: 0 } });
  expect(readLink("#t=5")).toEqual({});
});

it("what an address should not say is left out", () => {
  expect(readLink("#token=00ff")).toEqual({});
  expect(readLink("#view=moon&panel=verify")).toEqual({ panel: "verify" });
});
