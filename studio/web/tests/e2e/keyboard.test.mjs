// A person without a pointer reaches everything, and always sees where the keys go.
import assert from "node:assert/strict";
import { test } from "node:test";
import { draftText, drawn, example, judges, near, onPage, tab, until } from "./page.mjs";

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

/** Waits until an element of that role and name has the focus. */
const hasFocus = (page, role, name) =>
  until(
    page,
    () => page.getByRole(role, { name, exact: true }).evaluateAll((all) => all.includes(document.activeElement)),
    `the keys go to ${role} ${name}`,
  );

test("the search leads the keys into the drawing, and from there they change the system", () =>
  onPage(example("01_line_follower"), async (page) => {
    const found = [];
    const judge = await judges(page, found);
    const search = async (path) => {
      await page.keyboard.press("Control+k");
      await page.keyboard.type(path);
      await page.keyboard.press("Enter");
    };
    await search("robot.control.follow");
    await hasFocus(page, "button", "behaviour follow");
    await page.keyboard.press("Shift+F10");
    await hasFocus(page, "menuitem", "Add what follows…");
    await page.keyboard.press("Enter");
    const form = page.getByRole("form", { name: "After follow" });
    await judge("the form of an arrow");
    await page.keyboard.press("Shift+Tab");
    await hasFocus(page, "button", "Add"); // the keys go round in the form
    await page.keyboard.press("Tab");
    await page.keyboard.press("Tab");
    await page.keyboard.type("in.line.middle");
    await page.keyboard.press("Enter");
    await form.waitFor({ state: "detached" });
    await until(
      page,
      async () => {
        const text = (await draftText(page)) ?? "";
        return text.includes("in.line.middle") && text.includes("next: init");
      },
      "the entry is there",
    );

    // Tab shows elements that were out of sight.
    await near(page, "robot.sensor");
    const faults = [];
    await go(page, "velocity", faults);
    assert.deepEqual(faults, []);

    await tab(page, "Net").click();
    await search("robot.motor");
    await hasFocus(page, "application", "Drawing of the net. Arrow keys move, Enter opens, Escape goes up, F folds.");
    assert.deepEqual(found, []);
  }));

test("a panel that becomes as large as the page keeps the keys", () =>
  onPage(example("01_line_follower"), async (page) => {
    await tab(page, "Element").focus();
    await page.keyboard.press("Alt+Enter");
    await page.getByRole("button", { name: "Back to its place (Alt Enter)" }).waitFor();
    await hasFocus(page, "tab", "Element");
    await page.keyboard.press("Alt+Enter");
    await tab(page, "Text").waitFor();
    await hasFocus(page, "tab", "Element");
  }));
