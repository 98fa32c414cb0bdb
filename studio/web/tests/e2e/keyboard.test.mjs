// A person without a pointer reaches everything, and always sees where the keys go.
import assert from "node:assert/strict";
import { test } from "node:test";
import { drawn, example, onPage, tab } from "./page.mjs";

/** The element that has the focus, and the faults of how it shows it. */
const focused = (page) =>
  page.evaluate(() => {
    const one = document.activeElement;
    if (!one || one === document.body) return null;
    const name = (one.getAttribute("aria-label") ?? one.textContent ?? "").trim().slice(0, 60);
    // The text is outlined as a whole.
    const shown = one.closest(".cm-editor") ?? one;
    const { outlineStyle, outlineWidth, outlineColor, boxShadow } = getComputedStyle(shown);
    const { left, right, top, bottom, width, height } = shown.getBoundingClientRect();
    const seen = document.elementFromPoint(left + width / 2, top + Math.min(height / 2, 20));
    const faults = [];
    if (
      (outlineStyle === "none" || parseFloat(outlineWidth) === 0 || outlineColor === "rgba(0, 0, 0, 0)") &&
      boxShadow === "none"
    )
      faults.push("its focus is not visible");
    if (left < -1 || right > innerWidth + 1 || top < -1 || Math.min(bottom, top + 20) > innerHeight + 1)
      faults.push("not in the window");
    else if (!seen || !(shown.contains(seen) || seen.contains(shown))) faults.push(`under ${seen?.outerHTML.slice(0, 80)}`);
    return { name, faults: faults.map((fault) => `${one.tagName} "${name}": ${fault}`) };
  });

/** Presses Tab until an element has the focus. */
async function go(page, wanted, faults) {
  for (let step = 0; step < 80; step += 1) {
    await page.keyboard.press("Tab");
    await drawn(page);
    const now = await focused(page);
    faults.push(...(now?.faults ?? []));
    if (now?.name.startsWith(wanted)) return;
  }
  assert.fail(`Tab does not lead to ${wanted}`);
}

for (const width of [1440, 640])
  test(`at ${width} pixels, Tab leads to everything in turn, and it can be seen where it is`, () =>
    onPage(example("01_line_follower"), async (page) => {
      await page.setViewportSize({ width, height: 900 });
      await tab(page, "Element").waitFor();
      await drawn(page);
      const faults = [];
      for (const wanted of ["Verify the system", "Add agent", "Zoom Out", "Add type"]) await go(page, wanted, faults);
      assert.deepEqual(faults, []);
      // From the forms to the search and into the element that is found, without a pointer.
      await page.keyboard.press("Control+k");
      await page.getByRole("combobox", { name: "Path" }).waitFor();
      await page.keyboard.type("robot.control.follow");
      await page.keyboard.press("Enter");
      await page.getByRole("heading", { name: "Behaviour follow" }).waitFor();
    }));
