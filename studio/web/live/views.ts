import { anglesOf, numbersOf, type Rays } from "../model/net/views";
import type { Api } from "./api";
import type { WorldView } from "../model/protocol";
import type { Track } from "./run/track";

/** Requests the devices that give scans and pictures; none if the world does not answer. */
export async function viewsOf(api: Api): Promise<readonly WorldView[]> {
  try {
    return (await api.views()).views;
  } catch {
    // The check of the specification reports the mistake in the world.
    return [];
  }
}

/** The scans of a track at its time. Another object means other rays. */
export class Scans {
  private shown: { key: unknown[]; rays: readonly Rays[] } = { key: [], rays: [] };
  private readonly bodies: ReadonlyMap<string, number>;
  private readonly known = new WeakMap<Uint8Array, Rays>();

  constructor(
    private readonly views: readonly WorldView[],
    bodies: readonly (readonly [string, string])[],
  ) {
    this.bodies = new Map(bodies.map(([name], index) => [name, index]));
  }

  at({ arrays, now }: Track): readonly Rays[] {
    const key = this.views.map(({ path }) => arrays.at(path, now) ?? null);
    if (key.length === this.shown.key.length && key.every((one, at) => one === this.shown.key[at])) return this.shown.rays;
    const rays = this.views.flatMap((view, at) => (key[at] ? (this.raysOf(view, key[at]) ?? []) : []));
    this.shown = { key, rays };
    return rays;
  }

  private raysOf(view: WorldView, bytes: Uint8Array): Rays | null {
    const ready = this.known.get(bytes);
    if (ready) return ready;
    const body = view.body ? this.bodies.get(view.body) : -1;
    const ranges = numbersOf(view.type, bytes);
    if (body === undefined || !ranges) return null;
    const { position = [0, 0, 0], quaternion = [1, 0, 0, 0] } = view;
    const rays = { body, position, quaternion, angles: anglesOf(view, ranges.length), ranges };
    this.known.set(bytes, rays);
    return rays;
  }
}
