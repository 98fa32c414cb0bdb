// Each tab at three widths looks as it did when a person approved it. UPDATE_PICTURES=1 makes the pictures
// anew: look at them before you commit them.
import assert from "node:assert/strict";
import { existsSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { button, drawn, folder as project, middleOf, onNet, tab } from "./page.mjs";

const folder = fileURLToPath(new URL("appearance/", import.meta.url));
const widths = [640, 1024, 1440];
const tabs = { Net: ["Element", "Verify", "Play", "Run", "Recordings"], Structure: ["Element"] };

/**
 * The share of squares of 8 x 8 pixels whose mean brightness differs by more than an eighth. Small
 * differences of letters do not count, a part in another position does. 1: the sizes differ.
 */
const difference = (page, one, other) =>
  page.evaluate(
    async (both) => {
      const cells = await Promise.all(
        both.map(async (bytes) => {
          const image = new Image();
          image.src = `data:image/png;base64,${bytes}`;
          await image.decode();
          const canvas = new OffscreenCanvas(Math.ceil(image.width / 8), Math.ceil(image.height / 8));
          const context = canvas.getContext("2d");
          context.imageSmoothingQuality = "high";
          context.drawImage(image, 0, 0, canvas.width, canvas.height);
          const { data } = context.getImageData(0, 0, canvas.width, canvas.height);
          return Array.from({ length: data.length / 4 }, (_, at) => (data[4 * at] + data[4 * at + 1] + data[4 * at + 2]) / 3);
        }),
      );
      if (cells[0].length !== cells[1].length) return 1;
      return cells[0].filter((cell, at) => Math.abs(cell - cells[1][at]) > 32).length / cells[0].length;
    },
    [one, other].map((bytes) => bytes.toString("base64")),
  );

/**
 * Compares the page, or a part of it, with a picture, or makes the picture. Returns the difference as text.
 */
async function judged(page, name, part = page) {
  await page.mouse.move(0, 0);
  await drawn(page);
  const seen = await part.screenshot({ caret: "hide" });
  if (process.env.UPDATE_PICTURES) {
    mkdirSync(folder, { recursive: true });
    writeFileSync(folder + name, seen);
    return { seen, wrong: [] };
  }
  assert.ok(existsSync(folder + name), `${name} is missing: UPDATE_PICTURES=1 makes it`);
  const share = await difference(page, readFileSync(folder + name), seen);
  if (share <= 0.02) return { seen, wrong: [] };
  if (process.env.PICTURES) writeFileSync(`${process.env.PICTURES}/${name}`, seen);
  return { seen, wrong: [`${name}: ${(share * 100).toFixed(1)} % differ`] };
}

test("every tab looks as it did, at 640, 1024 and 1440 pixels", () =>
  onNet(project("crossing"), async (page) => {
    await page.locator(".sheet .page").first().waitFor();
    const wrong = [];
    let before;
    for (const width of widths) {
      await page.setViewportSize({ width, height: 800 });
      for (const [view, panels] of Object.entries(tabs)) {
        await tab(page, view).click();
        for (const panel of panels) {
          await tab(page, panel).click();
          if (view === "Net") await middleOf(page, page.locator(".sheet .page").first());
          else await middleOf(page, page.locator(".react-flow__node").first());
          const { seen, wrong: more } = await judged(page, `${view}_${panel}_${width}.png`.toLowerCase());
          wrong.push(...more);
          // Tabs differ from each other by far more than that, so a wrong tab would be noticed.
          if (before && panel === "Verify") assert.ok((await difference(page, before, seen)) > 0, "the tab has not changed");
          before = seen;
        }
      }
    }
    assert.deepEqual(wrong, []);
  }));

test("six agents and their chain of waiting look as they did, at 640, 1024 and 1440 pixels", () =>
  onNet(project("orchard"), async (page) => {
    await page.locator(".sheet .page").first().waitFor();
    await tab(page, "Structure").click();
    const wrong = [];
    const all = async (name) => {
      for (const width of widths) {
        await page.setViewportSize({ width, height: 800 });
        if (name === "lens") {
          await button(page, "Hide who is stuck").click();
          await button(page, "Show who is stuck").click();
        }
        await middleOf(page, page.locator(".react-flow__node").first());
        wrong.push(...(await judged(page, `six_agents_${name}_${width}.png`, page.locator(".centre"))).wrong);
      }
    };
    await all("structure");
    await tab(page, "Verify").click();
    await button(page, "Verify").click();
    await button(page, "Hide who is stuck").waitFor();
    await all("lens");
    assert.deepEqual(wrong, []);
  }));
