// Runs the extension of VS Code with its real client, vscode-languageclient, on a stub of the editor. TESSERA names the
// command.
import assert from "node:assert/strict";
import { cpSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import Module, { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const root = join(here, "../..");
const require = createRequire(import.meta.url);
const client = require.resolve("vscode-languageclient/node");
const resolve = Module._resolveFilename;
// The extension lies in another folder, which need not be packed for this test.
Module._resolveFilename = function (request, ...rest) {
  if (request === "vscode") return join(here, "vscode_stub.cjs");
  if (request === "vscode-languageclient/node") return client;
  return resolve.call(this, request, ...rest);
};
const vscode = require("./vscode_stub.cjs");
const extension = require(join(root, "editors/vscode/extension.js"));
const { editor } = vscode;
const { providers } = editor.registered;
const token = new vscode.CancellationTokenSource().token;

let folder, specification, code;

before(async () => {
  folder = mkdtempSync(join(tmpdir(), "tessera client ä-"));
  cpSync(join(root, "examples/01_line_follower"), folder, { recursive: true });
  await extension.activate({ subscriptions: [] });
  specification = editor.open(join(folder, "spec.yaml"));
  code = editor.open(join(folder, "src/control.cpp"), "cpp");
  await editor.diagnostics(specification, (found) => found.length === 0);
});

after(async () => {
  await extension.deactivate();
  rmSync(folder, { recursive: true });
  assert.deepEqual(editor.registered.messages, [], "the client has complained");
});

/** The position of `word` in a document, `behind` characters on. */
function position(document, word, behind = 0) {
  const at = document.text.indexOf(word);
  assert.notEqual(at, -1, word);
  const lines = document.text.slice(0, at + behind).split("\n");
  return new vscode.Position(lines.length - 1, lines.at(-1).length);
}

const range = (document, word) => new vscode.Range(position(document, word), position(document, word, word.length));

function applied(document, edits) {
  return [...edits]
    .sort((a, b) => document.offsetAt(b.range.start) - document.offsetAt(a.range.start))
    .reduce(
      (text, edit) =>
        text.slice(0, document.offsetAt(edit.range.start)) + edit.newText + text.slice(document.offsetAt(edit.range.end)),
      document.text,
    );
}

test("diagnostics follow what is typed, and a code action corrects them", async () => {
  const where = range(specification, "next: follow");
  editor.change(specification, where, "next: folow");
  const [mistake] = await editor.diagnostics(specification, (found) => found.length > 0);
  assert.equal(mistake.code, "E101");
  assert.equal(mistake.severity, vscode.DiagnosticSeverity.Error);
  assert.deepEqual(mistake.range, range(specification, "folow"));
  const context = { diagnostics: [mistake], only: undefined, triggerKind: vscode.CodeActionTriggerKind.Invoke };
  const actions = await providers.codeActions.provideCodeActions(specification, mistake.range, context, token);
  assert.equal(actions[0].title, "Replace by 'follow'");
  assert.equal(actions[0].kind.value, "quickfix");
  const [edits] = actions[0].edit.edits.values();
  const corrected = applied(specification, edits);
  assert.match(corrected, /next: follow/);
  editor.change(specification, range(specification, "next: folow"), "next: follow");
  await editor.diagnostics(specification, (found) => found.length === 0);
});

test("completion", async () => {
  const list = await providers.completion.provideCompletionItems(
    specification,
    position(specification, "next: follow", 6),
    token,
    { triggerKind: vscode.CompletionTriggerKind.Invoke },
  );
  assert.deepEqual(
    (list.items ?? list).map((one) => one.label),
    ["init", "follow", "end"],
  );
});

test("hover, with the picture of a page", async () => {
  const hover = (word, behind) =>
    providers.hover.provideHover(specification, position(specification, word, behind), token);
  const buffer = await hover("motion: Velocity", 9);
  assert.match(buffer.contents[0].value, /linear: float64 m\/s/);
  // A picture is drawn meanwhile, and shown when it is ready.
  let value = "";
  for (let round = 0; round < 500 && !value.includes("!["); ++round) {
    value = (await hover("follow: {}", 2)).contents[0].value;
    await new Promise((next) => setTimeout(next, 20));
  }
  const [, title, svg] = /!\[(.*)\]\(data:image\/svg\+xml,(.*)\)/.exec(value);
  assert.equal(title, "page robot.control.follow");
  assert.match(decodeURIComponent(svg), /^<svg [^]*<\/svg>\n$/);
  assert.match(value, /Transition function/);
});

test("definition and references, in YAML and C++", async () => {
  const [there] = await providers.definition.provideDefinition(specification, position(specification, "follow: {}", 2), token);
  assert.equal(there.uri.fsPath, code.fileName);
  const [back] = await providers.definition.provideDefinition(code, there.range.start, token);
  assert.equal(back.uri.fsPath, specification.fileName);
  assert.equal(specification.getText(back.range), "follow");
  const uses = await providers.references.provideReferences(code, there.range.start, { includeDeclaration: true }, token);
  assert.deepEqual(
    [...new Set(uses.map((one) => one.uri.fsPath.split("/").at(-1)))].sort(),
    ["control.cpp", "control_test.cpp", "spec.yaml"],
  );
});

test("rename, in YAML and C++", async () => {
  const where = position(specification, "motion: Velocity", 2);
  const prepared = await providers.rename.prepareRename(specification, where, token);
  assert.equal(specification.getText(prepared.range ?? prepared), "motion");
  const edit = await providers.rename.provideRenameEdits(specification, where, "speed", token);
  const files = Object.fromEntries([...edit.edits].map(([uri, edits]) => [uri.split("/").at(-1), edits]));
  assert.deepEqual(Object.keys(files).sort(), ["control.cpp", "control_test.cpp", "spec.yaml"]);
  assert.match(applied(specification, files["spec.yaml"]), /outputs: { speed: Velocity }/);
  assert.match(applied(code, files["control.cpp"]), /out\.speed = steer/);
  // A field that only a compiler can find is left to the user.
  const field = await providers.rename.provideRenameEdits(specification, position(specification, "left: bool", 2), "port", token);
  assert.ok(field.asked > 0);
  await assert.rejects(
    Promise.resolve(providers.rename.provideRenameEdits(specification, position(specification, "init:", 1), "follow", token)),
    /'follow' is taken/,
  );
});

test("outline", async () => {
  const symbols = await providers.symbols.provideDocumentSymbols(specification, token);
  assert.deepEqual(
    symbols.at(-1).children.map((one) => one.name),
    ["control", "sensor", "motor"],
  );
});

test("other YAML gets no answers, and a file that says `tessera:` is adopted", async () => {
  writeFileSync(join(folder, "other.yaml"), "openapi: 3.0.0\n");
  writeFileSync(join(folder, "arm.yaml"), `# mine\n${readFileSync(join(folder, "spec.yaml"), "utf8")}`);
  const other = editor.open(join(folder, "other.yaml"));
  const arm = editor.open(join(folder, "arm.yaml"));
  await editor.diagnostics(arm, (found) => found.length === 0);
  assert.equal(arm.languageId, "tessera");
  assert.equal(other.languageId, "yaml");
  assert.equal(editor.registered.diagnostics.get(other.uri.toString()), undefined);
  editor.close(arm);
  editor.close(other);
});
