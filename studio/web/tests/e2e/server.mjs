// `tessera studio` itself, for a copy of a project.
import { execFileSync, spawn } from "node:child_process";
import { cpSync, existsSync, mkdtempSync, readdirSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";

const tessera = process.env.TESSERA ?? "tessera";
// Controllers that were started elsewhere on this machine are not visible to these tests.
const world = mkdtempSync(join(tmpdir(), "studio-"));
// A test has nothing to do with what Tessera keeps for the user who runs it.
const env = { ...process.env, XDG_RUNTIME_DIR: world, XDG_STATE_HOME: join(world, "state") };
process.on("exit", () => rmSync(world, { recursive: true, force: true }));

/** The further processes that a test starts beside the server. */
export const environment = { tessera, env };

const removeAll = (parent, kept) => {
  if (!existsSync(parent)) return;
  for (const name of readdirSync(parent)) if (!kept.includes(name)) rmSync(join(parent, name), { recursive: true, force: true });
};

const buildFolders = ["build", "generated"];

/** Builds its controller and forgets the run that this takes. */
function build(root) {
  execFileSync(tessera, ["simulate", root, "--for", "100ms"], { env, stdio: "ignore", timeout: 600_000 });
  removeAll(join(root, ".tessera"), buildFolders);
}

/** A copy of the project's source; the build of an earlier copy is kept, because building takes long. */
function copyOf(folder, parent = world) {
  const root = join(parent, basename(folder));
  // How an earlier test has arranged the page.
  rmSync(join(world, "state", "tessera", "pages"), { recursive: true, force: true });
  removeAll(root, [".tessera"]);
  removeAll(join(root, ".tessera"), buildFolders);
  // Without the dates of the source, everything would be built again.
  cpSync(folder, root, { recursive: true, preserveTimestamps: true, filter: (path) => basename(path) !== ".tessera" });
  return root;
}

/**
 * Starts it, on any free port unless one is given. `text` reads the specification from disk. `built`: its
 * controller is built beforehand, so that a run starts at once. `trusted`: the user has said that its code may run; otherwise the copy is where none was before.
 */
export async function serve(folder, { port = 0, copy = true, built = false, trusted = true } = {}) {
  const root = copy ? copyOf(folder, trusted ? world : mkdtempSync(join(world, "of_others_"))) : folder;
  const file = join(root, "spec.yaml");
  if (built) build(root);
  const child = spawn(tessera, ["studio", file, "--port", String(port), "--no-browser"], {
    env,
    stdio: ["ignore", "pipe", "pipe"],
  });
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
  const token = hash.replace("#token=", "");
  if (trusted) await fetch(`${origin}/api/trust`, { method: "POST", headers: { Authorization: `Bearer ${token}` }, body: "{}" });
  return {
    root,
    file,
    url,
    address: origin,
    port: Number(new URL(url).port),
    token,
    text: () => readFileSync(file, "utf8"),
    /** Ends it like a crash. */
    kill: async () => {
      child.kill("SIGKILL");
      await ended;
    },
    /** Ends it; its project stays until the next copy. */
    close: async () => {
      child.kill("SIGTERM");
      await ended;
    },
  };
}
