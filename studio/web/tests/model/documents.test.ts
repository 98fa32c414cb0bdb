import { existsSync, mkdtempSync, readdirSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { afterAll, beforeAll, expect, it } from "vitest";
import { writeDocuments } from "../../scripts/documents.mjs";

const folder = mkdtempSync(join(tmpdir(), "documents-"));
beforeAll(() => writeDocuments(folder));
afterAll(() => rmSync(folder, { recursive: true, force: true }));

const pages = () => readdirSync(folder, { recursive: true, encoding: "utf8" }).filter((name) => name.endsWith(".html"));

it("every link and picture of the documents leads to a page, a heading or a file that is served", () => {
  const lost: string[] = [];
  let links = 0;
  for (const name of pages()) {
    const text = readFileSync(join(folder, name), "utf8");
    for (const [, address] of text.matchAll(/(?:href|src)="([^"]+)"/g)) {
      if (/^https?:/.test(address!)) continue;
      links += 1;
      const [path, anchor] = address!.split("#");
      const target = path ? join(folder, dirname(name), path) : join(folder, name);
      const found = existsSync(target) && (!anchor || readFileSync(target, "utf8").includes(`id="${anchor}"`));
      if (!found) lost.push(`${name}: ${address}`);
    }
  }
  expect(lost).toEqual([]);
  expect(links).toBeGreaterThan(500);
});

it("the documents have no script, and nothing of the source text of a page is lost", () => {
  for (const name of pages()) expect(readFileSync(join(folder, name), "utf8")).not.toMatch(/<script|javascript:/);
  const tour = readFileSync(join(folder, "start/studio_tour.html"), "utf8");
  expect(tour).toContain("Zoom in with the wheel");
  expect(tour).toContain("context.parameters.v / 2");
});
