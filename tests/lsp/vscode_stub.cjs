// The part of the module `vscode` that vscode-languageclient and our extension use, without an editor: documents that
// a test opens and changes, and the providers and diagnostics that the client registers.
"use strict";
const { readFileSync } = require("node:fs");

class Disposable {
  constructor(end = () => {}) {
    this.dispose = end;
  }
  static from(...all) {
    return new Disposable(() => all.forEach((one) => one.dispose()));
  }
}

class EventEmitter {
  constructor() {
    this.listeners = new Set();
    this.event = (listener, self) => {
      const bound = self === undefined ? listener : listener.bind(self);
      this.listeners.add(bound);
      return new Disposable(() => this.listeners.delete(bound));
    };
  }
  fire(what) {
    for (const listener of [...this.listeners]) listener(what);
  }
  dispose() {
    this.listeners.clear();
  }
}

class CancellationTokenSource {
  constructor() {
    this.token = { isCancellationRequested: false, onCancellationRequested: new EventEmitter().event };
  }
  cancel() {}
  dispose() {}
}

class Uri {
  constructor(scheme, path) {
    Object.assign(this, { scheme, path, fsPath: path, authority: "", query: "", fragment: "" });
  }
  static parse(text) {
    const [, scheme, path] = /^([a-z]+):(?:\/\/)?(.*)$/.exec(text);
    return new Uri(scheme, decodeURIComponent(path));
  }
  static file(path) {
    return new Uri("file", path);
  }
  toString() {
    return `${this.scheme}://${this.path.split("/").map(encodeURIComponent).join("/")}`;
  }
}

class Position {
  constructor(line, character) {
    Object.assign(this, { line, character });
  }
}
class Range {
  constructor(...ends) {
    if (ends.length === 4) ends = [new Position(ends[0], ends[1]), new Position(ends[2], ends[3])];
    [this.start, this.end] = ends;
  }
}
class Location {
  constructor(uri, range) {
    Object.assign(this, { uri, range });
  }
}
class Diagnostic {
  constructor(range, message, severity) {
    Object.assign(this, { range, message, severity });
  }
}
class CompletionItem {
  constructor(label, kind) {
    Object.assign(this, { label, kind });
  }
}
class CompletionList {
  constructor(items, isIncomplete) {
    Object.assign(this, { items, isIncomplete });
  }
}
class MarkdownString {
  constructor(value = "") {
    this.value = value;
  }
  appendMarkdown(more) {
    this.value += more;
    return this;
  }
  appendCodeblock(code) {
    return this.appendMarkdown(`\n\`\`\`\n${code}\n\`\`\`\n`);
  }
}
class Hover {
  constructor(contents, range) {
    Object.assign(this, { contents: [contents].flat(), range });
  }
}
class TextEdit {
  constructor(range, newText) {
    Object.assign(this, { range, newText });
  }
}
class CodeActionKind {
  constructor(value) {
    this.value = value;
  }
  append(part) {
    return new CodeActionKind(this.value ? `${this.value}.${part}` : part);
  }
}
CodeActionKind.Empty = new CodeActionKind("");
for (const kind of ["QuickFix", "Refactor", "Source"]) CodeActionKind[kind] = new CodeActionKind(kind.toLowerCase());
class CodeAction {
  constructor(title, kind) {
    Object.assign(this, { title, kind });
  }
}
class DocumentSymbol {
  constructor(name, detail, kind, range, selectionRange) {
    Object.assign(this, { name, detail, kind, range, selectionRange, children: [] });
  }
}
/** Edits by URI; `asked` are those that the user has to confirm. */
class WorkspaceEdit {
  constructor() {
    this.edits = new Map();
    this.created = [];
    this.asked = 0;
  }
  set(uri, edits) {
    const plain = edits.map((one) => (Array.isArray(one) ? one : [one, undefined]));
    this.asked += plain.filter(([, about]) => about?.needsConfirmation).length;
    this.edits.set(uri.toString(), [...(this.edits.get(uri.toString()) ?? []), ...plain.map(([edit]) => edit)]);
  }
  replace(uri, range, text, about) {
    this.set(uri, [[new TextEdit(range, text), about]]);
  }
  insert(uri, at, text, about) {
    this.replace(uri, new Range(at, at), text, about);
  }
  delete(uri, range, about) {
    this.replace(uri, range, "", about);
  }
  createFile(uri) {
    this.created.push(uri.toString());
  }
}

class TextDocument {
  constructor(path, languageId) {
    Object.assign(this, { uri: Uri.file(path), languageId, version: 1, text: readFileSync(path, "utf8") });
    Object.assign(this, { fileName: path, isDirty: false, isClosed: false, isUntitled: false, eol: 1 });
  }
  get lines() {
    return this.text.split("\n");
  }
  offsetAt({ line, character }) {
    return Math.min(this.text.length, this.lines.slice(0, line).reduce((sum, one) => sum + one.length + 1, 0) + character);
  }
  getText(range) {
    return range ? this.text.slice(this.offsetAt(range.start), this.offsetAt(range.end)) : this.text;
  }
}

const events = {};
const event = (name) => (events[name] ??= new EventEmitter()).event;
/** The registrations of the client: providers by kind, and collections of diagnostics. */
const registered = { providers: {}, diagnostics: new Map(), published: new EventEmitter(), messages: [] };

/** Whatever else is asked of a part of `vscode`: events that never happen, registrations without effect. */
function part(known) {
  return new Proxy(known, {
    get(target, name) {
      if (name in target || typeof name !== "string") return target[name];
      if (/^on(Did|Will)/.test(name)) return event(name);
      if (/^(register|create)/.test(name)) return () => new Disposable();
      if (/^show/.test(name)) return async (message) => void registered.messages.push(message);
      return undefined;
    },
  });
}

const documents = [];
const editor = {
  registered,
  open(path, languageId = "yaml") {
    const document = new TextDocument(path, languageId);
    documents.push(document);
    events.onDidOpenTextDocument?.fire(document);
    return document;
  },
  close(document) {
    documents.splice(documents.indexOf(document), 1);
    events.onDidCloseTextDocument?.fire(document);
  },
  /** Replaces a range as one key of a person does. */
  change(document, range, text) {
    const rangeOffset = document.offsetAt(range.start);
    const rangeLength = document.offsetAt(range.end) - rangeOffset;
    document.text = document.text.slice(0, rangeOffset) + text + document.text.slice(rangeOffset + rangeLength);
    ++document.version;
    const contentChanges = [{ range, rangeOffset, rangeLength, text }];
    events.onDidChangeTextDocument?.fire({ document, contentChanges, reason: undefined });
  },
  /** The diagnostics of a document, as soon as `wanted` is true of them. */
  diagnostics(document, wanted) {
    return new Promise((resolve) => {
      const look = () => {
        const found = registered.diagnostics.get(document.uri.toString());
        if (found === undefined || !wanted(found)) return;
        listening?.dispose();
        resolve(found);
      };
      const listening = registered.published.event(look);
      look();
    });
  },
};

function collection(name) {
  return {
    name,
    set(uri, found) {
      registered.diagnostics.set(uri.toString(), found ?? []);
      registered.published.fire();
    },
    delete: (uri) => registered.diagnostics.delete(uri.toString()),
    clear: () => registered.diagnostics.clear(),
    dispose() {},
  };
}

const provider =
  (kind) =>
  (selector, one) => {
    registered.providers[kind] = one;
    return new Disposable();
  };

function matches({ language, scheme, pattern }, { languageId, uri }) {
  if (language && language !== languageId) return false;
  if (scheme && scheme !== uri.scheme) return false;
  return !pattern || uri.path.endsWith(pattern.replace("**/", "/"));
}

const known = {
  editor,
  version: "1.82.0",
  Disposable,
  EventEmitter,
  CancellationTokenSource,
  CancellationError: class extends Error {},
  Uri,
  Position,
  Range,
  Location,
  Diagnostic,
  CompletionItem,
  CompletionList,
  MarkdownString,
  Hover,
  TextEdit,
  CodeActionKind,
  CodeAction,
  DocumentSymbol,
  WorkspaceEdit,
  DiagnosticSeverity: { Error: 0, Warning: 1, Information: 2, Hint: 3 },
  CompletionTriggerKind: { Invoke: 0, TriggerCharacter: 1, TriggerForIncompleteCompletions: 2 },
  CodeActionTriggerKind: { Invoke: 1, Automatic: 2 },
  CompletionItemKind: {},
  CompletionItemTag: { Deprecated: 1 },
  DiagnosticTag: { Unnecessary: 1, Deprecated: 2 },
  SymbolKind: {},
  SymbolTag: { Deprecated: 1 },
  ProgressLocation: { Window: 10 },
  FileType: { File: 1, Directory: 2 },
  TextDocumentSaveReason: { Manual: 1 },
  InlayHintKind: {},
  env: { appName: "stub", language: "en", openExternal: async () => true },
  extensions: part({ getExtension: () => undefined }),
  notebooks: part({}),
  commands: part({ executeCommand: async () => undefined }),
  workspace: part({
    textDocuments: documents,
    notebookDocuments: [],
    workspaceFolders: undefined,
    getWorkspaceFolder: () => undefined,
    getConfiguration: (section) => ({
      get: (key, otherwise) => (section === "tessera" && key === "command" ? process.env.TESSERA : otherwise),
      has: () => false,
      inspect: () => undefined,
    }),
    createFileSystemWatcher: () => part({ dispose() {} }),
    applyEdit: async () => true,
  }),
  window: part({
    activeTextEditor: undefined,
    visibleTextEditors: [],
    tabGroups: part({ all: [], close: async () => true }),
    createOutputChannel: (name) =>
      new Proxy({ name }, { get: (target, key) => target[key] ?? (() => {}) }),
    withProgress: (_, task) => task({ report() {} }, new CancellationTokenSource().token),
  }),
  languages: part({
    match: (selector, document) => ([selector].flat().some((one) => matches(one, document)) ? 10 : 0),
    createDiagnosticCollection: collection,
    setTextDocumentLanguage: async (document, language) => {
      editor.close(document);
      document.languageId = language;
      documents.push(document);
      events.onDidOpenTextDocument?.fire(document);
      return document;
    },
    registerCompletionItemProvider: provider("completion"),
    registerHoverProvider: provider("hover"),
    registerDefinitionProvider: provider("definition"),
    registerReferenceProvider: provider("references"),
    registerRenameProvider: provider("rename"),
    registerCodeActionsProvider: provider("codeActions"),
    registerDocumentSymbolProvider: provider("symbols"),
  }),
};

// Classes that the client derives from but never makes here.
module.exports = new Proxy(known, {
  get: (target, name) => target[name] ?? (/^[A-Z]/.test(String(name)) ? (target[name] = class {}) : undefined),
});
