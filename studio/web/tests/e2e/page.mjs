// The shared part of the end-to-end tests: a server for a copy of an example, a page on it, and the errors
// that must never happen.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { fileURLToPath } from "node:url";
import { inSharedBrowser } from "./browser.mjs";
import { environment, serve } from "./server.mjs";

export { environment, serve };

export const example = (name) => fileURLToPath(new URL(`../../../../examples/${name}`, import.meta.url));
export const folder = (name) => fileURLToPath(new URL(`./projects/${name}`, import.meta.url));

/**
 * Runs a test on a page of a server for a copy of `project`; fails on errors of the page and on requests to elsewhere.
 * `first`: this browser has never shown the page, so the tour is offered.
 */
export async function onPage(project, test, options = {}) {
  const server = await serve(project, options.server);
  try {
    await inSharedBrowser((browser) => onServer(browser, server, test, options));
  } finally {
    await server.close();
  }
}

/**
 * A slow machine, to find what depends on the speed of this one. STUDIO_DELAY: milliseconds by which edits and checks of the
 * specification are late. STUDIO_SLOWDOWN: how many times slower the page is.
 */
async function slowDown(context) {
  const { STUDIO_DELAY: delay = 0, STUDIO_SLOWDOWN: rate = 1 } = process.env;
  if (Number(delay) > 0)
    await context.route(/\/api\/(edit|check)$/, async (route) => {
      await new Promise((done) => setTimeout(done, Number(delay)));
      await route.continue().catch(() => undefined); // the page may be closed
    });
  if (Number(rate) > 1)
    context.on("page", async (page) => {
      const session = await context.newCDPSession(page);
      await session.send("Emulation.setCPUThrottlingRate", { rate: Number(rate) });
    });
}

async function onServer(browser, server, test, { first = false }) {
  const context = await browser.newContext({
    viewport: { width: 1440, height: 900 },
    reducedMotion: "reduce",
  });
  await slowDown(context);
  if (!first) await context.addInitScript(() => location.protocol === "http:" && localStorage.setItem("tessera.visited", "1"));
  const problems = [];
  const open = async (on = server) => {
    const page = await context.newPage();
    page.setDefaultTimeout(60_000);
    page.on("pageerror", (error) => problems.push(error.stack));
    page.on("request", (request) => {
      const { protocol, host } = new URL(request.url());
      if (protocol.startsWith("http") && host !== new URL(on.address).host) problems.push(`request to ${request.url()}`);
    });
    return page;
  };
  try {
    const page = await open();
    await page.goto(server.url);
    await page.getByText("Opening…").waitFor({ state: "detached" });
    await test(page, server, open);
    assert.deepEqual(problems, []);
  } catch (error) {
    // The picture that a person would have seen.
    for (const page of context.pages())
      console.error(`-- the page when the test failed\n${await page.locator("body").innerText().catch(String)}\n--`);
    throw error;
  } finally {
    await context.close();
  }
}

/** The same on a project whose controller is built already. */
export const onBuilt = (project, test) => onPage(project, test, { server: { built: true } });

/** The page opens with the structure. These begin with the drawing of the net. */
const inNet =
  (test) =>
  async (page, ...more) => {
    await tab(page, "Net").click();
    await test(page, ...more);
  };
export const onNet = (project, test, options) => onPage(project, inNet(test), options);
export const onBuiltNet = (project, test) => onBuilt(project, inNet(test));

/** Goes to an element by the search. */
export async function find(page, path) {
  await page.keyboard.press("Control+k");
  await page.getByRole("combobox", { name: "Path" }).fill(path);
  await page.keyboard.press("Enter");
}

/** Whether an element can be clicked in the drawing: it is drawn, and not beyond its edges. */
export async function isInDrawing(page, locator) {
  if (!(await locator.isVisible())) return false;
  const [one, area] = [await locator.boundingBox(), await page.locator(".canvas-area").first().boundingBox()];
  if (!one || !area) return false;
  const [x, y] = [one.x + one.width / 2 - area.x, one.y + one.height / 2 - area.y];
  return x > 0 && y > 0 && x < area.width && y < area.height;
}

/** Comes near to an element of the structure by the search, and gives its text or button there. */
export async function near(page, path) {
  await tab(page, "Structure").click();
  await find(page, path);
  const found = page.locator(`[data-path="${path}"]`).first();
  await middleOf(page, found);
  return found;
}

export const element = (page, path) => page.locator(`.sheet [data-path="${path}"]`).first();
export const tab = (page, name) => page.getByRole("tab", { name, exact: true });
export const button = (page, name) => page.getByRole("button", { name, exact: true });

/** Waits until all edits are done and the text is checked. */
export const checked = (page) => page.locator('.app[aria-busy="true"]').waitFor({ state: "detached" });

/** Waits until the text as it is now has no problems. */
export async function noProblems(page) {
  await checked(page);
  await page.getByTestId("problem-count").getByText("No problems").waitFor();
}

/** The text of the page that is not saved, once the last edit is done; undefined: all is saved. */
export async function draftText(page) {
  await checked(page);
  return page.evaluate(() => {
    const key = Object.keys(sessionStorage).find((one) => one.startsWith("tessera.draft"));
    return key && JSON.parse(sessionStorage.getItem(key)).text;
  });
}

/** Lines that differ, as `diff` shows them; for changes that keep the order of lines. */
export function changes(before, after) {
  const [old, fresh] = [before.split("\n"), after.split("\n")];
  return [
    ...old.filter((line) => !fresh.includes(line)).map((line) => `-${line}`),
    ...fresh.filter((line) => !old.includes(line)).map((line) => `+${line}`),
  ];
}

/** Waits, for a minute at most, until `look` gives something that is not undefined, null or false. */
export async function until(page, look, what) {
  for (const end = Date.now() + 60_000; Date.now() < end;) {
    const found = await look();
    if (found !== undefined && found !== null && found !== false) return found;
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => setTimeout(done, 30))));
  }
  return assert.fail(`never happened: ${what}`);
}

/** Waits until everything that has arrived is drawn. */
export const drawn = (page) =>
  page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

/** The middle of an element, once it no longer moves. */
export async function middleOf(page, locator) {
  let last = "";
  return until(
    page,
    async () => {
      await drawn(page);
      const { x, y, width, height } = await locator.boundingBox();
      const before = last;
      last = [x, y, width, height].join();
      return last === before && [x + width / 2, y + height / 2];
    },
    "it stays where it is",
  );
}

/** Waits until nothing in the page has changed for a tenth of a second, but two seconds at most. */
const quiet = (page) =>
  page.evaluate(
    () =>
      new Promise((done) => {
        const end = () => (observer.disconnect(), done());
        let timer = setTimeout(end, 100);
        const observer = new MutationObserver(() => {
          clearTimeout(timer);
          timer = setTimeout(end, 100);
        });
        observer.observe(document, { subtree: true, childList: true, attributes: true });
        setTimeout(end, 2000);
      }),
  );

/** A function that lets axe check the present page, and adds its complaints. */
export async function judges(page, found) {
  await page.evaluate(readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8"));
  return async (where) => {
    await quiet(page); // axe fails if an element goes while it looks
    const { violations } = await page.evaluate(() => axe.run());
    found.push(...violations.map((one) => `${where}: ${one.id} ${one.nodes[0].html.slice(0, 160)}`));
  };
}

/** The whole text of an editor of C++; empty while another editor takes its place. */
export const codeText = (area) => area.evaluate((one) => one.closest(".code-editor")?.editor.state.doc.toString() ?? "");
