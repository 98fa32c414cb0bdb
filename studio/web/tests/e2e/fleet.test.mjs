import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { button, element, find, folder, onNet, onPage, tab } from "./page.mjs";

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
    await page.locator(".sheet .page").first().waitFor();
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
