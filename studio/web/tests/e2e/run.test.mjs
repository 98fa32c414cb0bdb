import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import validator from "gltf-validator";
import { button, drawn, example, find, onBuilt, onBuiltNet, onPage, serve, tab, until } from "./page.mjs";

const lineFollower = example("01_line_follower");

test("a system without a world runs on the simulated clock, and what came of it is a table", () =>
  onBuilt(example("03_two_slot_buffer"), async (page) => {
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
    // The memory of the subsystem is among the values, and in the panel of the subsystem.
    const values = page.locator(".value-list");
    await values.getByRole("textbox", { name: "Values whose path contains" }).fill("memory.missed");
    await values.getByText("watcher.control.memory.missed").click();
    await page.getByRole("img", { name: "Plot of watcher.control.memory.missed" }).waitFor();
    await find(page, "watcher.control");
    await tab(page, "Element").click();
    const memory = page.getByRole("region", { name: "Memory now" });
    await memory.getByText("last").waitFor();
    assert.match(await memory.innerText(), /last\s+199\s+missed\s+0/);
    await tab(page, "Run").click();
    // The next run has the settings of this one, until they are changed.
    assert.equal(await speed.inputValue(), "0");
    assert.equal(await page.getByRole("textbox", { name: "For" }).inputValue(), "20s");
    await speed.fill("1");
    await button(page, "Run").click();
    await page.getByTestId("run-state").getByText("Running").waitFor();
    await button(page, "Stop").click();
    await page.getByTestId("run-state").getByText("Ended — stopped").waitFor();
  }));

/** The robot moves in the view in three dimensions, and the file of its world is valid glTF. */
async function seenInSpace(page, server) {
  const space = page.getByRole("img", { name: "The world in three dimensions" });
  await space.waitFor();
  const place = () => space.evaluate(({ view }) => JSON.stringify(view?.onScreen(0) ?? null));
  await until(page, async () => (await place()) !== "null", "the robot is there");
  const first = await place();
  await until(page, async () => (await place()) !== first, "the robot drives");
  const ask = (path) => fetch(`${server.address}${path}`, { headers: { Authorization: `Bearer ${server.token}` } });
  const runs = await (await ask("/api/runs")).json();
  const { scene } = await (await ask(`/api/runs/${runs.at(-1).run}`)).json();
  assert.deepEqual(scene.bodies[0], ["robot", "robot"]);
  const glb = new Uint8Array(await (await ask(`/api/scenes/${scene.hash}.glb`)).arrayBuffer());
  const { issues } = await validator.validateBytes(glb);
  assert.deepEqual([issues.numErrors, issues.numWarnings], [0, 0], JSON.stringify(issues.messages));
}

test("a run is made again with the code as it is now, and goes on from a moment", () =>
  onBuiltNet(lineFollower, async (page) => {
    await tab(page, "Run").click();
    await button(page, "Run").click();
    await page.locator(".running-now").getByText("follow").waitFor();
    await button(page, "Pause").click();
    await page.getByTestId("run-state").getByText("Paused").waitFor();
    const from = page.getByLabel("Restart at, in seconds");
    await from.fill("soon");
    assert.ok(await button(page, "Restart at").isDisabled());
    await from.fill("8.5");
    await button(page, "Restart at").click();
    const seconds = async () => parseFloat(await page.getByTestId("run-facts").innerText());
    await until(page, async () => (await seconds()) > 8, "the moment");
    await page.getByTestId("run-state").getByText("Paused").waitFor();
    assert.ok((await seconds()) <= 8.5, String(await seconds()));
    await button(page, "Resume").click();
    await until(page, async () => (await seconds()) > 8.6, "it goes on");
    await button(page, "Stop").click();
    await page.getByTestId("run-state").getByText("Ended").waitFor();
  }));

/** The line says in words what has happened, and the log leads to the place of an event. */
async function toldByTheLine(page) {
  const line = page.getByRole("region", { name: "The run" });
  await line.getByTestId("line-state").getByText("Paused").waitFor();
  assert.match(await line.locator(".sentence").innerText(), /^robot\W+(control|sensor|motor) [a-z]+/);
  await tab(page, "Events").click();
  const events = page.getByRole("listbox", { name: "Events" });
  await events.getByText("is set from this page").first().waitFor();
  const change = events.getByRole("option").filter({ hasText: "goes on from init to follow" });
  await button(page, "Behaviours").click();
  await change.waitFor({ state: "detached" });
  await button(page, "Behaviours").click();
  await page.getByRole("textbox", { name: "Text in the events" }).fill("init to follow");
  await change.click();
  await until(page, () => page.evaluate(() => location.hash.includes("robot.control.follow")), "its place is selected");
  await button(page, "Each firing").click();
  await page.getByRole("textbox", { name: "Text in the events" }).fill("calls its function follow()");
  await events.getByText("calls its function follow()").first().waitFor();
  await tab(page, "Timeline").click();
}

test("a run moves tokens and the robot's path, pauses, steps, and is replayed", () =>
  onBuiltNet(lineFollower, async (page, server) => {
    await tab(page, "Run").click();
    await button(page, "Run").click();
    await page.locator(".running-now").getByText("follow").waitFor();
    const facts = () => page.getByTestId("run-facts").innerText();
    const before = await facts();
    await until(page, async () => (await facts()) !== before, "more firings");
    await page.getByText("robot.control.motion.angular").waitFor();
    await seenInSpace(page, server);
    // A parameter of the running controller is typed, and shown in the form that the controller has accepted.
    const speed = page.locator('[data-parameter="v"]');
    await speed.getByText("0.2 m/s").waitFor();
    await speed.getByRole("textbox").fill("fast");
    await speed.getByRole("textbox").press("Enter");
    await speed.getByRole("alert").waitFor();
    await speed.getByRole("textbox").fill("0.15");
    await speed.getByRole("textbox").press("Enter");
    await speed.getByText("0.15 m/s").waitFor();
    assert.equal(await speed.getByRole("alert").count(), 0);
    await button(page, "v back to 0.2, as the specification says").click();
    await speed.getByText("0.2 m/s").waitFor();
    await button(page, "3D").click();
    const painted = () => page.getByRole("img", { name: "The robot's path from above" }).evaluate((canvas) => canvas.toDataURL());
    const path = await painted();
    await until(page, async () => (await painted()) !== path, "a longer path");
    await button(page, "Pause").click();
    await page.getByTestId("run-state").getByText("Paused").waitFor();
    const count = async () => Number(/([\d,]+) firings/.exec(await facts())[1].replaceAll(",", ""));
    await drawn(page); // a pause is reported after its firings
    const paused = await count();
    await button(page, "Step one firing").click();
    await until(page, async () => (await count()) === paused + 1, "one more firing");
    await toldByTheLine(page);
    await button(page, "Stop").click();
    await page.getByTestId("run-state").getByText("Ended").waitFor();
    await tab(page, "Recordings").click();
    await page.locator(".recordings button").first().click();
    await page.getByRole("slider", { name: "Time" }).waitFor();
    const replayed = page.getByRole("region", { name: /^Values of 2/ });
    await replayed.getByText("robot.control.motion.linear").waitFor();
    await button(page, "Play").click();
    await until(
      page,
      async () =>
        Number(
          (
            await page
              .getByRole("group", { name: /^Recording/ })
              .locator(".position")
              .innerText()
          ).split(" ")[0],
        ) > 0.05,
      "the recording plays",
    );
    await page.getByRole("button", { name: /^Close 2/ }).click();
  }));

test("a run pauses where breakpoints are: when a transition fires, and when its condition holds", () =>
  onBuiltNet(example("02_gap"), async (page) => {
    const transition = "robot.control.follow.t4";
    await find(page, transition);
    await tab(page, "Element").click();
    await button(page, "Pause a run when its condition holds").click();
    await button(page, "Remove the breakpoint").waitFor();
    await tab(page, "Run").click();
    await button(page, "Run").click();
    const state = page.getByTestId("run-state");
    await state.getByText("Paused").waitFor();
    await page.getByText(`condition of ${transition}`).first().waitFor();
    const count = async () =>
      Number(/([\d,]+) firings/.exec(await page.getByTestId("run-facts").innerText())[1].replaceAll(",", ""));
    await drawn(page);
    const paused = await count();
    assert.ok(paused > 0);
    await page.getByRole("button", { name: `Remove the breakpoint at condition of ${transition}` }).click();
    await tab(page, "Element").click();
    await button(page, "Pause a run when it fires").click();
    await tab(page, "Run").click();
    await button(page, "Resume").click();
    await until(page, async () => (await count()) > paused, "the transition fires");
    await state.getByText("Paused").waitFor();
    await button(page, "Stop").click();
    await state.getByText("Ended").waitFor();
  }));

test("a controller that runs already is watched, and let go", () =>
  onBuilt(lineFollower, async (page, server, open) => {
    await tab(page, "Run").click();
    await button(page, "Run").click();
    await page.locator(".running-now").getByText("follow").waitFor();
    // Another studio of the same project finds it.
    const beside = await serve(server.root, { copy: false });
    try {
      const other = await open(beside);
      await other.goto(beside.url);
      await tab(other, "Run").click();
      await other.getByRole("combobox", { name: "Run", exact: true }).selectOption("attach");
      await other.getByRole("combobox", { name: "Controller" }).selectOption({ index: 0 });
      await button(other, "Watch it").click();
      await other.locator(".running-now").getByText("follow").waitFor();
      const facts = () => other.getByTestId("run-facts").innerText();
      const before = await facts();
      await until(other, async () => (await facts()) !== before, "more of its run");
      await button(other, "Stop watching").click();
      await other.getByTestId("run-state").getByText("it runs on").waitFor();
    } finally {
      await beside.close();
    }
    await page.getByTestId("run-state").getByText("Running").waitFor();
  }));

test("the code of a folder that came from elsewhere runs only once the user trusts it", () =>
  onPage(
    lineFollower,
    async (page, server) => {
      const built = () => existsSync(join(server.root, ".tessera/generated"));
      await tab(page, "Run").click();
      await button(page, "Run").click();
      const asked = page.getByRole("dialog", { name: "Do you trust the authors of this folder?" });
      await asked.getByText(server.root).waitFor();
      await asked.getByRole("button", { name: "Do not run it" }).click();
      await asked.waitFor({ state: "hidden" });
      assert.equal(built(), false);
      await button(page, "Run").click();
      await asked.getByRole("button", { name: "Trust it and run" }).click();
      await page.getByTestId("run-state").waitFor();
      await until(page, built, "its controller is made");
      await button(page, "Stop").click();
      await page.getByTestId("run-state").getByText("Ended").or(page.getByTestId("run-state").getByText("Failed")).waitFor();
      // It is asked once.
      await button(page, "Run").click();
      await button(page, "Stop").click();
      await page.getByTestId("run-state").getByText("Ended").or(page.getByTestId("run-state").getByText("Failed")).waitFor();
      assert.equal(await asked.isVisible(), false);
    },
    { server: { trusted: false } },
  ));
