import { existsSync } from "node:fs";
import { chromium } from "playwright-core";

const executablePath =
  process.env.CHROMIUM ??
  ["/usr/bin/chromium-headless-shell", "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find(
    existsSync,
  );
const args = [
  "--no-sandbox",
  "--disable-gpu",
  "--no-first-run",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
  ...(process.env.CHROMIUM_FLAGS ?? "").split(" ").filter(Boolean),
];

export const launch = () => chromium.launch({ executablePath, args, headless: true });

let browser = Promise.resolve();
let users = 0;

/**
 * Gives `use` the browser of this process, since a browser takes longer to start than many a test. Contexts in it
 * share nothing with each other. It ends when nobody has used it for half a second.
 */
export async function inSharedBrowser(use) {
  users += 1;
  try {
    browser = browser.then((one) => (one?.isConnected() ? one : launch()), launch);
    return await use(await browser);
  } finally {
    users -= 1;
    setTimeout(() => {
      if (users === 0)
        browser = browser.then(
          (one) => one?.close(),
          () => undefined,
        );
    }, 500);
  }
}
