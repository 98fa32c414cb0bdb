// A robot whose reaction is too slow is found, explained and mended in the page alone.
import assert from "node:assert/strict";
import { test } from "node:test";
import { button, changes, draftText, folder, judges, noProblems, onPage, tab, until } from "./page.mjs";

const chain = "catch the cup";

/** Verifies the text, and opens the chain from its verdict. */
async function openFromVerdict(page) {
  await button(page, "Verify the system").click();
  const verdict = page.getByRole("region", { name: "Times" }).getByRole("button", { name: chain });
  await verdict.getByRole("img", { name: "violated" }).waitFor();
  await page.getByTestId("step-verify").getByText("1 time too long").waitFor();
  await verdict.click();
  await page.getByRole("region", { name: chain }).waitFor();
}

test("a reaction that is too slow is found by Verify, explained by its parts, and mended by a rate", () =>
  onPage(folder("slow_arm"), async (page, server) => {
    const before = server.text();
    await noProblems(page);
    await openFromVerdict(page);
    const shown = page.getByRole("region", { name: chain });

    // The chain is marked in the drawing, in its order.
    const marked = page.getByTestId("chain").locator("[data-chain]");
    assert.deepEqual(await marked.evaluateAll((all) => all.map((one) => one.dataset.chain)), [
      "arm.camera",
      "arm.control",
      "arm.motors",
    ]);

    // The parts add up to the reaction.
    const row = page.getByRole("row", { name: chain });
    const reaction = Number.parseFloat(await row.getByRole("cell").nth(1).innerText());
    const parts = await shown.locator(".budget").first().locator(".ns").allInnerTexts();
    assert.equal(
      parts.reduce((sum, text) => sum + Number.parseFloat(text), 0),
      reaction,
    );
    assert.ok(reaction > 150, `${reaction} ms`);

    // Another rate is tried by the keys alone; nothing is written.
    const slider = page.getByRole("slider", { name: "arm.control", exact: true });
    await slider.focus();
    for (let step = 0; step < 4; step += 1) await page.keyboard.press("ArrowRight");
    assert.equal(await slider.getAttribute("aria-valuetext"), "40 Hz");
    const faster = await until(
      page,
      async () => {
        const text = await row
          .getByRole("cell")
          .nth(1)
          .locator("strong")
          .innerText({ timeout: 100 })
          .catch(() => "");
        return text && Number.parseFloat(text) <= 150 && text;
      },
      "the reaction with the new rate",
    );
    assert.equal(await draftText(page), undefined);

    // One button writes it, and the chain holds.
    await button(page, "Write the new rate").click();
    await row.getByRole("img", { name: "holds" }).waitFor();
    assert.equal(await row.getByRole("cell").nth(1).locator("span").first().innerText(), faster);
    assert.deepEqual(changes(before, await draftText(page)), ["-      rate: 10 Hz", "+      rate: 40 Hz"]);
    await button(page, "Verify the system").click();
    await page
      .getByRole("region", { name: "Times" })
      .getByRole("button", { name: chain })
      .getByRole("img", { name: "holds" })
      .waitFor();

    // Undo is one step.
    await button(page, "Undo").click();
    await noProblems(page);
    assert.equal(await draftText(page), undefined);
  }));

test("the slowest run is drawn over time, and a shorter call is tried and written, by the keys alone", () =>
  onPage(folder("slow_arm"), async (page, server) => {
    const before = server.text();
    await noProblems(page);
    await openFromVerdict(page);
    await button(page, "Show the slowest run").press("Enter");
    const run = page.getByRole("region", { name: "The slowest run" });
    await run.getByRole("img", { name: /^The run from the event to the command: \d+ ms$/ }).waitFor();
    const parts = run.getByRole("list", { name: "The parts of the time" });
    const sum = async () => (await parts.locator(".ns").allInnerTexts()).reduce((all, text) => all + Number.parseFloat(text), 0);
    const reaction = page.getByRole("row", { name: chain }).getByRole("cell").nth(1);
    // The run of this chain reaches its bound: its parts are all of it.
    assert.equal(await sum(), Number.parseFloat(await reaction.innerText()));
    await run.getByText("as long as any can").waitFor();
    await button(page, "Age").press("Enter");
    await run.getByRole("img", { name: /^The run from the reading/ }).waitFor();

    const slider = page.getByRole("slider", { name: "arm.control: its calls take at most" });
    await slider.focus();
    for (let step = 0; step < 3; step += 1) await page.keyboard.press("ArrowLeft");
    assert.equal(await slider.getAttribute("aria-valuetext"), "10 ms");
    await page.getByText("With arm.control with calls of 10 ms at most").waitFor();
    // The slider is not below what stands over the end of the panel.
    const isSeen = () =>
      slider.evaluate((one) => {
        const { left, top, width, height } = one.getBoundingClientRect();
        return document.elementFromPoint(left + width / 2, top + height / 2) === one;
      });
    await until(page, isSeen, "the slider in sight");
    const complaints = [];
    const judge = await judges(page, complaints);
    await judge("the slowest run, and other times that are tried");
    assert.deepEqual(complaints, []);
    await button(page, "Write the new time").press("Enter");
    await until(page, async () => (await draftText(page)) !== undefined, "the new time in the text");
    assert.deepEqual(changes(before, await draftText(page)), [
      "-      behaviours: { reach: { takes: 5..20 ms } }",
      "+      behaviours: { reach: { takes: 5..10 ms } }",
    ]);
  }));

test("the change that helps most is computed and applied; axe has no complaint about the panel", () =>
  onPage(folder("slow_arm"), async (page, server) => {
    const before = server.text();
    await noProblems(page);
    await openFromVerdict(page);
    await button(page, "Find what helps most").click();
    const helpful = page.getByRole("list", { name: "Changes that help" });
    const first = helpful.getByRole("listitem").first();
    const promised = /Reaction [\d.]+ ms → ([\d.]+ ms)/.exec(await first.innerText())[1];
    const complaints = [];
    const judge = await judges(page, complaints);
    await judge("the panel Timing");
    assert.deepEqual(complaints, []);
    await first.getByRole("button").click();
    const reaction = page.getByRole("row", { name: chain }).getByRole("cell").nth(1);
    await until(page, async () => (await reaction.locator("span").first().innerText()) === promised, "the promised reaction");
    assert.notDeepEqual(changes(before, await draftText(page)), []);

    // A limit is asked in the panel, too.
    await page.getByLabel("Age at most").fill("1 ms");
    await page.keyboard.press("Enter");
    await page.getByRole("row", { name: chain }).getByRole("cell").nth(0).getByText("asked: 1 ms").waitFor();
    assert.match(await draftText(page), /age: 1 ms/);
    await tab(page, "Timing").waitFor();
  }));
