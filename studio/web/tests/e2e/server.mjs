// `tessera studio` itself, for a copy of a project.
import { spawn } from "node:child_process";
import { cpSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const tessera = process.env.TESSERA ?? "tessera";

/** Starts it, on any free port unless one is given. `text` reads the specification as it is on disk. */
export async function serve(folder, { port = 0, copy = true } = {}) {
  const root = copy ? mkdtempSync(join(tmpdir(), "studio-")) : folder;
  if (copy) cpSync(folder, root, { recursive: true });
  const file = join(root, "spec.yaml");
  const child = spawn(tessera, ["studio", file, "--port", String(port), "--no-browser"], { stdio: ["ignore", "pipe", "pipe"] });
  let complaints = "";
  child.stderr.on("data", (text) => (complaints += text));
  const url = await new Promise((done, failed) => {
    let said = "";
    child.stdout.on("data", (text) => {
      said += text;
      const found = /http:\/\/\S+/.exec(said);
      if (found) done(found[0]);
    });
    child.on("exit", (code) => failed(new Error(`tessera studio ended with ${code}: ${complaints}`)));
  });
  const ended = new Promise((done) => child.once("exit", done));
  const { origin, hash } = new URL(url);
  return {
    root,
    file,
    url,
    address: origin,
    port: Number(new URL(url).port),
    token: hash.replace("#token=", ""),
    text: () => readFileSync(file, "utf8"),
    /** Ends it; `keep` leaves the project for another start. */
    close: async ({ keep = false } = {}) => {
      child.kill("SIGTERM");
      await ended;
      if (copy && !keep) rmSync(root, { recursive: true, force: true });
    },
  };
}
