// Starts `tessera lsp` and connects it with the files of a project: its specification, and the C++ beside it.
const vscode = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

let client;

function command() {
  return vscode.workspace.getConfiguration("tessera").get("command") || "tessera";
}

/** A YAML file that says `tessera:` among its first lines, whatever its name. */
function adopt(document) {
  if (document.languageId !== "yaml" || document.uri.scheme !== "file") return;
  const head = document.getText(new vscode.Range(0, 0, 50, 0));
  if (/^tessera:\s/m.test(head)) vscode.languages.setTextDocumentLanguage(document, "tessera");
}

async function start() {
  const program = { command: command(), args: ["lsp"] };
  client = new LanguageClient("tessera", "Tessera", program, {
    initializationOptions: { pictures: "embedded" },
    // Only files that are specifications: other YAML belongs to other extensions.
    documentSelector: [
      { scheme: "file", language: "tessera" },
      { scheme: "file", pattern: "**/spec.yaml" },
      { scheme: "file", language: "cpp" },
    ],
  });
  try {
    await client.start();
  } catch (error) {
    const choice = await vscode.window.showErrorMessage(
      `Tessera: '${program.command} lsp' does not start (${error.message}). Is Tessera installed, and on the PATH?`,
      "Settings",
    );
    if (choice) vscode.commands.executeCommand("workbench.action.openSettings", "tessera.command");
  }
}

async function stop() {
  const old = client;
  client = undefined;
  if (old?.isRunning()) await old.stop();
}

exports.activate = async (context) => {
  context.subscriptions.push(
    vscode.workspace.onDidOpenTextDocument(adopt),
    vscode.commands.registerCommand("tessera.restart", () => stop().then(start)),
    vscode.workspace.onDidChangeConfiguration((change) => {
      if (change.affectsConfiguration("tessera.command")) stop().then(start);
    }),
  );
  vscode.workspace.textDocuments.forEach(adopt);
  await start();
};

exports.deactivate = stop;
