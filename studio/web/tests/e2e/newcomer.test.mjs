// The way of a newcomer who knows robots and no Petri nets: from an empty folder to a depot of two carriers that runs. A
// deadlock is found and mended there, and a slow sensor is found in a plot. Clicks and keys of each step are printed.
import assert from "node:assert/strict";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { button, noProblems, onPage, tab, until } from "./page.mjs";

const parent = mkdtempSync(join(tmpdir(), "studio-newcomer-"));
after(() => rmSync(parent, { recursive: true, force: true }));

/** Somebody at the page, whose clicks and keys are counted. */
class Newcomer {
  #clicks = 0;
  #keys = 0;
  #since = Date.now();

  constructor(page, say) {
    this.page = page;
    this.say = say;
  }

  async click(target) {
    this.#clicks += 1;
    await target.click();
  }

  async press(key) {
    this.#keys += 1;
    await this.page.keyboard.press(key);
  }

  /** Writes into the field that has the focus, and confirms with Enter. */
  async type(text) {
    for (const letter of text) await this.press(letter === " " ? "Space" : letter);
    await this.press("Enter");
  }

  /** Clicks into a field, and replaces its text. */
  async fill(field, text) {
    await this.click(field);
    await this.press("Control+a");
    if (text === "") await this.press("Delete");
    await this.type(text);
  }

  /** Opens a list of choices, and takes one. */
  async choose(field, label) {
    this.#clicks += 2;
    await field.selectOption({ label });
  }

  /** Ends a step. */
  done(step) {
    const seconds = ((Date.now() - this.#since) / 1000).toFixed(1);
    this.say(`${step}: ${this.#clicks} clicks, ${this.#keys} keys, ${seconds} s`);
    [this.#clicks, this.#keys, this.#since] = [0, 0, Date.now()];
  }
}

/** The numbers of the plot's table, by signal and column. */
const facts = (page) =>
  page.locator(".plot-table table").evaluate((table) => {
    const titles = [...table.querySelectorAll("thead th")].map((one) => one.textContent);
    const rows = [...table.querySelectorAll("tbody tr")].map((row) => [...row.children].map((one) => one.textContent.trim()));
    return Object.fromEntries(rows.map((row) => [row[0], Object.fromEntries(row.map((one, at) => [titles[at], Number(one)]))]));
  });

test("a newcomer gets from an empty folder to two carriers that run, mends a deadlock and finds a slow sensor", (t) => {
  return onPage(
    mkdtempSync(join(parent, "depot_")),
    async (page) => {
      const user = new Newcomer(page, (text) => t.diagnostic(text));
      const field = (name) => page.getByLabel(name, { exact: true });
      const goTo = async (words) => {
        await user.press("Control+k");
        await user.type(words);
      };
      const verdict = page.getByTestId("step-verify");
      const state = (word) => page.getByTestId("run-state").getByText(word).waitFor();
      const run = async (speed) => {
        await user.click(button(page, "Build and run"));
        await state("Running");
        await user.choose(page.locator(".line-bar").getByLabel("Speed", { exact: true }), speed);
      };

      await user.click(page.getByRole("radio", { name: /^Several robots/ }));
      await user.click(page.getByRole("radio", { name: /^Simulated/ }));
      await user.click(button(page, "Begin"));
      await noProblems(page);
      await user.click(button(page, "No, thanks"));
      user.done("The two questions");

      await user.click(page.locator('.agent-name[data-path="carrier"]'));
      await user.fill(field("How many"), "2");
      await page.locator('.agent-name[data-path="carrier"]').getByText("× 2").waitFor();
      await user.click(button(page, "Verify the system"));
      await verdict.getByText(/^verified$/).waitFor();
      await run("fastest");
      await state("Ended");
      const charged = page.getByRole("row", { name: /^the first charges/ });
      await charged.getByText("held").waitFor();
      user.done("Two carriers and a dock, verified and run");

      // The carrier is to wait until the dock confirms that it is free, and the dock is to wait for requests instead of
      // asking every 50 ms. Nobody has thought of a message that confirms it.
      await goTo("carrier control give_back");
      await user.fill(field("Receives"), "+grant");
      await user.click(button(page, "Overview"));
      for (const from of ["dock.control.grant", "control.request"]) {
        await user.click(page.locator(".channel-label", { hasText: /^3$/ }));
        await user.click(page.locator(".bundle-channels button", { hasText: from }));
        await user.fill(field("Timeout of a side that waits"), "");
      }
      await noProblems(page);
      await user.click(button(page, "Verify the system"));
      await verdict.getByText(/violated/).waitFor();
      const cause = page.locator(".cause").first();
      await cause.getByText("carrier[0].control gets stuck").waitFor();
      await user.click(cause.getByText("How it comes to that"));
      await cause.getByText(/sends request/).waitFor();
      user.done("A deadlock, and its story");
      await user.click(cause.getByRole("button", { name: "Find a repair" }));
      const repair = cause.locator(".repair").filter({ hasText: "Give up waiting" });
      await user.click(repair.getByRole("button", { name: "Apply" }));
      await verdict.getByText(/^verified/).waitFor();
      user.done("Its repair");

      // The switch of the office reaches the carriers late. The plot shows that its values come seldom.
      await run("10 ×");
      await user.fill(field("Values whose path contains"), "rate of carrier[0].control");
      const [wish, place] = ["wish", "place"].map((input) => `rate of carrier[0].control.${input}`);
      for (const rate of [wish, place]) await user.click(page.locator(".value-list button", { hasText: rate }));
      const most = async (rate) => {
        const rates = await facts(page);
        return rates[rate]?.max;
      };
      await page.locator(".plot-table .legend", { hasText: place }).waitFor();
      await until(page, async () => (await most(place)) >= 19, "the place comes at the rate of the control");
      assert.ok((await most(wish)) <= 6, `${await most(wish)} wishes in a second`);
      await user.click(button(page, "Stop the run"));
      await state("Ended");
      user.done("A slow input in a plot");
      // They come from the control of the office at 5 Hz, which gets them from its console at 10 Hz.
      await user.click(page.locator(".plot-table").getByRole("button", { name: "office.control (5 Hz)" }));
      await user.fill(field("Rate"), "20 Hz");
      await goTo("office console");
      await user.fill(field("Rate"), "20 Hz");
      await run("10 ×");
      await until(page, async () => (await most(wish)) >= 12, "the wishes come faster");
      user.done("Its rates changed, seen in the plot");
    },
    { first: true, server: { copy: false, trusted: false } },
  );
});
