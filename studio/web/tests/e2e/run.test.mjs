import assert from "node:assert/strict";
import { test } from "node:test";
import { button, example, onPage, tab } from "./page.mjs";

test("a system without a world runs on the simulated clock, and what came of it is a table", () =>
  onPage(example("03_two_slot_buffer"), async (page) => {
    await tab(page, "Run").click();
    assert.equal(await page.getByLabel("Track").count(), 0);
    assert.match(await page.getByRole("combobox", { name: "Run" }).innerText(), /on the simulated clock/);
    const speed = page.getByRole("textbox", { name: "Speed" });
    await speed.fill("fast");
    await page.getByText("A number: simulated seconds a second").waitFor();
    await speed.fill("0");
    await page.getByRole("textbox", { name: "For" }).fill("20s");
    await button(page, "Run").click();
    const rows = page.locator(".outcome tbody tr");
    await rows.first().waitFor();
    assert.equal(await page.getByTestId("run-state").innerText(), "Ended — the time asked for is over");
    assert.equal(await rows.count(), 2);
    assert.match(await rows.first().innerText(), /watcher\.control\s+201\s+0\s+0/);
    assert.equal(await page.getByRole("heading", { name: "World" }).count(), 0);
    // The next run is as this one was, until something else is asked for.
    assert.equal(await speed.inputValue(), "0");
    assert.equal(await page.getByRole("textbox", { name: "For" }).inputValue(), "20s");
    await speed.fill("1");
    await button(page, "Run").click();
    await page.getByTestId("run-state").getByText("Running").waitFor();
    await button(page, "Stop").click();
    await page.getByTestId("run-state").getByText("Ended — stopped").waitFor();
  }));
