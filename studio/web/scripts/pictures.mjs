// Makes the pictures of the examples for the page of an empty project: npm run pictures. They are the structure as the page draws
// it. Needs a built page and program (TESSERA) and Chromium, as the browser tests do.
import { mkdirSync, readdirSync, writeFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { drawn, example, middleOf, onPage } from "../tests/e2e/page.mjs";

const to = fileURLToPath(new URL("../public/examples/", import.meta.url));
/** The drawing alone, in a window so small that the names in it are readable in the picture. */
const alone = `.canvas-area { position: fixed !important; inset: 0 !important; z-index: 99; background: #fff }
  .legend, .react-flow__panel { display: none !important }`;
const size = { width: 400, height: 250 };

mkdirSync(to, { recursive: true });
for (const name of readdirSync(example("."))) {
  if (!/^\d\d_/.test(name)) continue;
  await onPage(example(name), async (page) => {
    await page.setViewportSize(size);
    // The drawing fits itself into the window at its first sight.
    await page.addInitScript((content) => {
      addEventListener("DOMContentLoaded", () =>
        document.head.append(Object.assign(document.createElement("style"), { textContent: content })),
      );
    }, alone);
    await page.reload();
    await middleOf(page, page.locator(".react-flow__node").first());
    await drawn(page);
    const picture = await page.screenshot();
    writeFileSync(`${to}${name}.png`, picture);
    console.log(`${name}: ${(picture.length / 1000).toFixed(1)} kB`);
  });
}
process.exit(0);
