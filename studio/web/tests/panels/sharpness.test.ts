import { expect, test } from "vitest";
import { Pace } from "../../panels/run/pace";
import { Sharpness } from "../../panels/world/sharpness";

/** A machine that needs so many milliseconds in the page, and so many for all pixels. */
interface Machine {
  own: number;
  pixels: number;
  /** Something changes every so many milliseconds. */
  every?: number;
  /** Until when something changes; the view is watched for a second more. */
  until?: number;
  /** Pixels of the canvas. */
  canvas?: number;
}

/** The scales of the pictures, at sixty frames a second, in order. */
function drawn({ own, pixels, every = 0, until = 20_000, canvas = 1e6 }: Machine) {
  const pace = new Pace();
  const sharpness = new Sharpness();
  sharpness.fit(canvas);
  const pictures: { at: number; scale: number }[] = [];
  let [under, shown, changed] = [Infinity, 1, -Infinity];
  for (let now = 0; now < until + 1000; now += 1000 / 60) {
    const isChanged = now < until && now - changed >= every;
    if (now >= under) {
      pace.drawn(under);
      sharpness.drawn(shown, pace);
      under = Infinity;
    }
    if (!pace.isDue(now) || !(isChanged || sharpness.isBlurred(now, shown))) continue;
    shown = sharpness.scale(now);
    if (isChanged) [changed] = [now, sharpness.moved(now)];
    pace.begin(now);
    pace.ordered(now + own);
    under = now + own + pixels * shown ** 2;
    pictures.push({ at: now, scale: shown });
  }
  return pictures;
}

const later = (pictures: ReturnType<typeof drawn>, from: number, to: number) =>
  pictures.filter(({ at }) => at >= from && at < to);

test("a quick machine draws every pixel in each frame", () => {
  const pictures = drawn({ own: 2, pixels: 4 });
  expect(new Set(pictures.map(({ scale }) => scale))).toEqual(new Set([1]));
  expect(later(pictures, 1000, 19_000).length / 18).toBeGreaterThan(59);
});

test("a slow one draws fewer pixels while something moves, in each frame, and all when it stands", () => {
  for (const pixels of [7, 10, 15, 20]) {
    const pictures = drawn({ own: 2, pixels });
    const moving = later(pictures, 3000, 19_900);
    expect(moving.length / 16.9).toBeGreaterThan(58);
    expect(Math.max(...later(pictures, 3000, 10_000).map(({ scale }) => scale))).toBeLessThan(1);
    expect(pictures.at(-1)!.scale).toBe(1);
    expect(pictures.at(-1)!.at).toBeLessThan(20_400);
  }
});

test("what is drawn does not go from fine to coarse and back all the time", () => {
  for (let pixels = 5; pixels < 40; pixels += 0.5) {
    const scales = later(drawn({ own: 2, pixels, until: 60_000 }), 5000, 59_000).map(({ scale }) => scale);
    const changes = scales.filter((scale, at) => at > 0 && scale !== scales[at - 1]).length;
    expect(changes, `${pixels} ms`).toBeLessThan(12);
  }
});

test("half of width and height is the least, and pixels that save nothing are drawn", () => {
  expect(Math.min(...drawn({ own: 2, pixels: 400 }).map(({ scale }) => scale))).toBe(0.5);
  expect(Math.min(...drawn({ own: 30, pixels: 0.5 }).map(({ scale }) => scale))).toBe(1);
});

test("a small canvas has few pixels already", () => {
  const slow = { own: 2, pixels: 60 };
  expect(Math.min(...drawn({ ...slow, canvas: 320 * 220 }).map(({ scale }) => scale))).toBe(1);
  expect(Math.min(...drawn({ ...slow, canvas: 500 * 400 }).map(({ scale }) => scale))).toBe(0.84);
  expect(Math.min(...drawn({ ...slow, canvas: 1080 * 480 }).map(({ scale }) => scale))).toBe(0.5);
});

test("of what changes now and then, each picture has every pixel", () => {
  expect(Math.min(...drawn({ own: 2, pixels: 60, every: 400 }).map(({ scale }) => scale))).toBe(1);
});

test("a machine that gets time again draws finely again", () => {
  const [pace, sharpness] = [new Pace(), new Sharpness()];
  const run = (from: number, to: number, whole: number) => {
    for (let now = from; now < to; now += 1000 / 60) {
      const scale = sharpness.scale(now);
      sharpness.moved(now);
      pace.begin(now);
      pace.ordered(now + 1);
      pace.drawn(now + 1 + whole * scale ** 2);
      sharpness.drawn(scale, pace);
    }
    return sharpness.scale(to);
  };
  expect(run(0, 3000, 30)).toBe(0.5);
  expect(run(3000, 8000, 3)).toBe(1);
});
