// Stands in for `tessera studio` in the end-to-end tests of the page: the same protocol, with the specification judged by
// the real command and the runs played from the net, without compiling a controller.
import { execFile } from "node:child_process";
import { createHash, randomBytes } from "node:crypto";
import { createReadStream, existsSync, mkdtempSync, readFileSync, statSync, watch, writeFileSync, cpSync, rmSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { basename, dirname, extname, join, normalize, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { addRuns } from "./fixture-runs.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const dist = process.env.STUDIO_DIST ?? resolve(here, "../dist");
const tessera = process.env.TESSERA ?? "tessera";
const types = {
  ".html": "text/html",
  ".js": "text/javascript",
  ".css": "text/css",
  ".svg": "image/svg+xml",
  ".json": "application/json",
};
const revisionOf = (text) => createHash("sha256").update(text).digest("hex").slice(0, 16);

function command(args, options = {}) {
  return new Promise((done) =>
    execFile(tessera, args, { maxBuffer: 1 << 28, ...options }, (error, stdout) => done({ code: error?.code ?? 0, stdout })),
  );
}

/** A server for a copy of the project in `folder`. */
export async function serve(folder, { port = 0, token = randomBytes(16).toString("hex"), copy = true } = {}) {
  const root = copy ? mkdtempSync(join(tmpdir(), "studio-")) : folder;
  if (copy) cpSync(folder, root, { recursive: true });
  const file = join(root, "spec.yaml");
  const clients = new Set();
  const start = randomBytes(6).toString("hex");
  const send = (name, data) => clients.forEach((client) => client.write(`event: ${name}\ndata: ${JSON.stringify(data)}\n\n`));

  async function analyse(text) {
    const probe = join(root, `.probe-${randomBytes(4).toString("hex")}.yaml`);
    writeFileSync(probe, text);
    const [checked, shown] = await Promise.all([
      command(["check", probe, "--json", "-"]),
      command(["show", probe, "--json", "-"]),
    ]);
    rmSync(probe);
    const diagnostics = JSON.parse(checked.stdout || "[]").map((one) => ({
      ...one,
      end_line: one.line,
      end_column: one.column + one.length,
    }));
    return { diagnostics, net: shown.code === 0 ? JSON.parse(shown.stdout) : null, structure: null };
  }

  const jobs = new Map();
  async function verify(job, text) {
    const probe = join(root, `.probe-${job}.yaml`);
    writeFileSync(probe, text);
    send("verify", { job, state: "running", property: "safe", states: 0, rate: 0 });
    const { stdout } = await command(["verify", probe, "--json", "-", "--timeout", "20s"]);
    rmSync(probe);
    const state = stdout
      ? { job, state: "done", result: JSON.parse(stdout) }
      : { job, state: "failed", error: "the specification has errors" };
    jobs.set(job, state);
    send("verify", state);
  }

  const runs = new Map();
  const state = { root, file, send, runs, text: () => readFileSync(file, "utf8"), analyse };
  addRuns(state);
  const routes = [
    [
      "GET",
      /^\/api\/project$/,
      () => ({
        name: basename(folder),
        folder: root,
        file: "spec.yaml",
        version: "0.1.0",
        worlds: [{ name: "line_world.xml", tracks: ["oval.png", "curves.png"] }],
      }),
    ],
    [
      "GET",
      /^\/api\/spec$/,
      async () => {
        const text = state.text();
        return { text, revision: revisionOf(text), analysis: await analyse(text) };
      },
    ],
    [
      "PUT",
      /^\/api\/spec$/,
      async (_, body) => {
        const disk = state.text();
        if (revisionOf(disk) !== body.revision)
          return [409, { text: disk, revision: revisionOf(disk), error: "the file on disk changed" }];
        writeFileSync(file, body.text);
        return { revision: revisionOf(body.text), analysis: await analyse(body.text) };
      },
    ],
    ["POST", /^\/api\/check$/, (_, body) => analyse(body.text)],
    [
      "POST",
      /^\/api\/verify$/,
      (_, body) => {
        const job = randomBytes(3).toString("hex");
        jobs.set(job, { job, state: "running" });
        void verify(job, body.text);
        return [202, { job }];
      },
    ],
    ["GET", /^\/api\/verify\/(\w+)$/, ([job]) => jobs.get(job) ?? [404, { error: "no such job" }]],
    [
      "DELETE",
      /^\/api\/verify\/(\w+)$/,
      ([job]) => {
        jobs.set(job, { job, state: "stopped" });
        send("verify", { job, state: "stopped" });
        return {};
      },
    ],
  ];
  const server = createServer(async (request, response) => {
    const url = new URL(request.url, "http://127.0.0.1");
    const answer = (status, body) => {
      response.writeHead(status, { "Content-Type": "application/json" });
      response.end(JSON.stringify(body));
    };
    if (!url.pathname.startsWith("/api/")) return page(url.pathname, response);
    const given = url.searchParams.get("token") ?? request.headers.authorization?.replace("Bearer ", "");
    if (given !== token) return answer(401, { error: "wrong token", hint: "open the address that tessera studio printed" });
    if (url.pathname === "/api/events") {
      response.writeHead(200, { "Content-Type": "text/event-stream", "Cache-Control": "no-cache" });
      response.write(`event: hello\ndata: ${JSON.stringify({ server_start: start })}\n\n`);
      clients.add(response);
      request.on("close", () => clients.delete(response));
      return;
    }
    let body = "";
    for await (const chunk of request) body += chunk;
    for (const [method, pattern, handler] of [...routes, ...(state.extra ?? [])]) {
      const match = method === request.method && pattern.exec(url.pathname);
      if (!match) continue;
      const result = await handler(match.slice(1).map(decodeURIComponent), body ? JSON.parse(body) : {}, url);
      return Array.isArray(result) && typeof result[0] === "number" ? answer(...result) : answer(200, result);
    }
    answer(404, { error: `nothing at ${url.pathname}` });
  });
  const watcher = watch(file, () => send("spec", { revision: revisionOf(state.text()) }));
  await new Promise((done) => server.listen(port, "127.0.0.1", done));
  const address = `http://127.0.0.1:${server.address().port}`;
  return {
    ...state,
    state,
    token,
    address,
    url: `${address}/#token=${token}`,
    port: server.address().port,
    close: () =>
      new Promise((done) => {
        watcher.close();
        clients.forEach((client) => client.destroy());
        server.close(done);
        server.closeAllConnections();
      }),
  };
}

function page(path, response) {
  const file = join(dist, normalize(path === "/" ? "/index.html" : path));
  if (!file.startsWith(dist) || !existsSync(file) || !statSync(file).isFile()) {
    response.writeHead(404);
    return response.end();
  }
  response.writeHead(200, { "Content-Type": types[extname(file)] ?? "application/octet-stream" });
  createReadStream(file).pipe(response);
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const { url } = await serve(process.argv[2], { port: Number(process.argv[3] ?? 8787) });
  console.log(url);
}
