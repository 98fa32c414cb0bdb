// A recording beside the run, and beside another recording.
import assert from "node:assert/strict";
import { test } from "node:test";
import { button, drawn, element, example, judges, onBuiltNet, tab, until } from "./page.mjs";

const fill = async (page, label, value) => {
  await page.getByRole("textbox", { name: label, exact: true }).fill(value);
  await page.keyboard.press("Enter");
};
const panes = (page) => page.locator(".net-pane");
const looks = (page) => page.locator(".react-flow__viewport").evaluateAll((all) => all.map((one) => one.style.transform));
const seconds = (text) => Number(/[\d.]+/.exec(text)[0]);
const differing = (page) => page.getByRole("list", { name: "Subsystems that differ" });
const ended = async (page, title) => {
  await button(page, "Run").click();
  await page.getByTestId("run-state").getByText("Ended").waitFor();
  await tab(page, title).click();
};

/** A run over the gap is recorded, and one over a line without a gap is shown. */
async function twoRuns(page) {
  await tab(page, "Run").click();
  await fill(page, "For", "12s");
  await fill(page, "Speed", "20");
  await ended(page, "Run");
  await fill(page, "Speed", "4"); // a busy page misses events of a faster run, and does not compare it
  await page.getByRole("combobox", { name: "Track" }).selectOption("oval.png");
  await ended(page, "Recordings");
}

test("a recording beside the run: one camera, one time if wanted, and what differs is said", () =>
  onBuiltNet(example("02_gap"), async (page) => {
    await twoRuns(page);
    await page.locator(".recordings > li > button:first-child").last().click();
    const compared = page.getByTestId("compared-at");
    await compared.waitFor();
    assert.equal(await panes(page).count(), 2);
    assert.equal(await page.locator(".watch-pane.timeline").count(), 2);

    const objections = [];
    const judge = await judges(page, objections);
    for (const theme of ["light", "dark"]) {
      await judge(`${theme}, side by side`);
      await button(page, "Dark colours").click();
    }
    assert.deepEqual(objections, []);

    // The slider moves the recording alone.
    const slider = page.getByRole("slider", { name: "Time" });
    const last = Number(await slider.getAttribute("max"));
    await slider.fill(String(last / 2));
    await until(page, async () => seconds(await compared.innerText()) > 5, "the comparison at the slider's time");
    let found = "";
    for (let at = 0; at <= 40 && !found; at += 1) {
      await slider.fill(String((last * at) / 40));
      const time = (last * at) / 40 / 1e9;
      await until(page, async () => Math.abs(seconds(await compared.innerText()) - time) < 0.3, `a comparison at ${time} s`);
      found = (await differing(page).count()) ? await differing(page).innerText() : "";
    }
    assert.match(found, /robot\.control/);
    assert.match(found, /search/);

    // The switch holds it at the run's time.
    await page.getByRole("switch", { name: "Same time" }).check();
    const run = page.getByTestId("line-time").first();
    const recording = page.getByRole("group", { name: /^Recording/ }).locator(".position");
    await until(
      page,
      async () => Math.abs(seconds(await run.innerText()) - seconds(await recording.innerText())) < 0.1,
      "the time of the run",
    );
    assert.ok(await slider.isDisabled());

    // Both panes show the same part, and a page folded in one is folded in both.
    const [before] = await looks(page);
    const right = await panes(page).nth(1).boundingBox();
    await page.mouse.move(right.x + right.width / 2, right.y + right.height / 2);
    await page.mouse.wheel(0, -300);
    await until(page, async () => (await looks(page))[0] !== before, "the left drawing is moved by the right one");
    await drawn(page);
    const [one, other] = await looks(page);
    assert.equal(one, other);
    await page.keyboard.press("Control+k");
    await page.getByRole("combobox", { name: "Path" }).fill("robot.control");
    await page.keyboard.press("Enter");
    await button(page, "Fold control").click();
    await until(page, async () => (await page.locator('.page.folded[data-path="robot.control"]').count()) === 2, "both folded");

    // Without the run, the recording has the space for itself; another recording can be put beside it.
    await page.getByRole("button", { name: /^Close Run/ }).click();
    await until(page, async () => (await panes(page).count()) === 1, "one pane");
    await page
      .getByRole("button", { name: /^Show .* beside/ })
      .first()
      .click();
    await until(page, async () => (await panes(page).count()) === 2, "two recordings");
    await page.getByRole("switch", { name: "Same time" }).check();
    const sliders = page.getByRole("slider", { name: "Time" });
    await sliders.first().fill(String(last / 4));
    await until(
      page,
      async () => Math.abs(Number(await sliders.nth(1).inputValue()) - last / 4) < 1e8,
      "the right recording follows the left one",
    );
    await page
      .getByRole("button", { name: /^Close 2/ })
      .first()
      .click();
    await button(page, "Close").click();
    await until(page, async () => (await page.locator(".watch-pane.timeline").count()) === 0, "the drawing of the text");
  }));

test("a run that goes on is put away and shown again; a game has the drawing for itself", () =>
  onBuiltNet(example("01_line_follower"), async (page) => {
    await tab(page, "Run").click();
    await button(page, "Run").click();
    await page.locator(".running-now").getByText("follow").waitFor();
    await tab(page, "Recordings").click();
    await page.locator(".recordings button").first().click();
    await page.getByRole("button", { name: /^Close Run/ }).click();
    await button(page, "Close").click();
    await until(page, async () => (await page.locator(".watch-pane.timeline").count()) === 0, "nothing is watched");
    await tab(page, "Run").click();
    await page.getByTestId("run-state").getByText("Running").waitFor();
    await button(page, "Show it in the drawing").click();
    await page.locator(".watch-pane.timeline").waitFor();
    await tab(page, "Play").click();
    await button(page, "Play the token game").click();
    await element(page, "t_in").click();
    await page.getByText("1 / 1").waitFor();
    assert.equal(await page.locator(".watch-pane.timeline").count(), 0);
    await button(page, "Close").click();
    await page.locator(".watch-pane.timeline").waitFor();
    await element(page, "robot.control").locator(".running").getByText("follow").waitFor();
    // A recording that is opened during a game ends the game.
    await button(page, "Play the token game").click();
    await tab(page, "Recordings").click();
    await page.locator(".recordings button").first().click();
    await until(page, async () => (await panes(page).count()) === 2, "the run and the recording");
  }));
