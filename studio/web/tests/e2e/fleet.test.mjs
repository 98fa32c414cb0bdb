import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { button, drawn, element, find, folder, onNet, onPage, tab, until } from "./page.mjs";

test("a fleet of a hundred opens folded, and any of its robots is found and looked into", () =>
  onNet(folder("fleet"), async (page) => {
    await page.locator(".sheet").first().waitFor();
    assert.equal(await page.locator(".page.agent.folded").count(), 100);
    assert.equal(await page.locator(".sheet").count(), 1);
    await find(page, "robot[73].control.walk");
    await page.locator('[data-path="robot[73].control.walk"]').first().waitFor();
    await page.getByRole("navigation", { name: "Layers" }).getByText("robot[73]", { exact: true }).waitFor();
    // Only visible elements are in the page.
    assert.ok((await page.locator(".sheet").count()) < 12);
    await element(page, "robot[73].control.walk").waitFor();
  }));

test("what a canvas shows of a fleet looks like the elements of SVG, can be pointed at and is named", async () => {
  const project = mkdtempSync(join(tmpdir(), "studio-fleet-"));
  writeFileSync(
    join(project, "spec.yaml"),
    readFileSync(join(folder("fleet"), "spec.yaml"), "utf8").replace("count: 100", "count: 1000"),
  );
  await onNet(project, async (page) => {
    await page.locator(".net-layer").waitFor();
    const inView = page.getByRole("list", { name: "In view" });
    await inView.getByText("agent robot[0]", { exact: true }).waitFor({ state: "attached" });
    await inView.getByText("and 940 more").waitFor({ state: "attached" });
    await page.getByRole("button", { name: "Unfold all" }).click();
    const area = await page.locator(".canvas-area").boundingBox();
    const middle = [area.x + area.width / 2, area.y + area.height / 2];
    // Far away, the frames of agents; nearer, names in them.
    for (const steps of [0, 8, 9]) {
      await page.mouse.move(...middle);
      for (let step = 0; step < steps; step += 1) await page.mouse.wheel(0, -80);
      await page.locator(".net-layer").waitFor();
      assert.equal(await page.locator(".sheet").count(), 0);
      await drawn(page);
      const [canvas, elements] = await pictures(page);
      const differs = await difference(page, canvas, elements);
      const most = (await difference(page, empty, elements)) * 0.6;
      assert.ok(differs < most, `they differ by ${differs} after ${steps} steps, and may by ${most}`);
    }
    // Between two frames is nothing.
    const said = page.locator(".canvas [aria-live].visually-hidden").first();
    const path = await until(
      page,
      async () => {
        middle[1] += 7;
        await page.mouse.click(...middle);
        await drawn(page);
        return /robot\[\d+\]/.exec(await said.textContent())?.[0];
      },
      "a click on a robot",
    );
    await page.locator(".canvas-area").focus();
    await page.keyboard.press("ArrowRight");
    await until(page, async () => /robot\[\d+\]/.exec(await said.textContent())?.[0] !== path, "the next one");
  });
  rmSync(project, { recursive: true, force: true });
});

/** The drawing on its canvas, and the exported picture, which is made of elements of SVG; both as addresses. */
async function pictures(page) {
  const canvas = await page.locator(".net-layer").evaluate((one) => one.toDataURL());
  const download = page.waitForEvent("download");
  await button(page, "SVG").click();
  const text = readFileSync(await (await download).path(), "utf8");
  return [canvas, `data:image/svg+xml;base64,${Buffer.from(text).toString("base64")}`];
}

const empty = `data:image/svg+xml,${encodeURIComponent('<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9"/>')}`;

/** How much two pictures differ, each made smaller and on the same ground: 0 to 1. */
const difference = (page, one, other) =>
  page.evaluate(
    async ([one, other]) => {
      const [width, height] = [320, 320];
      const grey = async (address) => {
        const image = new Image();
        image.src = address;
        await image.decode();
        const canvas = Object.assign(document.createElement("canvas"), { width, height });
        const context = canvas.getContext("2d", { willReadFrequently: true });
        context.fillStyle = getComputedStyle(document.querySelector(".canvas-area")).getPropertyValue("--net-bg");
        context.fillRect(0, 0, width, height);
        context.drawImage(image, 0, 0, width, height);
        return context.getImageData(0, 0, width, height).data;
      };
      const [a, b] = [await grey(one), await grey(other)];
      let sum = 0;
      for (let at = 0; at < a.length; at += 1) sum += Math.abs(a[at] - b[at]);
      return sum / a.length / 255;
    },
    [one, other],
  );

test("ten thousand robots open with less than five megabytes, and one of them is found, looked into and played", async () => {
  const project = mkdtempSync(join(tmpdir(), "studio-fleet-"));
  writeFileSync(
    join(project, "spec.yaml"),
    readFileSync(join(folder("fleet"), "spec.yaml"), "utf8").replace("count: 100", "count: 10000"),
  );
  await onPage(project, async (_, server, open) => {
    const page = await open();
    const network = await page.context().newCDPSession(page);
    await network.send("Network.enable");
    let bytes = 0;
    network.on("Network.loadingFinished", ({ encodedDataLength }) => (bytes += encodedDataLength));
    await page.goto(server.url);
    await tab(page, "Net").click();
    // So many symbols are on a canvas.
    await page.locator(".net-layer").waitFor();
    assert.ok(bytes > 400_000 && bytes < 5e6, `${bytes} bytes`);
    await page.getByText("530002 places").waitFor();
    await find(page, "robot[7777].control.walk");
    await element(page, "robot[7777].control.walk.t5").waitFor();
    // Only near elements are drawn.
    assert.ok((await page.locator(".sheet .page").count()) < 3000);
    await tab(page, "Play").click();
    await button(page, "Play the token game").click();
    await button(page, "t_in").click();
    await page.getByText(/and 9[\d]{3} more/).waitFor();
    await button(page, "robot[3].t_in").click();
    await button(page, "robot[3].control.t_in").waitFor();
  });
  rmSync(project, { recursive: true, force: true });
});
