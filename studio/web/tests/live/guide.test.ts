import { expect, it } from "vitest";
import { Guide, tourSteps } from "../../live/guide";

function storage() {
  const kept = new Map<string, string>();
  return { getItem: (key: string) => kept.get(key) ?? null, setItem: (key: string, value: string) => void kept.set(key, value) };
}

it("the tour is offered until it is refused or begun, and has five steps", () => {
  const kept = storage();
  expect(new Guide(kept).store.get().offered).toBe(true);
  expect(new Guide(kept).store.get().offered).toBe(true);
  const guide = new Guide(kept);
  guide.go(tourSteps[0]);
  expect(guide.store.get()).toEqual({ open: false, step: "structure", offered: false });
  expect(guide.beside(-1)).toBeNull();
  const seen = [];
  for (let step = guide.store.get().step; step !== null; step = guide.beside(1)) {
    guide.go(step);
    seen.push(step);
  }
  expect(seen).toEqual(["structure", "edit", "verify", "run", "values"]);
  guide.go(null);
  expect(guide.store.get().step).toBeNull();
  expect(new Guide(kept).store.get().offered).toBe(false);
});
