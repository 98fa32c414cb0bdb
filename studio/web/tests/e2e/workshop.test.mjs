// The studio as a workshop: stuck subsystems and their repair, and the structure of a system of real size.
import assert from "node:assert/strict";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { button, changes, draftText, folder, judges, middleOf, onPage, tab, until } from "./page.mjs";

const parent = mkdtempSync(join(tmpdir(), "studio-workshop-"));
after(() => rmSync(parent, { recursive: true, force: true }));

const card = (page, title) => page.getByRole("region", { name: title });

test("who is stuck is seen and named after one click, and a verified repair mends it", () =>
  onPage(folder("greeting"), async (page, server) => {
    await tab(page, "Verify").click();
    await button(page, "Verify").click();
    const cause = card(page, "left.control and right.control wait for each other");
    await cause.getByText("deadlock free, goes on").waitFor();
    await until(page, async () => (await page.locator('[data-testid="lens"] [data-lens]').count()) === 2, "both are marked");
    await until(page, async () => (await page.locator(".lens-wait").count()) === 2, "both waits are drawn");
    await tab(page, "Structure").click();
    await until(page, async () => (await page.locator(".lens-wait").count()) === 2, "the lens in the structure");
    // The camera is at the two boxes.
    const area = await page.locator(".canvas-area").boundingBox();
    for (const path of ["left.control", "right.control"]) {
      const box = await page.locator(`.lens [data-lens="${path}"]`).boundingBox();
      assert.ok(box.x >= area.x && box.x + box.width <= area.x + area.width && box.y >= area.y, path);
    }
    // Both channels between the two are one line, which is open while they are stuck.
    const bundle = page.locator(".channel-label.bundle.stuck");
    assert.match(await bundle.getAttribute("title"), /^2 channels between left and right\n/);
    const wires = await page
      .locator(".channel.inside.stuck")
      .evaluateAll((all) => all.map((one) => one.parentElement.dataset.channels));
    assert.deepEqual([...new Set(wires)].sort(), ["0", "1"]);
    await cause.getByText("How it comes to that").click();
    await cause.getByLabel("The run in words").getByText("waits for the acknowledgement").first().waitFor();
    await cause.getByRole("button", { name: "Find a repair" }).click();
    const repair = cause.locator(".repair").first();
    await repair.waitFor();
    await repair.getByText(/^Verified: with it, “deadlock free”/).waitFor();
    await repair.getByRole("button", { name: "Apply" }).click();
    await until(page, async () => (await page.locator(".mark.holds").count()) >= 7, "the properties hold");
    assert.equal(await page.locator(".cause:not(.warning)").count(), 0);
    const changed = changes(server.text(), await draftText(page));
    assert.ok(changed.length >= 2 && changed.length <= 6, changed.join("\n"));
  }));

test("among six agents one click finds the chain of waiting, names it in words, and shows it at every width", () =>
  onPage(folder("orchard"), async (page) => {
    await tab(page, "Structure").click();
    await page.locator(".react-flow__node").first().waitFor();
    await tab(page, "Verify").click();
    await button(page, "Verify").click();
    const cause = card(page, "picker_north.control and carrier.control wait for each other");
    await cause.getByText("live behaviours").waitFor();
    // All violations have this one cause, also the behaviours that never run because of it.
    assert.equal(await page.locator(".cause").count(), 1);
    await cause.getByText(/^Breaks .*goes on.*channels flow|^Breaks .*channels flow.*goes on/).waitFor();
    const dead = cause.getByRole("list", { name: "Behaviours that never run" });
    for (const path of ["picker_north.control.approach", "picker_south.control.pick", "carrier.control.carry"])
      await dead.getByText(path).waitFor();
    const words = (await cause.innerText()).replaceAll("\u200b", "");
    assert.match(words, /picker_north.control waits for the acknowledgement of picker_north.control.full → carrier.control/);
    const hidden = (view) =>
      page.evaluate((drawn) => {
        const area = document.querySelector(".canvas-area").getBoundingClientRect();
        const labels = [...document.querySelectorAll(".lens-wait text")].map((one) => [
          one.textContent,
          one.getBoundingClientRect(),
        ]);
        const covered = [...document.querySelectorAll(drawn === "Net" ? ".label.frame-name" : ".agent-title .line")]
          .filter((one) => one.checkVisibility({ opacityProperty: true, visibilityProperty: true }))
          .map((one) => [one.textContent, one.getBoundingClientRect()]);
        const over = (a, b) => a.left < b.right && b.left < a.right && a.top < b.bottom - 2 && b.top < a.bottom - 2;
        return [
          ...labels.filter(
            ([, box]) => box.left < area.left || box.right > area.right || box.top < area.top || box.bottom > area.bottom,
          ),
          ...labels.flatMap(([, box]) => covered.filter(([, other]) => over(box, other))),
          ...(labels.length < 2 ? [["too few labels"]] : []),
        ].map(([text]) => text);
      }, view);
    for (const view of ["Structure", "Net"]) {
      await tab(page, view).click();
      for (const width of [640, 1024, 1440]) {
        await page.setViewportSize({ width, height: 900 });
        // The camera flies on request.
        await cause.getByRole("button", { name: "Hide who is stuck" }).click();
        await cause.getByRole("button", { name: "Show who is stuck" }).click();
        await middleOf(page, page.locator('.lens [data-lens="carrier.control"]'));
        assert.deepEqual(await hidden(view), [], `${view} at ${width}`);
      }
    }
  }));

/** Texts of the structure that overlap each other or are cut without a mark, and lines through boxes. */
const faults = () => {
  const found = [];
  const inside = (box, point) =>
    point.x > box.left + 1 && point.x < box.right - 1 && point.y > box.top + 1 && point.y < box.bottom - 1;
  // Far away, some are left out.
  const texts = [...document.querySelectorAll(".agent-title, .subsystem-name, .port button, .chip, .channel-label")]
    .filter((element) => element.checkVisibility({ visibilityProperty: true }))
    .map((element) => ({ element, box: element.getBoundingClientRect(), text: element.textContent }));
  texts.forEach(({ box, text }, at) =>
    texts.slice(at + 1).forEach((other) => {
      const [wide, high] = [
        Math.min(box.right, other.box.right) - Math.max(box.left, other.box.left),
        Math.min(box.bottom, other.box.bottom) - Math.max(box.top, other.box.top),
      ];
      if (wide > 0.5 && high > 0.5) found.push(`${text} over ${other.text}`);
    }),
  );
  for (const { element, text } of texts)
    if (element.scrollWidth > element.clientWidth + 1 && !element.closest("[title]")) found.push(`${text} is cut without a tip`);
  const boxes = [...document.querySelectorAll(".subsystem-box, .device-box")].map((one) => one.getBoundingClientRect());
  for (const path of document.querySelectorAll("path.channel")) {
    const matrix = path.getScreenCTM();
    for (let at = 0, length = path.getTotalLength(); at <= length; at += 6) {
      const point = path.getPointAtLength(at).matrixTransform(matrix);
      if (boxes.some((box) => inside(box, point)))
        found.push(`channel ${path.parentElement.dataset.channels} goes through a box`);
    }
  }
  return [...new Set(found)];
};

test("twelve subsystems with twenty-eight channels are drawn without overlap, at any width", () =>
  onPage(folder("orchard"), async (page) => {
    await tab(page, "Structure").click();
    // Six within agents, and one for each pair of agents.
    await page
      .locator(".channel-label")
      .nth(6 + 13 - 1)
      .waitFor({ state: "attached" });
    for (const width of [640, 1440]) {
      await page.setViewportSize({ width, height: 900 });
      assert.deepEqual(await page.evaluate(faults), []);
    }
    // A channel ends where its buffer is drawn, also after the buffer has moved.
    const ends = () =>
      page.evaluate(() => {
        const near = (path, point) => {
          const box = document.querySelector(`[data-handle="${path}"]`).getBoundingClientRect();
          return Math.hypot(box.x + box.width / 2 - point.x, box.y + box.height / 2 - point.y);
        };
        const [wire] = document.querySelectorAll('g[data-channels="0"] path.channel');
        const matrix = wire.getScreenCTM();
        const at = (part) => wire.getPointAtLength(part * wire.getTotalLength()).matrixTransform(matrix);
        return [near("dispatcher.button_panel.pressed", at(0)), near("dispatcher.control.pressed", at(1))];
      });
    for (const distance of await ends()) assert.ok(distance < 4, `${distance} px`);
    await page.locator('.subsystem-head[data-path="dispatcher.control"]').click();
    await button(page, "Add input").click();
    await page.locator('[data-handle="dispatcher.control.input"]').waitFor({ state: "attached" });
    for (const distance of await ends()) assert.ok(distance < 4, `${distance} px`);
    const found = [];
    const judge = await judges(page, found);
    for (const width of [640, 1024, 1440]) {
      await page.setViewportSize({ width, height: 900 });
      for (const name of ["Structure", "Net", "Element", "Verify", "Play", "Run", "Recordings"]) {
        await tab(page, name).click();
        await judge(`${name} at ${width}`);
      }
    }
    assert.deepEqual(found, []);
  }));
