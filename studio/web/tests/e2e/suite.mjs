// node suite.mjs SUITE...: runs the files of suites in one process. They share its browser (browser.mjs) and the builds
// of its projects (server.mjs).
import { readdirSync } from "node:fs";

const suites = {
  reading: ["studio", "readable", "timing", "keyboard", "guide", "tour", "fleet", "appearance"],
  editing: ["editing", "boxes", "keeping"],
  building: ["building", "workshop", "newcomer"],
  running: ["run", "dock", "teleoperation", "beside", "deployment"],
  recordings: ["recordings", "plots", "reports", "world"],
};

const files = readdirSync(new URL(".", import.meta.url)).filter((name) => name.endsWith(".test.mjs"));
const forgotten = files.filter((name) => !Object.values(suites).flat().includes(name.replace(".test.mjs", "")));
if (forgotten.length > 0) throw new Error(`in no suite: ${forgotten}`);

const wanted = process.argv.slice(2);
for (const suite of wanted.length > 0 ? wanted : Object.keys(suites)) {
  if (!(suite in suites)) throw new Error(`no suite ${suite}: ${Object.keys(suites)}`);
  for (const name of suites[suite]) await import(`./${name}.test.mjs`);
}
