// Measures the page, with TESSERA as for the tests: `node tests/e2e/measure.mjs 100 1000` with fleets of so
// many robots, `stream` while a run fires at full speed, `beside` the same with a recording beside it,
// `world` the view in three dimensions of 10 and of 50 robots.
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { measureStream } from "./measure_stream.mjs";
import { measureWorld } from "./measure_world.mjs";
import { folder, onNet, tab } from "./page.mjs";

const fleet = readFileSync(join(folder("fleet"), "spec.yaml"), "utf8");

for (const what of process.argv.slice(2))
  if (what === "stream" || what === "beside") await measureStream(what === "beside");
  else if (what === "world")
    for (const robots of [10, 50]) for (const large of [false, true]) await measureWorld(robots, { large });
  else await measureFleet(what);

/** The data that another page receives until it is drawn. */
async function bytesOf(page, server) {
  const network = await page.context().newCDPSession(page);
  await network.send("Network.enable");
  let bytes = 0;
  network.on("Network.loadingFinished", ({ encodedDataLength }) => (bytes += encodedDataLength));
  await page.goto(server.url);
  await tab(page, "Net").click();
  await page.locator(".sheet .page, .net-layer").first().waitFor();
  await page.close();
  return bytes;
}

async function measureFleet(robots) {
  const project = mkdtempSync(join(tmpdir(), "studio-fleet-"));
  writeFileSync(join(project, "spec.yaml"), fleet.replace("count: 100", `count: ${robots}`));
  await onNet(project, async (page, server, open) => {
    const loaded = await page.evaluate(
      () =>
        new Promise((done) => {
          const look = () =>
            document.querySelector(".sheet .page, .net-layer") ? done(performance.now()) : requestAnimationFrame(look);
          look();
        }),
    );
    const bytes = await bytesOf(await open(), server);
    const area = await page.locator(".canvas-area").boundingBox();
    const frames = async (what, act) => {
      await page.evaluate(() => {
        window.frames_ = [];
        const tick = (now) => (window.frames_.push(now), (window.tick_ = requestAnimationFrame(tick)));
        window.tick_ = requestAnimationFrame(tick);
      });
      await act();
      const times = await page.evaluate(() => (cancelAnimationFrame(window.tick_), window.frames_));
      const gaps = times
        .slice(1)
        .map((time, at) => time - times[at])
        .sort((a, b) => a - b);
      console.log(
        `  ${what}: ${((1000 * gaps.length) / (times.at(-1) - times[0])).toFixed(1)} frames/s, median ${gaps[gaps.length >> 1].toFixed(1)} ms, worst ${gaps.at(-1).toFixed(0)} ms`,
      );
    };
    console.log(`${robots} robots: drawn after ${(loaded / 1000).toFixed(2)} s, ${(bytes / 1e6).toFixed(2)} MB sent`);
    const pan = async () => {
      await page.mouse.move(area.x + area.width / 2, area.y + 200);
      await page.mouse.down();
      for (let step = 0; step < 90; step += 1)
        await page.mouse.move(area.x + area.width / 2 + 150 * Math.sin(step / 9), area.y + 200 + 80 * Math.sin(step / 7));
      await page.mouse.up();
    };
    await frames("panning, folded", pan);
    await page.getByRole("button", { name: "Unfold all" }).click();
    await frames("panning, unfolded", pan);
    await frames("zooming", async () => {
      for (let step = 0; step < 60; step += 1) await page.mouse.wheel(0, step < 40 ? -80 : 80);
    });
  });
  rmSync(project, { recursive: true, force: true });
}
