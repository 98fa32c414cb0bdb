// Pictures per second of the view in three dimensions while a recording plays, and its view turns all the time.
import { loadavg } from "node:os";
import { example, onPage, tab } from "./page.mjs";
import { writeWorld } from "./recorded_world.mjs";

const seconds = 6;

export async function measureWorld(robots, { parts = 6, large = false } = {}) {
  await onPage(example("01_line_follower"), async (page, server) => {
    const answer = await fetch(`${server.address}/api/spec`, { headers: { Authorization: `Bearer ${server.token}` } });
    const { analysis } = await answer.json();
    const transitions = analysis.net.system.transitions.map(({ name }) => name).slice(0, 1);
    const { net_hash } = analysis;
    writeWorld(server.root, "measured", { hash: "00000000000000bb", net_hash, transitions, agent: "robot", robots, parts });
    await tab(page, "Recordings").click();
    await page.getByRole("button", { name: /^measured\.tsr/ }).click();
    await page.waitForFunction(() => Number(document.querySelector("canvas.space")?.dataset.drawn ?? 0) > 0);
    await page.waitForTimeout(500);
    await page.getByRole("button", { name: "Play", exact: true }).click();
    if (large) await page.keyboard.press("Alt+Enter");
    const { drawn, ticks, late, size, told } = await page.evaluate(async (length) => {
      const canvas = document.querySelector("canvas.space");
      const before = Number(canvas.dataset.drawn);
      const start = performance.now();
      let ticks = 0;
      let late = 0;
      let last = start;
      const costs = { own: [], whole: [] };
      while (performance.now() - start < length) {
        await new Promise((done) => requestAnimationFrame(done));
        for (const of of ["own", "whole"]) costs[of].push(canvas.view.pace[of]);
        canvas.view.touch();
        const now = performance.now();
        ticks += 1;
        late = Math.max(late, now - last);
        last = now;
      }
      const passed = (performance.now() - start) / 1000;
      const { calls, triangles } = canvas.view.renderer.info.render;
      const median = (list) => list.sort((a, b) => a - b)[list.length >> 1].toFixed(1);
      const told = `${calls} draw calls, ${triangles} triangles, ${median(costs.own)} ms in the page, ${median(costs.whole)} ms in all`;
      return { drawn: (Number(canvas.dataset.drawn) - before) / passed, ticks: ticks / passed, late, size: `${canvas.width} x ${canvas.height}`, told };
    }, seconds * 1000); // prettier-ignore
    console.log(
      `${robots} robots of ${parts} parts, ${size}: ${drawn.toFixed(1)} pictures/s, page ${ticks.toFixed(1)} frames/s, ` +
        `longest ${late.toFixed(0)} ms, ${told}, load average ${loadavg()[0].toFixed(1)}`,
    );
  });
}
