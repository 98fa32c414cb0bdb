import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { test } from "node:test";
import { button, example, onBuilt, tab, until } from "./page.mjs";

const lineFollower = example("01_line_follower");

/** Runs it as fast as possible for some seconds; returns when it has ended. */
async function run(page, seconds, seed) {
  await tab(page, "Run").click();
  for (const [label, value] of [
    ["Speed", "0"],
    ["For", `${seconds}s`],
    ["Seed", String(seed)],
  ])
    await page.getByRole("textbox", { name: label, exact: true }).fill(value);
  await page.keyboard.press("Enter");
  await page.getByRole("button", { name: "Run", exact: true }).last().click();
  await page.getByTestId("run-state").getByText("Ended").first().waitFor();
  await button(page, "Close this run").click();
}

async function addToPlot(page, title) {
  const filter = page.getByRole("textbox", { name: "Values whose path contains" });
  await filter.fill(title);
  await page.locator(".value-list li button").getByText(title, { exact: true }).click();
  await filter.fill("");
}

/** The cells of the table below the plot, by the name of the signal and the title of the column. */
const facts = (page) =>
  page.locator(".plot-table table").evaluate((table) => {
    const titles = [...table.tHead.rows[0].cells].map((cell) => cell.innerText);
    const cells = (row) => Object.fromEntries([...row.cells].map((cell, at) => [titles[at], Number(cell.innerText)]));
    return Object.fromEntries([...table.tBodies[0].rows].map((row) => [row.cells[0].innerText.trim(), cells(row)]));
  });

async function saved(page, name) {
  const file = page.waitForEvent("download");
  await page.locator(".plot-tools").getByRole("button", { name, exact: true }).click();
  return readFileSync(await (await file).path());
}

test("signals of a recording are plotted, measured, kept and saved; two recordings are compared by their values", () =>
  onBuilt(lineFollower, async (page) => {
    await run(page, 8, 1);
    await run(page, 8, 2);
    await tab(page, "Recordings").click();
    const rows = page.locator(".recordings > li > button:first-child");
    await until(page, async () => (await rows.count()) >= 2, "two recordings");
    await rows.first().click();
    await page.locator(".value-list li").first().waitFor();
    // A new user looks for what is slow: each input has an age and a rate.
    await addToPlot(page, "robot.control.motion.linear");
    await addToPlot(page, "age of robot.control.line");
    await addToPlot(page, "rate of robot.control.line");
    await addToPlot(page, "behaviour of robot.control");
    await page.getByRole("img", { name: "Plot of robot.control.motion.linear, age of robot.control.line in m/s" }).waitFor();
    await page.getByRole("img", { name: "Plot of rate of robot.control.line in 1/s" }).waitFor();
    await page.getByRole("img", { name: "Plot of behaviour of robot.control" }).waitFor();
    const all = await facts(page);
    // The control reads at 20 Hz.
    const age = all["age of robot.control.line"].max;
    assert.ok(age > 0.02 && age < 0.11, `greatest age: ${age}`);
    assert.ok(Math.abs(all["age of robot.control.line"]["per s"] - 20) < 1);
    const rate = all["rate of robot.control.line"].mean;
    assert.ok(Math.abs(rate - 20) < 1, `mean rate: ${rate}`);
    // Cursors by hand and in numbers.
    await page.getByRole("spinbutton", { name: "Cursor A in seconds" }).fill("2");
    await page.getByRole("spinbutton", { name: "Cursor B in seconds" }).fill("2.5");
    await page.getByTestId("cursor-difference").getByText("0.5 s").waitFor();
    assert.ok((await page.locator(".plot-table thead").innerText()).includes("B − A"));
    // The keyboard zooms and moves; fewer values are visible then.
    const count = async () => (await facts(page))["age of robot.control.line"].count;
    const whole = await count();
    await page.getByRole("group", { name: /^Plot\. Arrows move it/ }).focus();
    await page.keyboard.press("+");
    await page.keyboard.press("+");
    await until(page, async () => (await count()) < whole / 3, "a quarter of the values");
    await page.keyboard.press("Home");
    await until(page, async () => (await count()) === whole, "all values again");
    // The legend hides a curve, and the picture has one less.
    await page.locator(".legend").getByText("robot.control.motion.linear").click();
    await page.getByRole("img", { name: "Plot of age of robot.control.line, rate of robot.control.line in s" }).waitFor();
    await page.locator(".legend").getByText("robot.control.motion.linear").click();
    const csv = (await saved(page, "CSV")).toString();
    assert.match(csv, /^time_s,robot\.control\.motion\.linear \[m\/s\],age of robot\.control\.line \[s\],/);
    assert.ok(csv.split("\n").length > 100);
    assert.equal((await saved(page, "PNG")).subarray(1, 4).toString(), "PNG");
    assert.match((await saved(page, "SVG")).toString(), /^<svg .*<path d="M/s);
    await page.evaluate(readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8"));
    const found = await page.evaluate(() => globalThis.axe.run(".plot-panel"));
    assert.deepEqual(
      found.violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html)}`),
      [],
    );
    // A name, a note and a mark are kept beside the recording, and found again.
    const first = await rows.first().locator(".name").innerText();
    await button(page, `Notes of ${first}`).click();
    await page.getByLabel("Name", { exact: true }).fill("slow start");
    await page.keyboard.press("Enter");
    await page.locator(".recordings .name").getByText("slow start").waitFor();
    await page.getByRole("slider", { name: "Time" }).fill("3000000000");
    await page.getByRole("textbox", { name: "Text of the mark" }).fill("first curve");
    await page.keyboard.press("Enter");
    await page.getByRole("list", { name: "Marks of slow start" }).getByText("first curve").waitFor();
    await page.getByRole("searchbox", { name: "Recordings whose name or note has" }).fill("curve");
    assert.equal(await rows.count(), 1);
    await page.getByRole("searchbox", { name: "Recordings whose name or note has" }).fill("");
    // Another seed has other noise of the sensors: the values differ.
    await page
      .locator(".recordings > li")
      .nth(1)
      .getByRole("button", { name: /^Show .* beside slow start$/ })
      .click();
    await button(page, "First value that differs").click();
    await page
      .locator(".first-value")
      .getByText(/differs first at \d+\.\d\d s/)
      .waitFor();
    await button(page, "Go there").click();
    await until(page, async () => (await page.locator(".plot-table tbody tr").count()) >= 8, "both runs in the plot");
    // After a reload the plot is there again.
    await page.reload();
    await page.locator(".legend").getByText("age of robot.control.line").first().waitFor();
  }));

test("a sweep of a parameter has a curve, refuses wrong values in place, and goes on where it was", () =>
  onBuilt(example("05_depot"), async (page) => {
    await tab(page, "Recordings").click();
    await page.getByText("Many runs: vary a parameter or the seed").click();
    const form = page.locator(".sweep-form");
    await form.getByLabel("Parameter").selectOption("carrier[*].control.dock");
    const fill = async (values) => {
      for (const [label, value] of Object.entries(values)) await form.getByLabel(label).fill(value);
    };
    await fill({ From: "0.5", To: "far", Values: "3", "Runs of each": "2", "Run for": "2s" });
    await button(page, "Start the runs").click();
    await form.getByText("at least 1").last().waitFor();
    assert.ok((await form.locator(".problem-hint").allInnerTexts()).some((text) => text.startsWith("a number")));
    await fill({ From: "1", To: "2" });
    await button(page, "Start the runs").click();
    const status = page.locator(".sweep-result [role=status]");
    await status.getByText("6 of 6 runs, done").waitFor();
    await page.getByRole("img", { name: /over carrier\[\*\]\.control\.dock$/ }).waitFor();
    const results = page.getByRole("region", { name: "Results of the runs" }).locator("tbody tr");
    assert.equal(await results.count(), 3);
    await fill({ "Runs of each": "3" });
    await button(page, "Start the runs").click();
    await status.getByText("9 of 9 runs, done, 6 from an earlier sweep").waitFor();
    // Only the seeds differ: a distribution.
    await form.getByLabel("Parameter").selectOption("");
    await button(page, "Start the runs").click();
    await status.getByText(/^seeds: 3 of 3 runs, done/).waitFor();
    await page.getByRole("img", { name: /^Runs by / }).waitFor();
  }));
