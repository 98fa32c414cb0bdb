// The panels around the drawing: moved, sized, maximised, closed, and kept for the project.
import assert from "node:assert/strict";
import { test } from "node:test";
import { button, drawn, example, judges, middleOf, onBuilt, onPage, serve, tab, until } from "./page.mjs";

const panel = (page, name) => page.getByRole("tabpanel", { name, exact: true });
const tabsBeside = (page, name) =>
  tab(page, name).evaluate((one) =>
    [...one.closest("[role=tablist]").querySelectorAll("[role=tab]")].map((each) => each.textContent),
  );

async function fromMenu(page, role, name) {
  await button(page, "Panels").click();
  await page.getByRole(role, { name, exact: true }).click();
  if (role === "menuitemcheckbox") await page.keyboard.press("Escape");
  await page.getByRole("menu").waitFor({ state: "detached" });
  await drawn(page);
}

/** Drags as a hand does, in steps: the library looks where the pointer goes. */
async function dragTo(page, from, to) {
  const [start, end] = [await middleOf(page, from), await middleOf(page, to)];
  await page.mouse.move(...start);
  await page.mouse.down();
  for (const part of [0.1, 0.3, 0.6, 0.9, 1, 1])
    await page.mouse.move(start[0] + (end[0] - start[0]) * part, start[1] + (end[1] - start[1]) * part + (part === 1 ? 1 : 0));
  await drawn(page);
  await page.mouse.move(end[0], end[1]);
  await page.mouse.up();
}

/** Panels that cover each other, or are not in the window. */
const faults = (page) =>
  page.evaluate(() => {
    const all = [...document.querySelectorAll(".toolbar, .dock [role=tablist], .dock [role=tabpanel], .problems")];
    const seen = all
      .filter((one) => one.offsetParent !== null)
      .map((one) => [one.id || one.className, one.getBoundingClientRect()]);
    const found = [];
    for (const [at, [name, a]] of seen.entries()) {
      if (a.width < 60 || a.height < 18 || a.left < -1 || a.right > innerWidth + 1) found.push(`${name} ${JSON.stringify(a)}`);
      for (const [other, b] of seen.slice(at + 1))
        if (a.left < b.right - 1 && b.left < a.right - 1 && a.top < b.bottom - 1 && b.top < a.bottom - 1)
          found.push(`${name} and ${other}`);
    }
    return found;
  });

test("a panel is moved, sized, maximised and closed, by the keyboard too, and a reload and another port keep it", () =>
  onPage(example("01_line_follower"), async (page, server, open) => {
    await tab(page, "Run").waitFor();
    assert.deepEqual(await tabsBeside(page, "Run"), ["Element", "Verify", "Play", "Run", "Recordings"]);
    await dragTo(page, tab(page, "Run"), panel(page, "Text"));
    await until(page, async () => (await tabsBeside(page, "Run")).includes("Text"), "Run stands beside Text");
    assert.deepEqual(await tabsBeside(page, "Element"), ["Element", "Verify", "Play", "Recordings"]);

    const width = async () => (await panel(page, "Run").boundingBox()).width;
    const before = await width();
    await page.getByRole("separator", { name: "Border between panels" }).first().focus();
    for (let press = 0; press < 4; press++) await page.keyboard.press("ArrowRight");
    await until(page, async () => (await width()) > before + 5, "the border has moved");

    await tab(page, "Play").click();
    await tab(page, "Play").press("Control+Delete");
    await tab(page, "Play").waitFor({ state: "detached" });

    // F6 goes round all panels that are seen, each once.
    const names = new Set();
    for (let press = 0; press < 3; press++) {
      await page.keyboard.press("F6");
      names.add(await page.evaluate(() => document.activeElement.id));
    }
    assert.deepEqual([...names].sort(), ["flexlayout-tab-drawing", "flexlayout-tab-recordings", "flexlayout-tab-run"]);
    await page.keyboard.press("Shift+F6");
    await page.keyboard.press("Alt+Enter");
    await until(page, async () => (await page.locator(".dock [role=tabpanel]:visible").count()) === 1, "one panel is maximised");
    await page.keyboard.press("Alt+Enter");
    await until(page, async () => (await page.locator(".dock [role=tabpanel]:visible").count()) === 3, "it is back in its place");

    const kept = await width();
    await page.reload();
    await until(page, async () => (await tabsBeside(page, "Run")).includes("Text"), "it is as it was");
    assert.ok(Math.abs((await width()) - kept) < 3);
    assert.equal(await tab(page, "Play").count(), 0);

    // Another server for the project has another port, for which the browser itself has kept nothing.
    const next = await serve(server.root, { copy: false });
    const other = await open(next);
    await other.goto(next.url);
    await until(other, async () => (await tabsBeside(other, "Run")).includes("Text"), "it is the same on another port");
    assert.equal(await tab(other, "Play").count(), 0);
    await other.close();
    await next.close();

    await fromMenu(page, "menuitemcheckbox", "Play");
    assert.deepEqual(await tabsBeside(page, "Element"), ["Element", "Verify", "Play", "Recordings"]);
    await fromMenu(page, "menuitem", "Reset layout");
    assert.deepEqual(await tabsBeside(page, "Run"), ["Element", "Verify", "Play", "Run", "Recordings"]);

    // A layout that another version has kept, or that is damaged, gives the ready one and no blank page.
    const damaged = { name: "panels", text: '{"layout":"edit","layouts":{"edit wide":{"tre' };
    await fetch(`${server.address}/api/arrangement`, {
      method: "PUT",
      headers: { Authorization: `Bearer ${server.token}` },
      body: JSON.stringify(damaged),
    });
    await page.reload();
    await panel(page, "Drawing").waitFor();
    assert.deepEqual(await tabsBeside(page, "Run"), ["Element", "Verify", "Play", "Run", "Recordings"]);
  }));

test("a run opens its panels in three layouts at three widths: none covers another, and axe finds nothing", () =>
  onBuilt(example("01_line_follower"), async (page) => {
    await tab(page, "Run").click();
    assert.equal(await tab(page, "Timeline").count(), 0, "an empty panel takes no room");
    await panel(page, "Run").getByRole("button", { name: "Run", exact: true }).click();
    await tab(page, "Timeline").waitFor();
    await tab(page, "World").waitFor();
    const found = [];
    const judge = await judges(page, found);
    for (const layout of ["Edit", "Debug", "Operate"]) {
      await fromMenu(page, "menuitemradio", layout);
      for (const width of [1440, 1024, 640]) {
        await page.setViewportSize({ width, height: 900 });
        await until(page, async () => (await faults(page)).length === 0, `${layout} at ${width}: ${await faults(page)}`);
        for (const name of ["Timeline", "Values", "World", "Run"]) {
          await tab(page, name).click();
          await panel(page, name).waitFor();
          if (name !== "Timeline") continue;
          const high = async () => (await panel(page, name).locator("canvas").boundingBox()).height;
          await until(page, async () => (await high()) > 50, `the lanes have room: ${layout} at ${width}`);
        }
        if (layout === "Debug" && width !== 1024) await judge(`${layout} at ${width}`);
      }
      await page.setViewportSize({ width: 1440, height: 900 });
    }
    assert.deepEqual(found, []);
    await fromMenu(page, "menuitemradio", "Edit");
  }));
