import assert from "node:assert/strict";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { test } from "node:test";
import { button, drawn, example, find, onBuiltNet, tab, until } from "./page.mjs";

const lineFollower = example("01_line_follower");

test("a recording that is too long to be sent at once is looked at from its first moment to its last", () =>
  onBuiltNet(lineFollower, async (page) => {
    await tab(page, "Run").click();
    await page.getByRole("textbox", { name: "Speed" }).fill("0");
    await page.getByRole("textbox", { name: "For" }).fill("600s");
    await button(page, "Run").click();
    await page.getByTestId("run-state").getByText("Ended").waitFor();
    const firings = /([\d,]+) firings/.exec(await page.locator(".run-panel").innerText())[1];
    await button(page, "Close this run").click();
    await tab(page, "Recordings").click();
    await page.locator(".recordings button").first().click();
    const slider = page.getByRole("slider", { name: "Time" });
    await slider.waitFor();
    const position = () => page.locator(".player .position").innerText();
    const facts = () => page.getByTestId("run-facts").innerText();
    assert.ok(Number(firings.replaceAll(",", "")) > 300_000);
    const last = Number(await slider.getAttribute("max"));
    for (const part of [1, 0.5, 0]) {
      await slider.fill(String(last * part));
      await until(page, async () => !(await position()).includes("loading"), "the part with that moment");
      assert.ok(Math.abs(parseFloat(await position()) - (last * part) / 1e9) < 0.1, await position());
      assert.ok((await facts()).includes(`${firings} firings`), await facts());
      await page.locator(".react-flow").getByText("follow").first().waitFor();
    }
    // The slider goes from one edge of the window to the other.
    const { width } = await slider.boundingBox();
    assert.ok(width > 0.95 * 1440, `${width} px`);
    // The address names the shown time: it opens the same view for another person.
    await slider.fill(String(last * 0.73));
    const link = await until(page, () => Math.abs(momentOf(page) - last * 0.73) < 1e6 && page.url(), "the moment in the address");
    await page.reload();
    await slider.waitFor();
    await until(page, async () => Math.abs(Number(await slider.inputValue()) - last * 0.73) < 1e6, "the same moment");
    assert.equal(page.url(), link);
    // Going back in time within the tab is a change of the address, too.
    await page.evaluate((to) => (location.hash = to), new URL(link).hash.replace(/([#&])t=[^&]*/, "$1t=12.5"));
    await until(page, async () => Number(await slider.inputValue()) === 12.5e9, "the moment of the other link");
  }));

/** The time in the address of the page, in nanoseconds. */
const momentOf = (page) => 1e9 * Number(new URLSearchParams(new URL(page.url()).hash.slice(1)).get("t") ?? NaN);

test("a recording is saved as a film that shows the same without the studio", () =>
  onBuiltNet(lineFollower, async (page, _server, open) => {
    await tab(page, "Run").click();
    await page.getByRole("textbox", { name: "Speed" }).fill("0");
    await page.getByRole("textbox", { name: "For" }).fill("6s");
    await button(page, "Run").click();
    await page.getByTestId("run-state").getByText("Ended").waitFor();
    await button(page, "Close this run").click();
    await tab(page, "Recordings").click();
    await page.locator(".recordings button").first().click();
    const slider = page.getByRole("slider", { name: "Time" });
    await slider.waitFor();
    await find(page, "robot.control");
    await until(page, async () => (await page.locator(".sheet [data-place]").count()) > 6, "the net of the subsystem");
    await drawn(page);
    await page.getByRole("slider", { name: "Time" }).fill(String(0.25e9));
    await button(page, "Film").click();
    const dialog = page.getByRole("dialog", { name: "Save a film" });
    // It begins at the moment shown, and tells what cannot be.
    const from = dialog.getByRole("textbox", { name: "From" });
    assert.equal(await from.inputValue(), "0.25");
    await from.fill("7");
    await dialog.getByText("From and to are times between").waitFor();
    assert.ok(await button(dialog, "Save film").isDisabled());
    await from.fill("0.25");
    const saved = page.waitForEvent("download");
    await button(dialog, "Save film").click();
    const film = await open();
    const file = join(mkdtempSync(join(tmpdir(), "film-")), "film.html");
    assert.match((await saved).suggestedFilename(), /_0\.25s-[\d.]+s\.html$/);
    await (await saved).saveAs(file);
    // It plays by itself, and stands still for those who have asked for less motion.
    await film.goto(`file://${file}`);
    await button(film, "Play").waitFor();
    await film.emulateMedia({ reducedMotion: "no-preference" });
    await film.reload();
    await until(film, async () => parseFloat(await film.locator("#time").innerText()) > 0.4, "it plays by itself");
    await film.keyboard.press("End");
    await button(film, "Play").waitFor();
    // The world is in it: its picture has more than one colour, and changes.
    const seen = () =>
      film.locator("#world").evaluate((canvas) => {
        const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
        return { colours: new Set(new Uint32Array(data.buffer)).size, picture: canvas.toDataURL() };
      });
    const atEnd = await until(
      film,
      async () => (({ colours, ...one }) => colours > 5 && one)(await seen()),
      "a picture of the world",
    );
    await film.keyboard.press("Home");
    await until(film, async () => (await seen()).picture !== atEnd.picture, "another picture of the world");
    const tokens = (on) =>
      on.evaluate(() =>
        [...document.querySelectorAll("[data-place]")]
          .filter((group) => getComputedStyle(group).display !== "none")
          .map((group) => group.getAttribute("data-place"))
          .sort()
          .join(),
      );
    const first = 0.25e9;
    for (const seconds of [0.5, 3.21, 5.9, 1.7]) {
      await slider.fill(String(seconds * 1e9));
      await film.getByRole("slider", { name: "Position" }).fill(String(seconds - first / 1e9));
      const there = await tokens(film);
      assert.ok(there.length > 0);
      await until(page, async () => (await tokens(page)) === there, `the tokens of ${seconds} s: ${there}`);
    }
    await film.getByRole("button", { name: "Play" }).click();
    await until(film, async () => parseFloat(await film.locator("#time").innerText()) > 1.9, "it plays");
    await film.getByRole("button", { name: "Pause" }).click();
    const now = await film.locator("#time").innerText();
    // Several firings may have the same time, as far as the page writes it.
    await until(
      film,
      async () => {
        await film.getByRole("button", { name: "One firing on" }).click();
        return (await film.locator("#time").innerText()) !== now;
      },
      "a firing at another time",
    );
    assert.match(await film.locator("#last").innerText(), /robot\./);
    if (process.env.PICTURES) await film.screenshot({ path: `${process.env.PICTURES}/film.png` });
    rmSync(dirname(file), { recursive: true });
  }));

/** The part of the world's picture that is path. */
const pathDrawn = (page) =>
  page.getByRole("img", { name: "The robot's path from above" }).evaluate((canvas) => {
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let found = 0;
    for (let at = 0; at < data.length; at += 4) if (data[at + 3] > 128 && data[at + 2] > data[at] + 80) found += 1;
    return found;
  });

test("the robot's path is there after a reload, and in the recording up to the moment shown", () =>
  onBuiltNet(lineFollower, async (page) => {
    await tab(page, "Run").click();
    await page.getByRole("textbox", { name: "Speed", exact: true }).fill("5");
    await page.keyboard.press("Enter");
    await button(page, "Run").click();
    await page.locator(".running-now").getByText("follow").waitFor();
    await button(page, "3D").click();
    await until(page, async () => (await pathDrawn(page)) > 150, "a path");
    await button(page, "Pause").click();
    await page.getByTestId("run-state").getByText("Paused").waitFor();
    await drawn(page);
    const before = await pathDrawn(page);
    await page.reload();
    await tab(page, "Run").click();
    await page.getByTestId("run-state").getByText("Paused").waitFor();
    await until(page, async () => (await pathDrawn(page)) > 0.8 * before, "the path of before");
    // The values from before stay, although none changes while the run stands.
    await page.locator(".watch-pane.values").getByText("robot.control.motion.linear").waitFor();
    await button(page, "Stop").click();
    await page.getByTestId("run-state").getByText("Ended").waitFor();
    await button(page, "Close this run").click();
    await tab(page, "Recordings").click();
    await page.locator(".recordings button").first().click();
    const slider = page.getByRole("slider", { name: "Time" });
    const last = Number(await slider.getAttribute("max"));
    const at = async (part) => {
      await slider.fill(String(last * part));
      await page.getByText(`${((last * part) / 1e9).toFixed(2)} s ·`).waitFor();
      await drawn(page);
      await drawn(page);
      return pathDrawn(page);
    };
    const whole = await at(1);
    const half = await at(0.5);
    // The line of a recording has a row more, so that the world is smaller.
    assert.ok(whole > 0.6 * before && half > 0.2 * whole && half < 0.8 * whole, `${before} before, ${half} of ${whole}`);
    assert.ok((await at(0)) < 0.3 * half);
    assert.ok((await at(1)) > 0.9 * whole);
  }));

test("after a reload the run and the unsaved text are there again", () =>
  onBuiltNet(lineFollower, async (page) => {
    await tab(page, "Run").click();
    await button(page, "Run").click();
    await page.locator(".running-now").getByText("follow").waitFor();
    await tab(page, "Structure").click();
    await page.locator('[data-path="robot.motor"]').click();
    await page.getByRole("textbox", { name: "Rate" }).fill("40 Hz");
    await page.keyboard.press("Enter");
    await page.reload();
    await page.getByTestId("editor").getByText("40 Hz").waitFor();
    await tab(page, "Run").click();
    await page.locator(".running-now").getByText("follow").waitFor();
  }));

test("of a run that is too fast to be drawn, all firings are counted, and the page says how many were not shown", () =>
  onBuiltNet(lineFollower, async (page) => {
    await tab(page, "Run").click();
    for (const [label, value] of [
      ["For", "6min"],
      ["Speed", "0"],
    ]) {
      await page.getByRole("textbox", { name: label, exact: true }).fill(value);
      await page.keyboard.press("Enter");
    }
    await button(page, "Run").click();
    const facts = page.getByTestId("run-facts");
    await facts.getByText(/only counted/).waitFor();
    // The page responds meanwhile: another layer is drawn while firings come.
    await find(page, "robot.control.follow");
    await page.locator('[data-sheet="robot.control.follow"]').waitFor();
    await page.getByTestId("run-state").getByText("Ended").waitFor();
    await drawn(page);
    const number = (pattern, text) => Number(pattern.exec(text)[1].replaceAll(",", ""));
    const outcome = number(/([\d,]+) firings/, await page.locator(".run-panel").innerText());
    await until(page, async () => number(/([\d,]+) firings/, await facts.innerText()) === outcome, "as many as there were");
    const dropped = number(/([\d,]+) only counted/, await facts.innerText());
    assert.ok(outcome > 100_000 && dropped > 0 && dropped < outcome, `${dropped} of ${outcome}`);
    // For each transition, it knows the least number of firings.
    const shown = await page.locator('[data-sheet="robot.control.follow"] .firings').allTextContents();
    assert.ok(shown.some((text) => /^≥/.test(text)) && !shown.some((text) => /^×/.test(text)), shown.join());
  }));

test("the longest reaction of a recording is measured, drawn, and marked at its moment, though nothing is proved", () =>
  onBuiltNet(lineFollower, async (page) => {
    await tab(page, "Structure").click();
    await tab(page, "Run").click();
    await page.getByRole("textbox", { name: "Speed" }).fill("0");
    await page.getByRole("textbox", { name: "For" }).fill("2s");
    await button(page, "Run").click();
    await page.getByTestId("run-state").getByText("Ended").waitFor();
    // The recording of the run that has ended is measured without being opened.
    await button(page, "Panels").click();
    await page.getByRole("menuitemcheckbox", { name: "Timing" }).click();
    const show = page.getByRole("button", { name: /^Show the longest reaction: [\d.]+ ms$/ });
    await show.waitFor();
    await show.press("Enter");
    const worst = page.getByRole("region", { name: "The longest reaction in the recording" });
    await worst.getByRole("img", { name: /^The run from the event to the command/ }).waitFor();
    const parts = await worst.getByRole("list", { name: "The parts of the time" }).locator(".ns").allInnerTexts();
    assert.ok(parts.length > 2, parts.join());
    const [, from, to] = /from ([\d.]+) s to ([\d.]+) s/.exec(await worst.getByRole("heading").innerText());
    await until(page, () => Math.abs(momentOf(page) / 1e9 - Number(from)) < 0.001, "the moment of the event");
    await button(page, "To its end").press("Enter");
    await until(page, () => Math.abs(momentOf(page) / 1e9 - Number(to)) < 0.001, "the moment of the command");
  }));
