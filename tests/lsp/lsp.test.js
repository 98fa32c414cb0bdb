// Speaks to `tessera lsp` with the client library of VS Code. TESSERA names the command.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { cpSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";
import protocol from "vscode-languageserver-protocol/node.js";

const { createProtocolConnection, StreamMessageReader, StreamMessageWriter } = protocol;
const command = process.env.TESSERA;
const examples = join(dirname(fileURLToPath(import.meta.url)), "../../examples");

/** An editor with one server. */
class Editor {
  constructor(capabilities = {}) {
    this.server = spawn(command, ["lsp"], { stdio: ["pipe", "pipe", "inherit"] });
    this.ended = new Promise((resolve) => this.server.once("exit", (code, signal) => resolve(signal ?? code)));
    this.connection = createProtocolConnection(
      new StreamMessageReader(this.server.stdout),
      new StreamMessageWriter(this.server.stdin),
    );
    this.published = new Map();
    this.waiting = [];
    this.connection.onNotification("textDocument/publishDiagnostics", (told) => {
      this.published.set(told.uri, told);
      this.waiting = this.waiting.filter((one) => !one());
    });
    this.connection.listen();
    this.capabilities = capabilities;
  }
  async start() {
    this.about = await this.request("initialize", { processId: null, rootUri: null, capabilities: this.capabilities });
    await this.notify("initialized", {});
    return this;
  }
  request(method, params) {
    return this.connection.sendRequest(method, params);
  }
  notify(method, params) {
    return this.connection.sendNotification(method, params);
  }
  open(uri, text, languageId = "yaml") {
    return this.notify("textDocument/didOpen", { textDocument: { uri, languageId, version: 1, text } });
  }
  change(uri, version, ...contentChanges) {
    return this.notify("textDocument/didChange", { textDocument: { uri, version }, contentChanges });
  }
  /** The diagnostics of that version, when they come. */
  diagnostics(uri, version) {
    return new Promise((resolve) => {
      const look = () => {
        const told = this.published.get(uri);
        if (told?.version !== version) return false;
        resolve(told.diagnostics);
        return true;
      };
      if (!look()) this.waiting.push(look);
    });
  }
  async stop() {
    await this.request("shutdown");
    await this.notify("exit");
    const code = await this.ended;
    this.connection.dispose();
    return code;
  }
}

/** The position of `word` in `text`, `behind` characters on. */
function position(text, word, behind = 0) {
  const at = text.indexOf(word);
  assert.notEqual(at, -1, word);
  const lines = text.slice(0, at + behind).split("\n");
  return { line: lines.length - 1, character: lines.at(-1).length };
}

function applied(text, edits) {
  const lines = text.split("\n");
  const offset = ({ line, character }) =>
    lines.slice(0, line).reduce((sum, one) => sum + one.length + 1, 0) + character;
  return [...edits]
    .sort((a, b) => offset(b.range.start) - offset(a.range.start))
    .reduce((all, edit) => all.slice(0, offset(edit.range.start)) + edit.newText + all.slice(offset(edit.range.end)), text);
}

/** The Markdown of a hover when its picture is drawn: until then it is answered without. */
async function pictured(ask) {
  for (let round = 0; round < 500; ++round) {
    const { value } = (await ask()).contents;
    if (value.includes("![")) return value;
    await new Promise((next) => setTimeout(next, 20));
  }
  assert.fail("no picture");
}

const able = {
  workspace: {
    workspaceEdit: { documentChanges: true, resourceOperations: ["create"], changeAnnotationSupport: {} },
  },
  textDocument: { hover: { contentFormat: ["markdown"] } },
};

let folder, file, uri, text, editor;

before(async () => {
  folder = mkdtempSync(join(tmpdir(), "tessera lsp ä-"));
  cpSync(join(examples, "01_line_follower"), folder, { recursive: true });
  file = join(folder, "spec.yaml");
  uri = pathToFileURL(file).href;
  text = readFileSync(file, "utf8");
  editor = await new Editor(able).start();
  await editor.open(uri, text);
});

after(async () => {
  assert.equal(await editor.stop(), 0);
  rmSync(folder, { recursive: true });
});

const at = (word, behind = 0) => ({ textDocument: { uri }, position: position(text, word, behind) });

test("shows mistakes while the text changes, and takes them back", async () => {
  assert.deepEqual(await editor.diagnostics(uri, 1), []);
  const range = { start: position(text, "next: follow", 6), end: position(text, "next: follow", 12) };
  await editor.change(uri, 2, { range, text: "folow" });
  const [mistake] = await editor.diagnostics(uri, 2);
  assert.equal(mistake.code, "E101");
  assert.deepEqual(mistake.range, { start: range.start, end: { ...range.start, character: range.start.character + 5 } });
  assert.match(mistake.message, /did you mean 'follow'/);
  const actions = await editor.request("textDocument/codeAction", {
    textDocument: { uri },
    range: mistake.range,
    context: { diagnostics: [mistake] },
  });
  assert.equal(actions[0].title, "Replace by 'follow'");
  await editor.change(uri, 3, { text });
  assert.deepEqual(await editor.diagnostics(uri, 3), []);
});

test("completes, explains and finds", async () => {
  const { items } = await editor.request("textDocument/completion", at("next: follow", 6));
  assert.deepEqual(
    items.map((one) => one.label),
    ["init", "follow", "end"],
  );
  const hover = await editor.request("textDocument/hover", at("motion: Velocity", 9));
  assert.match(hover.contents.value, /linear: float64 m\/s/);
  const key = await editor.request("textDocument/hover", at("rate: 20 Hz", 1));
  assert.match(key.contents.value, /How often an iteration begins/);
  const [buffer] = await editor.request("textDocument/definition", at("robot.sensor.line ->", 14));
  assert.deepEqual(buffer.range.start, position(text, "outputs: { line", 11));
  const [behaviour] = await editor.request("textDocument/definition", at("next: follow", 8));
  assert.deepEqual(behaviour.range.start, position(text, "follow: {}"));
  const symbols = await editor.request("textDocument/documentSymbol", { textDocument: { uri } });
  assert.deepEqual(symbols.at(-1).children.map((one) => one.name), ["control", "sensor", "motor"]);
});

test("shows the page of an agent, subsystem or behaviour as a picture, as the editor can show it", async () => {
  const fleet = readFileSync(join(examples, "04_arm/spec.yaml"), "utf8");
  const texts = [
    [text, "control:", "page robot.control"],
    [text, "robot:", "page robot"],
    [text, "follow: {}", "page robot.control.follow"],
    [fleet, "control:", "page cart[0].control"],
    [fleet, "cart: { use", "page cart[0]"],
  ];
  const hover = async (one, hovered, word) => {
    const other = pathToFileURL(join(folder, "pictures.yaml")).href;
    await one.open(other, hovered);
    await one.diagnostics(other, 1);
    return () =>
      one.request("textDocument/hover", { textDocument: { uri: other }, position: position(hovered, word, 1) });
  };
  for (const [hovered, word, title] of texts) {
    const ask = await hover(editor, hovered, word);
    const [, shown, file] = /!\[(.*)\]\((file:.*)\)/.exec(await pictured(ask));
    assert.equal(shown, title);
    assert.match(readFileSync(fileURLToPath(file), "utf8"), /^<svg [^]*<\/svg>\n$/);
  }
  const plain = await new Editor().start();
  const ask = await hover(plain, text, "follow: {}");
  assert.doesNotMatch((await ask()).contents.value, /svg/);
  assert.equal(await plain.stop(), 0);
});

test("leads from a behaviour to its function, and back", async () => {
  const [there] = await editor.request("textDocument/definition", at("follow: {}", 2));
  const code = pathToFileURL(join(folder, "src/control.cpp")).href;
  assert.equal(decodeURI(there.uri), decodeURI(code));
  await editor.open(code, readFileSync(join(folder, "src/control.cpp"), "utf8"), "cpp");
  const [back] = await editor.request("textDocument/definition", {
    textDocument: { uri: code },
    position: there.range.start,
  });
  assert.deepEqual(back, {
    uri,
    range: { start: position(text, "follow: {}"), end: position(text, "follow: {}", 6) },
  });
  const uses = await editor.request("textDocument/references", {
    textDocument: { uri: code },
    position: there.range.start,
    context: { includeDeclaration: true },
  });
  assert.deepEqual(new Set(uses.map((one) => one.uri.split("/").at(-1))), new Set(["spec.yaml", "control.cpp", "control_test.cpp"]));
  await editor.notify("textDocument/didClose", { textDocument: { uri: code } });
});

test("renames in the specification and in C++; refuses what is taken", async () => {
  const range = await editor.request("textDocument/prepareRename", at("motion: Velocity", 2));
  assert.deepEqual(range.start, position(text, "motion: Velocity"));
  const edit = await editor.request("textDocument/rename", { ...at("motion: Velocity", 2), newName: "speed" });
  const files = Object.fromEntries(edit.documentChanges.map((one) => [one.textDocument.uri.split("/").at(-1), one.edits]));
  assert.deepEqual(Object.keys(files).sort(), ["control.cpp", "control_test.cpp", "spec.yaml"]);
  const changed = applied(text, files["spec.yaml"]);
  assert.match(changed, /outputs: { speed: Velocity }/);
  assert.doesNotMatch(changed, /control\.motion/);
  const code = applied(readFileSync(join(folder, "src/control.cpp"), "utf8"), files["control.cpp"]);
  assert.match(code, /out\.speed = steer/);
  assert.doesNotMatch(code.replaceAll(/\/\/.*/g, ""), /out\.motion/);
  const field = await editor.request("textDocument/rename", { ...at("left: bool", 2), newName: "port" });
  assert.ok(Object.values(field.changeAnnotations).every((one) => one.needsConfirmation));
  await assert.rejects(editor.request("textDocument/rename", { ...at("init:", 1), newName: "follow" }), /'follow' is taken/);
  await assert.rejects(editor.request("textDocument/rename", { ...at("init:", 1), newName: "a b" }), /a b/);
  assert.equal(await editor.request("textDocument/prepareRename", at("rate: 20 Hz", 1)), null);
});

test("writes a transition function that is missing", async () => {
  const longer = text.replace("follow: {}", "follow: { next: rest }\n        rest: {}");
  await editor.change(uri, 4, { text: longer });
  await editor.diagnostics(uri, 4);
  const where = position(longer, "rest: {}");
  const actions = await editor.request("textDocument/codeAction", {
    textDocument: { uri },
    range: { start: where, end: where },
    context: { diagnostics: [] },
  });
  const write = actions.find((one) => /Write the transition function rest into src\/control.cpp/.test(one.title));
  const code = applied(readFileSync(join(folder, "src/control.cpp"), "utf8"), write.edit.documentChanges[0].edits);
  assert.match(code, /void rest\(Context& context, const Inputs& in, Memory& memory, Outputs& out\) {}\n\n}/);
  await editor.change(uri, 5, { text });
});

test("answers unknown and wrong requests with errors, and lives on", async () => {
  const code = (wanted) => (error) => error.code === wanted;
  await assert.rejects(editor.request("textDocument/formatting", {}), code(-32601));
  await assert.rejects(editor.request("textDocument/hover", { textDocument: {} }), code(-32602));
  await assert.rejects(editor.request("textDocument/hover", [1]), code(-32602));
  await editor.notify("textDocument/didOpen", { nothing: true });
  await editor.notify("textDocument/didChange", { textDocument: { uri: "file:///nowhere" }, contentChanges: [{ text: "" }] });
  assert.equal(await editor.request("textDocument/hover", { ...at("rate:"), textDocument: { uri: "file:///nowhere.txt" } }), null);
  const before = await new Editor();
  await assert.rejects(before.request("textDocument/hover", at("rate:")), code(-32002));
  before.server.stdin.end();
  assert.equal(await before.ended, 1);
  before.connection.dispose();
});

test("outlives what is no message", async () => {
  const server = spawn(command, ["lsp"], { stdio: ["pipe", "pipe", "inherit"] });
  const ended = new Promise((resolve) => server.once("exit", (code, signal) => resolve(signal ?? code)));
  let out = "";
  server.stdout.on("data", (part) => (out += part));
  const frame = (body) => `Content-Length: ${Buffer.byteLength(body)}\r\n\r\n${body}`;
  server.stdin.end(frame("{ no json") + frame("[]") + frame('"x"') + frame('{"jsonrpc":"2.0","method":"exit"}'));
  assert.equal(await ended, 1);
  assert.match(out, /-32700/);
});

test("answers on every prefix of the examples", async () => {
  const typing = pathToFileURL(join(folder, "typing.yaml")).href;
  await editor.open(typing, "");
  let version = 1;
  for (const name of readdirSync(examples)) {
    const whole = readFileSync(join(examples, name, "spec.yaml"), "utf8");
    await editor.change(typing, ++version, { text: "" });
    // Character by character in the first example, as a person types; the others a line at a time. With
    // TESSERA_EVERY_PREFIX character by character in all of them, which takes minutes.
    const byCharacter = process.env.TESSERA_EVERY_PREFIX || (name.startsWith("01") && !process.env.TESSERA_SLOW);
    const parts = byCharacter ? [...whole] : whole.split(/(?<=\n)/);
    let line = 0;
    let character = 0;
    const answers = [];
    for (const part of parts) {
      const start = { line, character };
      await editor.change(typing, ++version, { range: { start, end: start }, text: part });
      const rows = part.split("\n");
      line += rows.length - 1;
      character = rows.length > 1 ? rows.at(-1).length : character + part.length;
      const here = { textDocument: { uri: typing }, position: { line, character } };
      const all = ["completion", "hover", "definition", "references", "prepareRename"];
      for (const method of version % 10 === 0 ? all : all.slice(0, 2))
        answers.push(editor.request(`textDocument/${method}`, { ...here, context: { includeDeclaration: true } }));
    }
    await Promise.all(answers);
    if (process.env.TESSERA_EVERY_PREFIX) console.log(`# ${name}: ${parts.length} prefixes, ${answers.length} answers`);
  }
  assert.ok(await editor.diagnostics(typing, version));
});

test("leaves the spec.yaml of other programs alone", async () => {
  const other = pathToFileURL(join(folder, "other/spec.yaml")).href;
  await editor.open(other, "tessera: 1\n");
  assert.ok((await editor.diagnostics(other, 1)).length > 0);
  await editor.change(other, 2, { text: "openapi: 3.0.0\ninfo:\n" });
  assert.deepEqual(await editor.diagnostics(other, undefined), []);
  const here = { textDocument: { uri: other }, position: { line: 1, character: 0 } };
  assert.deepEqual((await editor.request("textDocument/completion", here)).items, []);
});

test("shows the mistakes of an included file in that file, as it is saved", async () => {
  const project = join(folder, "parted");
  mkdirSync(join(project, "parts"), { recursive: true });
  const types = text.slice(text.indexOf("types:"), text.indexOf("parameters:"));
  const part = join(project, "parts", "types.yaml");
  const partUri = pathToFileURL(part).href;
  const ownUri = pathToFileURL(join(project, "spec.yaml")).href;
  writeFileSync(part, `tessera: 1\n${types.replace("left: bool", "left: bol")}`);
  const own = text.replace(types, "include: parts/types.yaml\n");
  const told = (uri, fits) =>
    new Promise((resolve) => {
      const look = () => {
        const one = [...editor.published.values()].find((each) => decodeURIComponent(each.uri) === decodeURIComponent(uri));
        if (!one || !fits(one.diagnostics)) return false;
        resolve(one.diagnostics);
        return true;
      };
      if (!look()) editor.waiting.push(look);
    });
  await editor.open(ownUri, own);
  const [mistake] = await told(partUri, (all) => all.length > 0);
  assert.equal(mistake.code, "E101");
  assert.deepEqual(mistake.range.start, { line: 2, character: types.split("\n")[1].indexOf("bool") });
  assert.deepEqual(await editor.diagnostics(ownUri, 1), []);
  await assert.rejects(
    editor.request("textDocument/rename", {
      textDocument: { uri: ownUri },
      position: position(own, "follow: {}"),
      newName: "left",
    }),
    /'left' stands on line \d+ of parts\/types.yaml/,
  );
  const pursued = await editor.request("textDocument/rename", {
    textDocument: { uri: ownUri },
    position: position(own, "follow: {}"),
    newName: "pursue",
  });
  assert.deepEqual(Object.keys(pursued.changes ?? {}).length + (pursued.documentChanges ?? []).length > 0, true);
  await editor.open(partUri, `tessera: 1\n${types}`);
  writeFileSync(part, `tessera: 1\n${types}`);
  await editor.notify("textDocument/didSave", { textDocument: { uri: partUri } });
  assert.deepEqual(await told(partUri, (all) => all.length === 0), []);
});

test("answers within 50 ms in a file of a thousand lines", async () => {
  const agents = Array.from({ length: 55 }, (_, i) => text.slice(text.indexOf("  robot:"), text.indexOf("channels:")).replace("robot", `robot_${i}`));
  const large = text.slice(0, text.indexOf("  robot:")) + agents.join("") + text.slice(text.indexOf("channels:")).replaceAll("robot.", "robot_7.");
  assert.ok(large.split("\n").length > 1000);
  const big = pathToFileURL(join(folder, "large.yaml")).href;
  await editor.open(big, large);
  await editor.diagnostics(big, 1);
  const here = { textDocument: { uri: big }, position: position(large, "next: follow", 8) };
  // The time that the server computes, which the load of the machine changes little: nanoseconds of its first thread.
  const computed = () => Number(readFileSync(`/proc/${editor.server.pid}/schedstat`, "utf8").split(" ")[0]) / 1e6;
  const times = {};
  const rounds = process.env.TESSERA_SLOW ? 1 : 5;
  let version = 1;
  const start = { line: 0, character: 0 };
  for (const method of ["completion", "hover", "definition", "references", "documentSymbol", "rename"]) {
    const taken = [];
    for (let round = 0; round < rounds; ++round) {
      const begin = computed();
      await editor.change(big, ++version, { range: { start, end: start }, text: "#" });
      await editor.request(`textDocument/${method}`, {
        ...here,
        newName: `other_${round}`,
        context: { includeDeclaration: true },
      });
      taken.push(computed() - begin);
    }
    times[method] = Math.min(...taken);
  }
  // The same with a picture, of a text without mistakes. Its drawing is graphviz's, and does not hold up an answer.
  const channels = text.match(/^channels:\n((?:  .*\n)*)/m)[1];
  const sound = `${text.slice(0, text.indexOf("  robot:"))}${agents.join("")}channels:\n${agents
    .map((_, i) => channels.replaceAll("robot.", `robot_${i}.`))
    .join("")}`;
  await editor.change(big, ++version, { text: sound });
  const found = await editor.diagnostics(big, version);
  assert.deepEqual(found.filter((one) => one.severity === 1), []);
  here.position = position(sound, "next: follow", 8);
  const drawn = [];
  await pictured(() => editor.request("textDocument/hover", here));
  for (let round = 0; round < rounds; ++round) {
    const begin = computed();
    assert.match((await editor.request("textDocument/hover", here)).contents.value, /!\[page robot_0.control.follow\]/);
    drawn.push(computed() - begin);
  }
  times["hover with a picture"] = Math.min(...drawn);
  console.log("# milliseconds:", JSON.stringify(times));
  const limit = process.env.TESSERA_SLOW ? 2000 : 50;
  // A new name is judged by the parser, which reads the text twice; the user has just typed it in a dialogue.
  for (const [method, least] of Object.entries(times))
    assert.ok(least < (method === "rename" ? 10 * limit : limit), `${method}: ${least} ms`);
});
