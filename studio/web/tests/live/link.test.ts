import { expect, it } from "vitest";
import { linkTo, readLink } from "../../live/link";

it("an address leads back to what it was made of", () => {
  const shown = { view: "structure", panel: "verify", selected: "robot[3].control" } as const;
  expect(readLink(linkTo(shown))).toEqual(shown);
  expect(readLink(linkTo({ ...shown, selected: null }))).toEqual({ view: "structure", panel: "verify" });
});

it("what an address should not say is left out", () => {
  expect(readLink("#token=00ff")).toEqual({});
  expect(readLink("#view=moon&panel=verify")).toEqual({ panel: "verify" });
});
