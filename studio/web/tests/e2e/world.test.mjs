import assert from "node:assert/strict";
import { test } from "node:test";
import { button, element, example, find, onNet, tab, until } from "./page.mjs";
import { writeWorld } from "./recorded_world.mjs";

const api = (server, path) => fetch(`${server.address}${path}`, { headers: { Authorization: `Bearer ${server.token}` } });

/** Writes recordings of worlds, and opens the panel that lists them. */
async function withWorlds(page, server, worlds) {
  const { analysis } = await (await api(server, "/api/spec")).json();
  const transitions = analysis.net.system.transitions.map(({ name }) => name);
  for (const [at, world] of worlds.entries())
    writeWorld(server.root, world.name, {
      hash: `00000000000000${at}0`,
      net_hash: analysis.net_hash,
      transitions: transitions.slice(0, 1),
      agent: "robot",
      ...world,
    });
  await tab(page, "Recordings").click();
}

const space = (page) => page.getByRole("img", { name: "The world in three dimensions" });
const drawn = (page) => space(page).evaluate((canvas) => Number(canvas.dataset.drawn ?? 0));
const placeOf = (page, body) => space(page).evaluate((canvas, which) => canvas.view?.onScreen(which), body);

/** The number of different colours in a canvas as it is on the screen. */
async function colours(page) {
  const picture = await space(page).screenshot();
  return page.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
    const context = canvas.getContext("2d");
    context.drawImage(bitmap, 0, 0);
    const { data } = context.getImageData(0, 0, bitmap.width, bitmap.height);
    return new Set(Array.from({ length: data.length / 4 }, (_, at) => data.slice(4 * at, 4 * at + 3).join())).size;
  }, picture.toString("base64"));
}

test("a recorded world is seen in three dimensions at every time of the timeline", () =>
  onNet(example("01_line_follower"), async (page, server) => {
    const chunks = [];
    page.on("request", (request) => /world_3d/.test(request.url()) && chunks.push(request.url()));
    await withWorlds(page, server, [{ name: "three", robots: 3 }]);
    assert.equal(chunks.length, 0, "the page loads the view with the first world only");
    await page.getByRole("button", { name: /^three\.tsr/ }).click();
    await space(page).waitFor();
    await until(page, async () => (await drawn(page)) > 0, "the world is drawn");
    assert.equal(chunks.length, 1);
    await until(page, async () => (await colours(page)) > 4, "more is to be seen than the background");

    const atStart = await placeOf(page, 0);
    await until(page, () => space(page).evaluate((canvas) => canvas.view.given.poses() !== null), "poses are loaded");
    const rest = await drawn(page);
    await page.waitForTimeout(300);
    assert.ok((await drawn(page)) <= rest + 1, "nothing is drawn while nothing changes");

    await page.getByRole("slider", { name: "Time" }).fill(String(2.5e9));
    await until(page, async () => {
      const now = await placeOf(page, 0);
      return Math.hypot(now.x - atStart.x, now.y - atStart.y) > 5;
    }, "the body is somewhere else later"); // prettier-ignore

    const { x, y } = await placeOf(page, 1);
    await page.mouse.click(x, y - 2);
    await page.getByRole("navigation", { name: "Layers" }).getByText("robot", { exact: true }).waitFor();

    await page.getByLabel("Body to follow").selectOption("robot[2]/base");
    await until(page, async () => {
      const box = await space(page).boundingBox();
      const now = await placeOf(page, 2);
      return Math.abs(now.x - box.x - box.width / 2) < 3 && Math.abs(now.y - box.y - box.height / 2) < 3;
    }, "the followed body is in the middle"); // prettier-ignore

    await button(page, "3D").click();
    await page.getByRole("img", { name: "The robots from above" }).waitFor();
    const legend = page.getByRole("list", { name: "Robots" });
    assert.deepEqual(await legend.getByRole("listitem").allInnerTexts(), ["robot[0]", "robot[1]", "robot[2]"]);
    await legend.getByText("robot[1]").click();
    await element(page, "robot").and(page.locator(".selected")).waitFor();
  }));

test("in a narrow window the head of the world shows all of its buttons, and names the body that is followed", () =>
  onNet(example("01_line_follower"), async (page, server) => {
    await withWorlds(page, server, [{ name: "three", robots: 3 }]);
    await page.getByRole("button", { name: /^three\.tsr/ }).click();
    await space(page).waitFor();
    await page.setViewportSize({ width: 640, height: 900 });
    await tab(page, "World").click();
    await space(page).waitFor();
    const parts = page.locator(".watch-pane.world .watch-title :is(select, button)");
    const pane = await page.locator(".watch-pane.world").boundingBox();
    const boxes = await Promise.all((await parts.all()).map((one) => one.boundingBox()));
    assert.ok(boxes.length >= 2);
    for (const { x, width } of boxes)
      assert.ok(x >= pane.x && x + width <= pane.x + pane.width && width > 20, JSON.stringify([pane, ...boxes]));
    assert.ok(boxes[0].width > 80, `the select is ${boxes[0].width} px wide`);
  }));

test("what was never reached is shaded and counted as --coverage counts it", () =>
  onNet(example("01_line_follower"), async (page, server) => {
    await withWorlds(page, server, [{ name: "one", robots: 1 }]);
    await page.getByRole("button", { name: /^one\.tsr/ }).click();
    const shaded = page.locator(".element.unreached");
    await button(page, "Never reached").click();
    const counts = page.getByRole("group", { name: "Coverage" }).locator("dd");
    await counts.first().waitFor();
    // Only the first transition of the net has fired.
    const { missing, places } = await (await api(server, "/api/recordings/one.tsr/coverage")).json();
    assert.equal(missing.behaviours.length, 4);
    assert.ok(!missing.transitions.includes(0) && missing.transitions.includes(1));
    assert.deepEqual((await counts.allInnerTexts()).slice(0, 2), ["4 of 4", `${places.all - places.reached} of ${places.all}`]);
    // Near enough for what is in a subsystem, however large the drawing is.
    await find(page, "robot.control");
    await until(page, async () => (await shaded.count()) > 5, "the drawing is shaded");
    await button(page, "Never reached").click();
    await until(page, async () => (await shaded.count()) === 0, "the shade is gone");
    assert.equal((await api(server, "/api/recordings/none.tsr/coverage")).status, 404);
  }));

test("the scene goes to those with the token only, and only by its hash", () =>
  onNet(example("01_line_follower"), async (page, server) => {
    await withWorlds(page, server, [{ name: "one", robots: 1 }]);
    const scene = await api(server, "/api/scenes/0000000000000000.glb");
    assert.equal(scene.status, 200);
    assert.equal(scene.headers.get("content-type"), "model/gltf-binary");
    assert.equal((await fetch(`${server.address}/api/scenes/0000000000000000.glb`)).status, 401);
    for (const wrong of ["0000000000000001.glb", "..%2fspec.yaml", "one.tsr"])
      assert.equal((await api(server, `/api/scenes/${wrong}`)).status, 404, wrong);
    const part = await (await api(server, "/api/recordings/one.tsr/poses?from=5000000000&to=6000000000")).json();
    assert.equal(part.frames.length, 27, "a second of frames, and the one before it");
    assert.equal(part.until, 6e9);
  }));

test("two runs in one world are seen as ghosts of each other", () =>
  onNet(example("01_line_follower"), async (page, server) => {
    const hash = "00000000000000aa";
    await withWorlds(page, server, [
      { name: "one", hash, robots: 2 },
      { name: "two", hash, robots: 2, shift: 0.5 },
    ]);
    await page.getByRole("button", { name: /^one\.tsr/ }).click();
    await space(page).waitFor();
    const ghosts = (at) =>
      space(page)
        .nth(at)
        .evaluate(({ view }) => {
          const ghost = view?.ghosts?.meshes[0];
          return ghost?.parent ? ghost.instanceMatrix.array[12] - view.bodies[0].position.x : null;
        });
    await until(page, async () => (await drawn(page)) > 0, "the world is drawn");
    assert.equal(await ghosts(0), null, "alone it has none");
    await button(page, "Show two.tsr beside one.tsr").click();
    await until(page, async () => Math.abs((await ghosts(0)) - 0.5) < 1e-3, "the right run is a ghost on the left");
    await until(page, async () => Math.abs((await ghosts(1)) + 0.5) < 1e-3, "and the left one on the right");
  }));
