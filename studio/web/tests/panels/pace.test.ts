import { expect, test } from "vitest";
import { Pace } from "../../panels/run/pace";

/** The part of ten seconds that drawing takes, at sixty frames a second with a change in each. */
function shares(own: number, whole: number) {
  const pace = new Pace();
  let [inPage, inAll, pictures] = [0, 0, 0];
  let under = Infinity;
  for (let now = 0; now < 10_000; now += 1000 / 60) {
    if (now >= under) [under] = [Infinity, pace.drawn(under)];
    if (!pace.isDue(now)) continue;
    pace.begin(now);
    pace.ordered(now + own);
    under = now + whole;
    [inPage, inAll, pictures] = [inPage + own, inAll + whole, pictures + 1];
  }
  return { inPage: inPage / 10_000, inAll: inAll / 10_000, pictures: pictures / 10 };
}

test("quick pictures are drawn in each frame", () => {
  expect(shares(2, 6).pictures).toBeGreaterThan(59);
});

test("slow pictures leave two thirds of the page's time to the page, and half of the time to others", () => {
  for (const [own, whole] of [
    [30, 31],
    [100, 120],
    [5, 40],
    [5, 400],
  ] as const) {
    const { inPage, inAll, pictures } = shares(own, whole);
    expect(inPage).toBeLessThan(1 / 3 + 0.02);
    expect(inAll).toBeLessThan(1 / 2 + 0.05);
    expect(pictures).toBeGreaterThan(1);
  }
});
