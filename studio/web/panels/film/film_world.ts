import type { Api } from "../../live/api";
import type { Floor } from "../../live/api";
import type { Track } from "../../live/track";
import type { Poses, World } from "../../live/world";
import type { FilmedWorld } from "../../model/run/film";
import type { World3d } from "../world/world_3d";

/** Pictures of the world in a film: at most so many, and so many a second. */
const mostPictures = 240;
const eachSecond = 10;
const size = { width: 480, height: 320 };
/** Points of a path. */
const mostPoints = 4000;
/** Milliseconds that poses may take to arrive. */
const patience = 5000;

const pause = (time: number) => new Promise((done) => setTimeout(done, time));

/** The world of a run between two times, for a film; null: there is nothing to see. tell: receives the part that is done. */
export async function filmedWorld(
  api: Api,
  track: Track,
  from: number,
  to: number,
  tell: (part: number) => void,
): Promise<FilmedWorld | null> {
  const { world } = track;
  if (world)
    try {
      const pictures = await picturesOf(api, world, from, to, tell);
      if (pictures) return pictures;
    } catch {
      // Without WebGL, a film shows the path from above.
    }
  return pathOf(track, from, to);
}

async function picturesOf(
  api: Api,
  world: World,
  from: number,
  to: number,
  tell: (part: number) => void,
): Promise<FilmedWorld | null> {
  const [{ World3d }, glb] = await Promise.all([import("../world/world_3d"), api.scene(world.scene.hash)]);
  const canvas = document.createElement("canvas");
  canvas.setAttribute("style", `position: fixed; left: -9999px; width: ${size.width}px; height: ${size.height}px`);
  document.body.append(canvas);
  let poses = await posesAt(world, from);
  if (!poses) return null;
  const background = getComputedStyle(document.documentElement).getPropertyValue("--sunken").trim();
  const view = new World3d(canvas, {
    poses: () => poses,
    ghosts: () => null,
    scans: () => noScans,
    background: () => background,
    picked: () => undefined,
    lost: () => undefined,
  });
  try {
    await view.load(glb, world.scene.bodies.length);
    // The user's own view of it.
    const shown = (document.querySelector("canvas.space") as (HTMLCanvasElement & { view?: World3d }) | null)?.view;
    if (shown) view.lookAs(shown);
    const number = Math.max(2, Math.min(mostPictures, Math.ceil(((to - from) / 1e9) * eachSecond)));
    const [times, pictures]: [number[], string[]] = [[], []];
    for (let at = 0; at < number; at += 1) {
      const time = from + ((to - from) * at) / (number - 1);
      const next = await posesAt(world, time);
      if (!next) break;
      poses = next;
      const picture = view.picture(next);
      if (picture !== pictures.at(-1)) {
        times.push((time - from) / 1e9);
        pictures.push(picture);
      }
      tell((at + 1) / number);
      await pause(0);
    }
    return { kind: "pictures", times, pictures };
  } finally {
    view.close();
    canvas.remove();
  }
}

const noScans: never[] = [];

async function posesAt(world: World, time: number): Promise<Poses | null> {
  for (let waited = 0; waited < patience && !world.problem; waited += 30) {
    const poses = world.at(time);
    if (poses) return poses;
    await pause(30);
  }
  return null;
}

function pathOf({ path, floor }: Track, from: number, to: number): FilmedWorld | null {
  const within = path.filter(({ t }) => t <= to);
  if (within.length === 0) return null;
  const every = Math.ceil(within.length / mostPoints);
  const points = within.filter((_, at) => at % every === 0);
  const short = (value: number) => Math.round(value * 1e4) / 1e4;
  return {
    kind: "path",
    times: points.map(({ t }) => (t - from) / 1e9),
    poses: points.flatMap(({ x, y, heading }) => [short(x), short(y), short(heading)]),
    floor: floor && floorOf(floor),
  };
}

function floorOf({ image, metresPerPixel }: Floor) {
  const shrunk = Math.min(1, 900 / image.width);
  const canvas = document.createElement("canvas");
  canvas.width = Math.round(image.width * shrunk);
  canvas.height = Math.round(image.height * shrunk);
  canvas.getContext("2d")!.drawImage(image, 0, 0, canvas.width, canvas.height);
  return {
    picture: canvas.toDataURL("image/jpeg", 0.8),
    width: image.width * metresPerPixel,
    height: image.height * metresPerPixel,
  };
}
