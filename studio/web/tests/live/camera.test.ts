import { describe, expect, it } from "vitest";
import { Camera, type Look } from "../../live/camera";

const look = (x: number): Look => ({ x, y: 0, zoom: 1 });

describe("Camera", () => {
  it("leads all panes but the one that moved, and takes who joins along", () => {
    const camera = new Camera();
    const seen: [string, number][] = [];
    const pane = (name: string) => (to: Look) => void seen.push([name, to.x]);
    const [left, right] = [pane("left"), pane("right")];
    camera.join(left);
    camera.moved(look(1), left);
    const leave = camera.join(right);
    camera.moved(look(2), right);
    camera.moved(look(2), left);
    leave();
    camera.moved(look(3), left);
    expect(seen).toEqual([
      ["right", 1],
      ["left", 2],
    ]);
  });
  it("forgets where it was when nobody looks any more", () => {
    const camera = new Camera();
    const leave = camera.join(() => undefined);
    camera.moved(look(1), () => undefined);
    leave();
    camera.join(() => undefined);
    expect(camera.look).toBeNull();
  });
});
