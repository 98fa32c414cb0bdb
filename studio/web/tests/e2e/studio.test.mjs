import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { gzipSync } from "node:zlib";
import { button, drawn, element, example, find, folder, judges, middleOf, onNet, serve, tab, until } from "./page.mjs";

const lineFollower = example("01_line_follower");

test("zooming goes through the five layers", () =>
  onNet(lineFollower, async (page) => {
    const here = page.getByRole("navigation", { name: "Layers" });
    for (const [path, layer] of [
      ["robot", "agent"],
      ["robot.control", "subsystem"],
      ["robot.control.follow", "behaviour"],
      ["robot.control.follow.snd", "communication"],
    ]) {
      await element(page, path).dblclick({ position: { x: 20, y: 12 } });
      await here.getByText(layer, { exact: true }).waitFor();
      assert.equal(await page.locator(`[data-sheet="${path}"]`).count(), 1);
    }
    await here.getByRole("button", { name: "system" }).click();
    await here.getByText("multi-agent system").waitFor();
    assert.equal(await page.locator('[data-sheet="robot.control.follow.snd"]').count(), 0);
  }));

test("keys alone lead from the system to a transition and back", () =>
  onNet(lineFollower, async (page) => {
    await page.getByRole("application", { name: /Drawing of the net/ }).focus();
    const said = page.locator(".canvas [aria-live]");
    const here = page.getByRole("navigation", { name: "Layers" });
    for (const [key, name] of [
      ["ArrowDown", "place in"],
      ["ArrowDown", "transition t_in"],
      ["ArrowDown", "agent robot"],
      ["Enter", "place robot.in"],
      ["ArrowDown", "transition robot.t_in"],
    ]) {
      await page.keyboard.press(key);
      await said.getByText(name, { exact: true }).waitFor();
    }
    await here.getByText("agent", { exact: true }).waitFor();
    await page.keyboard.press("Escape");
    await here.getByText("multi-agent system", { exact: true }).waitFor();
  }));

test("a folded page is a double circle, and opens again", () =>
  onNet(lineFollower, async (page) => {
    await find(page, "robot.control");
    await page.locator('[data-sheet="robot.control"]').waitFor();
    await button(page, "Fold control").click();
    await page.locator('.page.folded[data-path="robot.control"]').waitFor();
    assert.equal(await page.locator('[data-sheet="robot.control"]').count(), 0);
    // Beside its circle, where its name begins.
    await page.mouse.dblclick(...(await middleOf(page, element(page, "robot.control"))));
    await page.locator('[data-sheet="robot.control"]').waitFor();
  }));

test("a double click is meant for what was under its first click, though the view moves", () =>
  onNet(lineFollower, async (page) => {
    await find(page, "robot.control");
    await button(page, "Fold control").click();
    const circle = element(page, "robot.control").locator(".shape").first();
    await page.locator('.page.folded[data-path="robot.control"]').waitFor();
    await page.mouse.move(...(await middleOf(page, circle)));
    await page.mouse.down();
    await page.mouse.up();
    await page
      .getByRole("navigation", { name: "Layers" })
      .getByRole("button", { name: "system" })
      .evaluate((one) => one.click());
    await drawn(page);
    await page.mouse.down({ clickCount: 2 });
    await page.mouse.up({ clickCount: 2 });
    await until(page, async () => (await page.locator('.page.folded[data-path="robot.control"]').count()) === 0, "it opens");
  }));

test("a violation is shown as a run that steps back and forth", () =>
  onNet(folder("standoff"), async (page) => {
    await tab(page, "Verify").click();
    await button(page, "Verify").click();
    await page
      .getByRole("button", { name: /Show the run/ })
      .first()
      .click();
    await page.getByText("Who waits for whom").waitFor();
    await find(page, "left.control.talk.snd");
    const tokens = (name) => page.locator(`[data-sheet="left.control.talk.snd"] .place[data-path="${name}"] .tokens`);
    await tokens("left.control.talk.snd.said.wait").waitFor({ state: "visible" });
    await button(page, "Step back").click();
    await tokens("left.control.talk.snd.said.2").waitFor({ state: "visible" });
    await tokens("left.control.talk.snd.said.wait").waitFor({ state: "hidden" });
    await button(page, "Step forward").click();
    await tokens("left.control.talk.snd.said.wait").waitFor({ state: "visible" });
    await button(page, "Close").click();
    await page.getByText("Play the token game").waitFor();
  }));

test("the token game fires what is clicked, and conditions fall as chosen", () =>
  onNet(folder("standoff"), async (page) => {
    await tab(page, "Play").click();
    await button(page, "Play the token game").click();
    await element(page, "t_in").click();
    await page.getByText("1 / 1").waitFor();
    const choices = page.locator(".choice-list").first();
    await choices.getByText("left.t_in").click();
    await choices.getByText("left.control.t_in").waitFor();
    await page.getByLabel("Condition of right.control.listen.t5").selectOption("false");
    await button(page, "Play").click();
    await page.getByText("Nothing: the net has stopped.").waitFor();
  }));

test("two browsers see each other's saves", () =>
  onNet(lineFollower, async (page, server, open) => {
    const other = await open();
    await other.goto(server.url);
    await other.getByTestId("editor").getByText("20 Hz").waitFor();
    await tab(page, "Structure").click();
    await page.locator('[data-path="robot.control"]').click();
    await page.getByRole("textbox", { name: "Rate" }).fill("33 Hz");
    await page.keyboard.press("Enter");
    await page.keyboard.press("Control+s");
    await other.getByTestId("editor").getByText("33 Hz").waitFor();
  }));

test("a server that is killed and started again is noticed, and found again with its new key", () =>
  onNet(lineFollower, async (page, server, open) => {
    await page.locator(".sheet").first().waitFor();
    await tab(page, "Structure").click();
    await page.locator('[data-path="robot.motor"]').click();
    await page.getByRole("textbox", { name: "Rate" }).fill("40 Hz");
    await page.keyboard.press("Enter");
    await server.close();
    await page.getByRole("alert").getByText("The server does not answer").waitFor();
    const again = await serve(server.root, { port: server.port, copy: false });
    try {
      await page.getByRole("alert").getByText("The server was started anew").waitFor();
      // `tessera studio` opens its new address; the old tab is notified.
      const other = await open();
      await other.goto(again.url);
      await page.getByRole("alert").getByText("The server was started anew").waitFor({ state: "detached" });
      await page.getByText("connected again").waitFor();
      await page.keyboard.press("Control+s");
      await page.getByText("Saved").waitFor();
      assert.match(again.text(), /rate: 40 Hz/);
    } finally {
      await again.close();
    }
  }));

test("a wrong key is said to be wrong, not a blank page", () =>
  onNet(lineFollower, async (page, server, open) => {
    const other = await open();
    await other.goto(`${server.address}/#token=00`);
    await other.getByRole("alert").getByText("The server was started anew").waitFor();
  }));

test("a view is exported as a drawing that stands on its own", () =>
  onNet(lineFollower, async (page) => {
    await find(page, "robot.control.follow");
    await page.locator('[data-sheet="robot.control.follow"]').waitFor();
    const [svg] = await Promise.all([page.waitForEvent("download"), button(page, "SVG").click()]);
    const text = readFileSync(await svg.path(), "utf8");
    assert.equal(svg.suggestedFilename(), "robot.control.follow.svg");
    assert.match(text, /follow\(\)/);
    assert.doesNotMatch(text, /var\(|color\(|class=|https?:\/\/(?!www\.w3\.org)/);
    const [png] = await Promise.all([page.waitForEvent("download"), button(page, "PNG").click()]);
    assert.equal(
      readFileSync(await png.path())
        .subarray(1, 4)
        .toString(),
      "PNG",
    );
  }));

test("axe finds nothing to object to, light and dark, in every view and panel", () =>
  onNet(lineFollower, async (page) => {
    const found = [];
    const judge = await judges(page, found);
    await page.locator(".sheet").first().waitFor();
    for (const theme of ["light", "dark"]) {
      for (const name of ["Element", "Verify", "Play", "Run", "Recordings"]) {
        await tab(page, name).click();
        await judge(`${theme} ${name}`);
      }
      await tab(page, "Structure").click();
      await page.locator('[data-path="robot.control.follow"]').click();
      await judge(`${theme} Structure`);
      await page.keyboard.press("Control+k");
      await page.getByRole("combobox", { name: "Path" }).waitFor();
      await judge(`${theme} search`);
      await page.keyboard.press("Escape");
      await button(page, "About Tessera").click();
      await judge(`${theme} about`);
      await button(page, "Close").click();
      await tab(page, "Net").click();
      await button(page, "Dark colours").click();
    }
    assert.deepEqual(found, []);
  }));

test("what is under other licences is said, with their texts", () =>
  onNet(lineFollower, async (page) => {
    await button(page, "About Tessera").click();
    for (const [name, text] of [
      ["Licence of Tessera", "Apache License"],
      ["Software of others", "Eclipse Public License"],
    ]) {
      const opened = page.waitForEvent("popup");
      await page.getByRole("link", { name }).click();
      const other = await opened;
      await other.getByText(text).first().waitFor();
      await other.close();
    }
  }));

test("all that is loaded packs into less than 1.1 megabytes, and nothing moves for those who asked for stillness", () =>
  onNet(lineFollower, async (page) => {
    const asked = new Set();
    page.on("request", (request) => asked.add(request.url()));
    await page.reload();
    await page.locator(".sheet").first().waitFor();
    await page.getByTestId("editor").getByText("tessera").first().waitFor();
    const files = [...asked].filter((address) => address.startsWith("http") && !address.includes("/api/"));
    assert.ok(files.some((address) => address.includes("elk-worker")) && files.length > 4, files.join());
    let bytes = 0;
    for (const file of files) bytes += gzipSync(Buffer.from(await (await fetch(file)).arrayBuffer())).length;
    assert.ok(bytes < 1_100_000, `${bytes} bytes`);
    await find(page, "robot.control.follow.snd");
    await page.locator('[data-sheet="robot.control.follow.snd"]').waitFor();
    const moving = await page.evaluate(() => document.getAnimations().filter((one) => one.playState === "running").length);
    assert.equal(moving, 0);
  }));
