// Times of the page with large fleets: node tests/e2e/measure.mjs FOLDER ... (TESSERA and STUDIO_DIST as for the tests).
import { onPage } from "./page.mjs";

for (const folder of process.argv.slice(2))
  await onPage(folder, async (page) => {
    const loaded = await page.evaluate(
      () =>
        new Promise((done) => {
          const look = () => (document.querySelector(".sheet .page") ? done(performance.now()) : requestAnimationFrame(look));
          look();
        }),
    );
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
    console.log(`${folder}: drawn after ${(loaded / 1000).toFixed(2)} s`);
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
