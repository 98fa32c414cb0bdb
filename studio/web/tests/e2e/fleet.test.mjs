import assert from "node:assert/strict";
import { test } from "node:test";
import { element, find, folder, onPage } from "./page.mjs";

test("a fleet of a hundred opens folded, and any of its robots is found and looked into", () =>
  onPage(folder("fleet"), async (page) => {
    await page.locator(".sheet").first().waitFor();
    assert.equal(await page.locator(".page.agent.folded").count(), 100);
    assert.equal(await page.locator(".sheet").count(), 1);
    await find(page, "robot[73].control.walk");
    await page.locator('[data-path="robot[73].control.walk"]').first().waitFor();
    await page.getByRole("navigation", { name: "Layers" }).getByText("robot[73]", { exact: true }).waitFor();
    // Only what is seen is in the page.
    assert.ok((await page.locator(".sheet").count()) < 12);
    await element(page, "robot[73].control.walk").waitFor();
  }));
