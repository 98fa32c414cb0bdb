// Work by hand on elements of the structure: keys, menu, clipboard, arrows, moved boxes.
import assert from "node:assert/strict";
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { button, changes, checked, draftText, example, folder, judges, middleOf, onPage, until } from "./page.mjs";

const lineFollower = example("01_line_follower");

const at = (page, path) => page.locator(`[data-path="${path}"]`).first();
const selected = (page) => page.evaluate(() => new URLSearchParams(location.hash.slice(1)).get("at"));
const selects = (page, path) => until(page, async () => (await selected(page)) === path, `${path} is selected`);
const has = (page, text) => until(page, async () => (await draftText(page))?.includes(text), `the text has ${text}`);

async function drag(page, from, to) {
  const [a, b] = [await from.boundingBox(), await to.boundingBox()];
  await page.mouse.move(a.x + a.width / 2, a.y + a.height / 2);
  await page.mouse.down();
  await page.mouse.move(b.x + b.width / 2, b.y + b.height / 2, { steps: 4 });
  await page.mouse.up();
}

test("the keyboard alone reaches, copies, links and removes elements, and the menu shows what can be done", () =>
  onPage(lineFollower, async (page, server) => {
    const before = server.text();
    // A text that is not changed is kept in no draft.
    const now = async () => (await draftText(page)) ?? before;
    await at(page, "robot").focus();
    await page.keyboard.press("Enter");
    await selects(page, "robot");
    await page.keyboard.press("Enter");
    await selects(page, "robot.control");
    await page.keyboard.press("ArrowRight");
    await selects(page, "robot.motor");
    await page.keyboard.press("ArrowLeft");
    await selects(page, "robot.control");
    await page.keyboard.press("Enter");
    await selects(page, "robot.control.init");
    await page.keyboard.press("Enter");
    await selects(page, "next:robot.control.init#0");
    await page.locator(".next-entry.chosen").waitFor();
    await page.keyboard.press("Escape");
    await selects(page, "robot.control.init");

    await page.keyboard.press("Control+d");
    await selects(page, "robot.control.init_2");
    assert.deepEqual(changes(before, await now()), ["+        init_2:   { terminal: true, next: follow }"]);
    await checked(page);
    await page.keyboard.press("Control+z");
    await until(page, async () => (await now()) === before, "the copy is undone");

    await at(page, "robot.control.follow").click();
    await page.keyboard.press("Shift+F10");
    const menu = page.getByRole("menu");
    const found = [];
    await (
      await judges(page, found)
    )();
    assert.deepEqual(found, []);
    await page.keyboard.press("End");
    await page.keyboard.press("ArrowDown");
    assert.equal(await page.evaluate(() => document.activeElement.textContent), "Add what follows…");
    await page.keyboard.press("Enter");
    await menu.waitFor({ state: "detached" });
    const form = page.getByRole("form", { name: "After follow" });
    await form.getByRole("combobox", { name: "goes on with" }).selectOption("init");
    await form
      .getByRole("combobox", { name: "when" })
      .or(form.getByRole("textbox", { name: "when" }))
      .fill("in.line.left");
    await (
      await judges(page, found)
    )();
    assert.deepEqual(found, []);
    await page.keyboard.press("Enter");
    await selects(page, "next:robot.control.follow#0");
    assert.match(await now(), /follow:\n +terminal: in\.line\.left\n +next: init/);

    // Elements that others use are listed first, and stays if the user says so.
    await page.keyboard.press("Control+z");
    await until(page, async () => (await now()) === before, "the entry is undone");
    await at(page, "robot.control.follow").click();
    await page.keyboard.press("Delete");
    const question = page.getByRole("dialog", { name: "Remove behaviour follow?" });
    assert.match(await question.innerText(), /next: follow/);
    await question.getByRole("button", { name: "Keep it" }).click();
    assert.equal(await now(), before);
    await page.keyboard.press("Delete");
    await question.getByRole("button", { name: "Remove all of it" }).click();
    await until(page, async () => /receptors/.test(await now()) && !/follow:/.test(await now()), "the behaviour is removed");
  }));

test("an arrow is dragged from behaviour to behaviour, selected by a click, and removed", () =>
  onPage(lineFollower, async (page, server) => {
    const before = server.text();
    // A text that is not changed is kept in no draft.
    const now = async () => (await draftText(page)) ?? before;
    const [init, follow] = [at(page, "robot.control.init"), at(page, "robot.control.follow")];
    await follow.waitFor();
    await drag(page, follow, init);
    const form = page.getByRole("form", { name: "After follow" });
    await form.waitFor();
    await page.keyboard.press("Escape");
    await form.waitFor({ state: "detached" });
    assert.equal(await now(), before);
    await drag(page, follow, init);
    await form.waitFor();
    await page.keyboard.type("error");
    await page.keyboard.press("Enter");
    await selects(page, "next:robot.control.follow#0");
    const arrow = page.locator('.arrow[data-from="robot.control.init"][data-entry="0"]');
    await until(page, async () => (await page.locator(".arrow[data-entry]").count()) === 2, "both arrows are drawn");
    // The middle of the line itself: that of its box may be beside it.
    const middle = await arrow.locator(".arrow-reach").evaluate((path) => {
      const { x, y } = path.getPointAtLength(path.getTotalLength() / 2).matrixTransform(path.getScreenCTM());
      return { x, y };
    });
    await page.mouse.click(middle.x, middle.y);
    await selects(page, "next:robot.control.init#0");
    await page.locator(".next-entry.chosen").waitFor();
    await page.keyboard.press("Delete");
    await until(page, async () => !/init:.*follow/.test(await now()), "the entry is removed");
  }));

test("an element is pasted in the page of another project, and in the same tab without the clipboard", () =>
  onPage(lineFollower, async (page) => {
    await page.setViewportSize({ width: 1920, height: 1000 }); // all of it stays in the drawing
    await at(page, "robot.sensor").click();
    await page.keyboard.press("Shift+F10");
    await page.getByRole("menuitem", { name: "Paste" }).click();
    await page.getByText("This browser does not let a menu read the clipboard: press Ctrl V").waitFor();
    await at(page, "robot.sensor").click();
    await page.keyboard.press("Control+c");
    await page.getByText("Copied: virtual receptor sensor").waitFor();
    await onPage(folder("orchard"), async (other) => {
      await at(other, "carrier").click();
      await other.keyboard.press("Control+v");
      await selects(other, "carrier.sensor");
      assert.match(await draftText(other), /sensor:\n\s+rate: 50 Hz\n\s+real:/);
    });
    // The menu may not read the clipboard here: what this tab has copied is pasted, and before a copy it says what to press.
    await at(page, "robot.control.follow").click();
    await page.keyboard.press("Control+c");
    await at(page, "robot.control").click();
    await button(page, "What can be done with robot.control").click();
    await page.getByRole("menuitem", { name: "Paste" }).click();
    await has(page, "follow_2:");
    await selects(page, "robot.control.follow_2");
    await page.getByText("For the clipboard of the computer, press Ctrl V").waitFor();
    // A copied agent has the channels within it, and the page says what it has not.
    await at(page, "robot").click();
    await page.keyboard.press("Control+d");
    await has(page, "robot_2.sensor.line");
    await page.getByText(/The copy does not have: .*drivers/).waitFor();
  }));

test("boxes are moved, kept beside the project, joined with other programs' moves, and arranged again", () =>
  onPage(folder("orchard"), async (page, server) => {
    const file = join(server.root, ".tessera-layout.json");
    const kept = () => (existsSync(file) ? readFileSync(file, "utf8") : "");
    const box = (path) => page.locator(`.react-flow__node[data-id="${path}"]`);
    const place = async (path) => (await box(path).getAttribute("style")).match(/translate\(([^)]*)\)/)[1];
    await at(page, "lookout").waitFor();
    const automatic = await place("lookout");
    const [x, y] = await middleOf(page, at(page, "lookout"));
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 60, y + 40, { steps: 4 });
    await page.mouse.up();
    await until(page, () => /^\{\n {2}"lookout": \[-?\d+, -?\d+\]\n\}\n$/.test(kept()), "the move is kept");
    const moved = await place("lookout");
    assert.notEqual(moved, automatic);

    await page.reload();
    await until(page, async () => (await box("lookout").count()) === 1 && (await place("lookout")) === moved, "it stays moved");
    // Another program moves another box, and this page a third one.
    writeFileSync(file, kept().replace("{\n", '{\n  "carrier": [0, 2000],\n'));
    await until(page, async () => (await place("carrier")).includes("2000px"), "the move of the other program is shown");
    await at(page, "dispatcher").click();
    await page.keyboard.press("Shift+ArrowDown");
    await until(page, () => kept().split("\n").length === 6, "all three moves are kept");
    await page.keyboard.press("Control+z");
    await until(page, () => kept().split("\n").length === 5, "one move is undone");

    // A rename renames the line; undo gives it back.
    await page.keyboard.press("F2");
    await until(page, () => page.evaluate(() => document.activeElement.value === "dispatcher"), "the name has the focus");
    await at(page, "lookout").click();
    await page.keyboard.press("F2");
    await until(page, () => page.evaluate(() => document.activeElement.value === "lookout"), "the name has the focus");
    await page.keyboard.type("watch");
    await page.keyboard.press("Enter");
    await until(page, () => kept().includes('"watch": ['), "the line has the new name");

    // A file that is not understood stays until the user replaces it.
    writeFileSync(file, "{ mine");
    await page.getByText("line 1 is no JSON").waitFor();
    await at(page, "watch").click();
    await page.keyboard.press("Shift+ArrowDown");
    await until(page, async () => (await box("watch").count()) === 1, "the box is drawn");
    assert.equal(kept(), "{ mine");
    await button(page, "Replace the file").click();
    await until(page, () => kept().includes('"watch": ['), "the file is replaced");

    await at(page, "watch").click();
    await page.keyboard.press("Shift+F10");
    await page.getByRole("menuitem", { name: "Arrange automatically" }).click();
    await until(page, () => !existsSync(file), "nothing is moved");
    const found = [];
    await (
      await judges(page, found)
    )();
    assert.deepEqual(found, []);
  }));
