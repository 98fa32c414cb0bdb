// Letters are large enough on every tab, what is drawn says what it means, and little room is enough.
import assert from "node:assert/strict";
import { test } from "node:test";
import { button, drawn, element, example, folder, onPage, tab } from "./page.mjs";

/** Texts that are seen and have less than ten pixels: "9.0 px: follow". */
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
      const html = () => (owner.closest(".react-flow") && owner.offsetWidth ? box.width / owner.offsetWidth : 1);
      const size = parseFloat(getComputedStyle(owner).fontSize) * (matrix ? Math.hypot(matrix.a, matrix.b) : html());
      if (size < 9.95) found.push(`${size.toFixed(1)} px: ${text.slice(0, 40)}`);
    }
    return found;
  });

for (const [name, project] of Object.entries({ line_follower: example("01_line_follower"), orchard: folder("orchard") }))
  test(`no letters under ten pixels: ${name}`, () =>
    onPage(project, async (page) => {
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
      // Nor on the way from far to near.
      const area = await page.locator(".canvas-area").boundingBox();
      await page.mouse.move(area.x + area.width / 2, area.y + area.height / 2);
      for (let step = 0; step < 24; step += 1) {
        await page.mouse.wheel(0, step < 6 ? 120 : -120);
        await drawn(page);
        assert.deepEqual(await tooSmall(page), [], `step ${step} of the zoom`);
      }
    }));

test("what is drawn says what it means when the pointer is over it", () =>
  onPage(example("01_line_follower"), async (page) => {
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
    await button(page, "Verify")
      .waitFor({ state: "attached" })
      .catch(() => {});
    await drawn(page);
    const boxes = await page.evaluate(() =>
      [".toolbar", ".centre", ".side.left", ".side.right", ".problems, .status"].flatMap((one) => {
        const part = document.querySelector(one);
        if (!part) return [];
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
