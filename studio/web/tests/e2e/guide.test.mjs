// The way through the page: the steps, the tour of the first visit, the help, and the meanings of terms.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { test } from "node:test";
import { button, checked, drawn, example, folder, judges, onPage, tab, until } from "./page.mjs";

const inside = (page, selector) =>
  page.locator(selector).evaluateAll((all) =>
    all
      .filter((one) => one.checkVisibility())
      .filter((one) => {
        const { left, right } = one.getBoundingClientRect();
        return left < 0 || right > innerWidth || one.scrollWidth > one.clientWidth + 1;
      })
      .map((one) => one.outerHTML.slice(0, 120)),
  );

test("the tour is offered at the first visit only, leads through five parts by keys, and can be left", () =>
  onPage(
    example("01_line_follower"),
    async (page, _server, open) => {
      const found = [];
      const judge = await judges(page, found);
      const card = page.getByRole("dialog");
      await judge("the offer of the tour");
      await button(page, "Take the tour").click();
      for (const [at, title] of ["Structure", "Edit", "Verify", "Run", "Values"].entries()) {
        await card.getByRole("heading", { name: `${title} ${at + 1} of 5` }).waitFor();
        await page.locator(".tour-part").waitFor();
        for (const width of at === 1 ? [640, 1024, 1440] : [1440]) {
          await page.setViewportSize({ width, height: 900 });
          await until(
            page,
            async () => (await inside(page, ".tour-card")).length === 0,
            `the card is in a window of ${width} px`,
          );
        }
        await judge(`step ${at + 1} of the tour`);
        await page.keyboard.press("Enter");
      }
      await card.waitFor({ state: "detached" });
      const again = await open();
      await again.goto(page.url());
      await tab(again, "Structure").waitFor();
      assert.equal(await button(again, "Take the tour").count(), 0);
      await again.close();
      // It is begun again from the help, and left by Escape.
      await button(page, "Help and shortcuts").click();
      await button(page, "Take the tour").click();
      await card.getByRole("heading", { name: "Structure 1 of 5" }).waitFor();
      await page.keyboard.press("Escape");
      await card.waitFor({ state: "detached" });
      assert.deepEqual(found, []);
    },
    { first: true },
  ));

test("the key ? shows the shortcuts, and the documents open from there", () =>
  onPage(example("01_line_follower"), async (page) => {
    const found = [];
    const judge = await judges(page, found);
    await page.locator(".structure").first().waitFor();
    const help = page.getByRole("dialog", { name: "Help" });
    // In a field and in the text it is a letter.
    await page.getByRole("textbox", { name: "Name", exact: true }).first().press("?");
    assert.equal(await help.count(), 0);
    await page.keyboard.press("Escape");
    await tab(page, "Structure").focus();
    await page.keyboard.press("?");
    await help.getByText("find anything by parts of its path").waitFor();
    for (const width of [640, 1440]) {
      await page.setViewportSize({ width, height: 900 });
      await drawn(page);
      assert.deepEqual(await inside(page, ".guide dd, .guide dt, .guide button, .guide a"), [], `${width} px`);
      await judge(`the help at ${width} px`);
    }
    const opened = page.context().waitForEvent("page");
    await help.getByRole("link", { name: "Documents" }).click();
    const documents = await opened;
    await documents.getByRole("link", { name: "Glossary", exact: true }).click();
    await documents.getByRole("heading", { name: "Glossary" }).waitFor();
    await documents.getByText("how often a subsystem begins an iteration").waitFor();
    await documents.close();
    await page.keyboard.press("Escape");
    await help.waitFor({ state: "detached" });
    assert.deepEqual(found, []);
  }));

test("a ? beside a term tells its meaning by a click or by the focus of the keyboard", () =>
  onPage(example("01_line_follower"), async (page) => {
    const said = page.getByRole("note");
    await tab(page, "Verify").click();
    await button(page, "Verify").click();
    await page.locator(".toolbar").getByText("verified").waitFor();
    const meaning = page.getByRole("button", { name: "Meaning of sound pages" });
    await meaning.click();
    await said.getByText("no page is entered twice at once").waitFor();
    await page.keyboard.press("Escape");
    await said.waitFor({ state: "detached" });
    await page.getByRole("button", { name: "Meaning of goes on" }).focus();
    await page.keyboard.press("Shift+Tab");
    await page.keyboard.press("Tab");
    await said.getByText("can act again, or end").waitFor();
    const found = [];
    await (
      await judges(page, found)
    )("the meaning of a term");
    assert.deepEqual(found, []);
  }));

test("the steps say what stands in the way, and a click on that does it", () =>
  onPage(folder("orchard"), async (page, server) => {
    const state = (step) => page.getByTestId(`step-${step}`);
    await state("edit").getByText("no problems").waitFor();
    await state("run").getByText("21 functions are missing: write them").waitFor();
    for (const width of [640, 920, 1024, 1440]) {
      await page.setViewportSize({ width, height: 900 });
      await drawn(page);
      assert.deepEqual(await inside(page, ".steps button, .step-text"), [], `${width} px`);
    }
    await state("run").click();
    await state("run").getByText("ready").waitFor();
    assert.match(readFileSync(`${server.root}/src/carrier/control.cpp`, "utf8"), /void /);
    await button(page, "Verify the system").click();
    await state("verify")
      .getByText(/violated/)
      .waitFor();
    await state("run").getByText("needs a system that passes Verify").waitFor();
    assert.ok(await button(page, "Build and run").isDisabled());
    writeFileSync(server.file, server.text().replace("rate: 5 Hz", "rate: 5 Hx"));
    await state("edit").getByText("1 error").waitFor();
    await checked(page);
    await state("run").getByText("needs a specification without errors").waitFor();
    await state("run").click();
    assert.equal(await page.locator(".cm-activeLine").innerText(), "      rate: 5 Hx");
  }));
