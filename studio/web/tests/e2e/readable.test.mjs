// Letters are large enough on every tab, drawn elements explain themselves, and a small window is enough.
import assert from "node:assert/strict";
import { cpSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { faultsOfTexts } from "./texts.mjs";
import { button, drawn, element, example, folder, middleOf, onNet, onPage, tab } from "./page.mjs";

/** The orchard with names as long as those of real systems. */
const longNames = mkdtempSync(join(tmpdir(), "studio-long-names-"));
after(() => rmSync(longNames, { recursive: true, force: true }));
cpSync(folder("orchard"), longNames, { recursive: true });
writeFileSync(
  join(longNames, "spec.yaml"),
  readFileSync(join(longNames, "spec.yaml"), "utf8")
    .replaceAll("picker_north", "autonomous_fruit_picking_vehicle_north")
    .replaceAll("picker_south", "autonomous_fruit_picking_vehicle_south")
    .replaceAll(/\bcarrier\b/g, "transportationvehicleforharvestedfruit")
    .replaceAll(/\bgripper\b/g, "three_fingered_gripper_with_force_control"),
);
const agents = [
  "autonomous_fruit_picking_vehicle_north",
  "autonomous_fruit_picking_vehicle_south",
  "transportationvehicleforharvestedfruit",
  "charging_station_controller",
  "dispatcher",
  "lookout",
];

/** Visible texts with less than ten pixels: "9.0 px: follow". */
const tooSmall = (page) =>
  page.evaluate(() => {
    const found = [];
    const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    while (walk.nextNode()) {
      const text = walk.currentNode.textContent.trim();
      const owner = walk.currentNode.parentElement;
      if (!text || owner.closest("script, style, title, .cm-measure")) continue;
      if (!owner.checkVisibility({ opacityProperty: true, visibilityProperty: true })) continue;
      const box = owner.getBoundingClientRect();
      const seen = box.width > 0 && box.right > 0 && box.bottom > 0 && box.left < innerWidth && box.top < innerHeight;
      if (!seen) continue;
      const matrix = owner instanceof SVGGraphicsElement ? owner.getScreenCTM() : null;
      const viewport = owner.closest(".react-flow__viewport");
      const html = () => (viewport ? new DOMMatrix(getComputedStyle(viewport).transform).a : 1);
      const size = parseFloat(getComputedStyle(owner).fontSize) * (matrix ? Math.hypot(matrix.a, matrix.b) : html());
      if (size < 9.95) found.push(`${size.toFixed(1)} px: ${text.slice(0, 40)}`);
    }
    return found;
  });

for (const [name, project] of Object.entries({ line_follower: example("01_line_follower"), orchard: folder("orchard") }))
  test(`no letters under ten pixels: ${name}`, () =>
    onNet(project, async (page) => {
      await page.locator(".sheet .page").first().waitFor();
      await page
        .getByText("Element", { exact: true })
        .first()
        .evaluate((one) => (one.style.fontSize = "9px"));
      assert.deepEqual(await tooSmall(page), ["9.0 px: Element"], "it is noticed");
      await page
        .getByText("Element", { exact: true })
        .first()
        .evaluate((one) => (one.style.fontSize = ""));
      assert.ok(
        (await page.locator(".sheet .label").evaluateAll((all) => all.filter((one) => Number(getComputedStyle(one).opacity) > 0)))
          .length > 4,
      );
      for (const panel of ["Element", "Verify", "Play", "Run", "Recordings"]) {
        await tab(page, panel).click();
        await drawn(page);
        assert.deepEqual(await tooSmall(page), [], panel);
      }
      // The same holds on the way from far to near.
      const area = await page.locator(".canvas-area").boundingBox();
      await page.mouse.move(area.x + area.width / 2, area.y + area.height / 2);
      for (let step = 0; step < 24; step += 1) {
        await page.mouse.wheel(0, step < 6 ? 120 : -120);
        await drawn(page);
        assert.deepEqual(await tooSmall(page), [], `step ${step} of the zoom`);
      }
    }));

/** A fleet of a thousand. */
const thousand = mkdtempSync(join(tmpdir(), "studio-thousand-"));
after(() => rmSync(thousand, { recursive: true, force: true }));
writeFileSync(
  join(thousand, "spec.yaml"),
  readFileSync(join(folder("fleet"), "spec.yaml"), "utf8").replace("count: 100", "count: 1000"),
);

const systems = {
  line_follower: example("01_line_follower"),
  orchard: folder("orchard"),
  depot: example("05_depot"),
  "a fleet of a thousand": thousand,
  "eight agents with long names": folder("long_names"),
};
for (const [name, project] of Object.entries(systems))
  test(`every text of the structure is read whole, at three widths and five zooms: ${name}`, () =>
    onPage(project, async (page) => {
      await tab(page, "Structure").click();
      const first = page.locator(".react-flow__node").first();
      const details = new Set();
      for (const width of [1440, 1024, 640]) {
        await page.setViewportSize({ width, height: 900 });
        await button(page, "Overview").click();
        await middleOf(page, first);
        const titles = page.locator(".agent-title");
        assert.ok((await titles.count()) > 0);
        const area = await page.locator(".canvas-area").boundingBox();
        assert.ok(area.height > 200, `at ${width} the drawing is ${area.height} px high`);
        await page.mouse.move(area.x + area.width / 2, area.y + area.height / 2);
        // All of it, as far as possible, and then nearer and nearer.
        for (const steps of [0, 8, -3, -3, -4]) {
          for (let step = 0; step < Math.abs(steps); step += 1) await page.mouse.wheel(0, Math.sign(steps) * 240);
          await drawn(page);
          await middleOf(page, first);
          const detail = await page.locator(".canvas-area").evaluate((one) => /detail-\w+/.exec(one.className)[0]);
          details.add(detail);
          const where = `${detail} at ${width}, after ${steps}`;
          assert.deepEqual(await page.evaluate(faultsOfTexts), [], where);
          // Something is left out before it becomes too small, but no box is without its name.
          const unnamed = await page
            .locator(".agent-box, .subsystem-box, .device-box")
            .evaluateAll((all) =>
              all
                .filter((one) => one.checkVisibility({ visibilityProperty: true }) && !one.innerText.trim())
                .map((one) => one.outerHTML.slice(0, 200)),
            );
          assert.deepEqual(unnamed, [], where);
        }
      }
      assert.deepEqual([...details].sort(), ["detail-agents", "detail-all", "detail-subsystems"]);
    }));

test("a text that is cut, covered, too small or outside of its card is noticed", () =>
  onPage(example("01_line_follower"), async (page) => {
    await middleOf(page, page.locator(".subsystem-name").first());
    const broken = (style) =>
      page.evaluate((text) => {
        const name = [...document.querySelectorAll(".subsystem-name")].find((one) => one.textContent === "control");
        name.style = text;
      }, style);
    for (const [style, fault] of [
      ["font-size: 9px", /px: control$/],
      ["display: inline-block; width: 20px; overflow: hidden", /^cut: control in subsystem-name/],
      ["position: relative; top: 16px", /^control over control subsystem|^control subsystem over control/],
      ["position: relative; left: 120px", /^outside of its subsystem-box/],
    ]) {
      await broken(style);
      const found = await page.evaluate(faultsOfTexts);
      assert.ok(
        found.some((one) => fault.test(one)),
        `${style}: ${found}`,
      );
    }
    await broken("");
    assert.deepEqual(await page.evaluate(faultsOfTexts), []);
  }));

test("an agent, and then its subsystem, that is double-clicked comes near enough to read what is in it", () =>
  onPage(folder("orchard"), async (page) => {
    await page.setViewportSize({ width: 1024, height: 900 });
    await tab(page, "Structure").click();
    const name = page.locator('.agent-name[data-path="dispatcher"]');
    await middleOf(page, name);
    const chip = page.locator('.chip[data-path="dispatcher.control.plan_the_day"]');
    assert.equal(await chip.isVisible(), false);
    await name.dblclick();
    await page.locator('.subsystem-head[data-path="dispatcher.control"]').dblclick();
    await chip.waitFor();
    assert.deepEqual(await tooSmall(page), []);
  }));

test("a picture of the structure has the lines of a long name as the screen has them, and tips at both ends of a line", () =>
  onPage(longNames, async (page) => {
    await page.setViewportSize({ width: 640, height: 900 });
    await tab(page, "Structure").click();
    await middleOf(page, page.locator(".react-flow__node").first());
    const lines = await page
      .locator('.agent-name[data-path="autonomous_fruit_picking_vehicle_north"] .line')
      .evaluateAll((all) => all.map((one) => one.textContent));
    assert.equal(lines.join("").startsWith("autonomous_fruit_picking_vehicle_north"), true);
    const [saved] = await Promise.all([page.waitForEvent("download"), button(page, "SVG").click()]);
    const picture = readFileSync(await saved.path(), "utf8");
    for (const line of lines) assert.ok(picture.includes(`>${line}<`), line);
    assert.match(picture, /marker-start="url\(&quot;#trunk-tip|marker-start="url\(#trunk-tip|marker-start='url\("#trunk-tip/);
  }));

test("names of agents that are too long for their boxes are broken or cut in the net, and never dropped", () =>
  onNet(longNames, async (page) => {
    const names = () =>
      page.evaluate(() =>
        [...document.querySelectorAll('[data-of="0"] .element.page')].map((agent) => {
          const frame = agent.querySelector(".shape").getBoundingClientRect();
          const shown = [...agent.querySelectorAll(":is(.large, .cut, .frame-name)")]
            .filter((one) => one.checkVisibility({ opacityProperty: true, visibilityProperty: true }))
            .map((one) => ({ text: one.textContent, box: one.getBoundingClientRect() }));
          const sticksOut = shown.some(({ box }) => box.left < frame.left || box.right > frame.right);
          return { path: agent.dataset.path, width: frame.width, text: shown.map(({ text }) => text).join(""), sticksOut };
        }),
      );
    for (const width of [640, 1024, 1440]) {
      await page.setViewportSize({ width, height: 900 });
      await middleOf(page, page.locator(".sheet .page").first());
      const area = await page.locator(".canvas-area").boundingBox();
      await page.mouse.move(area.x + area.width / 2, area.y + area.height / 2);
      for (let step = 0; step < 8; step += 1) {
        const seen = await names();
        assert.deepEqual(seen.map(({ path }) => path).sort(), [...agents].sort());
        for (const { path, text, width: wide, sticksOut } of seen) {
          const where = `${path}, ${wide.toFixed(0)} px wide, at ${width}: "${text}"`;
          const [begin, cut] = text.split("…");
          if (wide > 42) assert.ok(cut === undefined ? text === path : begin && path.startsWith(begin), where);
          assert.equal(sticksOut, false, where);
        }
        assert.deepEqual(await tooSmall(page), []);
        await page.mouse.wheel(0, 120);
        await drawn(page);
      }
      await button(page, "Fit View").click();
    }
    const agent = page.locator('.element.page[data-path="transportationvehicleforharvestedfruit"] .shape');
    await page.mouse.move(...(await middleOf(page, agent)));
    const tip = await page.locator(".canvas-area").getAttribute("title");
    assert.match(tip, /^transportationvehicleforharvestedfruit: agent/);
  }));

test("what is drawn says what it means when the pointer is over it", () =>
  onNet(example("01_line_follower"), async (page) => {
    const area = page.locator(".canvas-area");
    const says = async (path, position) => {
      await element(page, path)
        .locator(".shape")
        .first()
        .hover({ force: true, ...(position ? { position } : {}) });
      return area.getAttribute("title");
    };
    await element(page, "t_in").waitFor();
    assert.equal(await says("t_in"), "t_in: starts all that is in system at the same time.");
    assert.equal(await says("in"), "in: a token here starts system.");
    assert.equal(await says("out"), "out: a token here says that system has ended.");
    assert.equal(await says("robot", { x: 30, y: 6 }), "robot: agent; its subsystems run side by side.");
    await tab(page, "Structure").click();
    assert.match(
      await page.locator(".channel-label").first().getAttribute("title"),
      /^robot\.sensor\.line → robot\.control\.line\nThe sender does not wait \(N\), the receiver does not wait \(N\)\.$/,
    );
  }));

test("at 200 % of a usual window all parts are reached, and none covers another", () =>
  onPage(example("01_line_follower"), async (page) => {
    await page.setViewportSize({ width: 720, height: 450 });
    await tab(page, "Verify").waitFor({ state: "attached" });
    await drawn(page);
    const boxes = await page.evaluate(() =>
      [...document.querySelectorAll(".toolbar, .dock [role=tabpanel], .problems")].flatMap((part) => {
        if (part.offsetParent === null) return [];
        const one = part.id || part.className;
        const { top, bottom, left, right } = part.getBoundingClientRect();
        return [{ one, top, bottom, left, right }];
      }),
    );
    assert.ok(boxes.length >= 4, JSON.stringify(boxes));
    for (const [at, a] of boxes.entries())
      for (const b of boxes.slice(at + 1)) {
        const apart = a.bottom <= b.top + 1 || b.bottom <= a.top + 1 || a.right <= b.left + 1 || b.right <= a.left + 1;
        assert.ok(apart, `${a.one} and ${b.one}: ${JSON.stringify([a, b])}`);
      }
    for (const { one, bottom, top } of boxes) assert.ok(bottom - top > 20, `${one} is ${bottom - top} px high`);
    const whole = await page.evaluate(() => [document.documentElement.scrollWidth, innerWidth]);
    assert.ok(whole[0] <= whole[1], `sideways: ${whole}`);
  }));

test("beside a long name and its verdicts, every button of the head is in the window, and lines are told whole", () =>
  onPage(folder("standoff"), async (page, server) => {
    writeFileSync(
      server.file,
      server
        .text()
        .replace("system: standoff", "system: warehouse_with_autonomous_collectors_and_a_crane_for_stations")
        .replaceAll(/\bright\b/g, "autonomous_ball_collector_south")
        .replaceAll(/\brest\b/g, "wait_until_the_situation_is_clear"),
    );
    await page.locator("h1").getByText("warehouse_with").waitFor();
    await page.getByTestId("editor").locator(".cm-content").focus();
    await page.keyboard.type("# ");
    await tab(page, "Verify").click();
    await button(page, "Verify").click();
    await page.locator(".toolbar").getByText("violated").waitFor();
    for (const width of [640, 920, 1024, 1440]) {
      await page.setViewportSize({ width, height: 900 });
      await drawn(page);
      const beyond = await page
        .locator(".toolbar button, .toolbar .unsaved")
        .evaluateAll(
          (all, width) => all.filter((one) => one.getBoundingClientRect().right > width).map((one) => one.outerHTML),
          width,
        );
      assert.deepEqual(beyond, [], `${width} px`);
      assert.equal(await page.getByLabel("not saved").evaluate((dot) => dot.getBoundingClientRect().width), 7);
      const [lines, broken] = await page
        .locator(".at-end .choice .faint")
        .evaluateAll((all) => [all.length, all.filter((one) => one.getClientRects().length > 1).length]);
      assert.ok(lines > 0 && broken === 0, `${broken} of ${lines} broken at ${width} px`);
    }
  }));
