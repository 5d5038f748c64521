// The extension in an editor that stands for VS Code: what it registers, how it starts the server, and what the preview shows.
"use strict";
const assert = require("assert");
const fs = require("fs");
const Module = require("module");
const os = require("os");
const path = require("path");
const test = require("node:test");

const root = path.resolve(__dirname, "../../..");
const program = process.env.SGM_PROGRAM ?? path.join(root, "build/release/cli/sgm");
const manifest = require("../package.json");

const calls = { commands: {}, errors: [], clients: [] };
let settings = { program };
const vscode = {
  ViewColumn: { Beside: -2 },
  workspace: {
    getConfiguration: () => ({ get: (name, usual) => settings[name] ?? usual }),
    onDidChangeConfiguration: () => ({ dispose() {} }),
    onDidChangeTextDocument: () => ({ dispose() {} }),
  },
  commands: { registerCommand: (name, run) => ((calls.commands[name] = run), { dispose() {} }), executeCommand: (name) => calls.commands[name]() },
  window: { showErrorMessage: (text) => calls.errors.push(text), showInformationMessage: (text) => calls.errors.push(text) },
};
class LanguageClient {
  constructor(...args) {
    this.args = args;
    calls.clients.push(this);
  }
  async start() {
    if (settings.program === "/nowhere") throw new Error("spawn /nowhere ENOENT");
    this.started = true;
  }
  async stop() {
    this.stopped = true;
  }
}
const load = Module._load;
Module._load = (name, ...rest) => {
  if (name === "vscode") return vscode;
  if (name === "vscode-languageclient/node") return { LanguageClient, TransportKind: { stdio: 0 } };
  return load(name, ...rest);
};
const extension = require("../extension");
const { Drawing, valueText } = require("../preview");

test("it registers its commands and starts the server", async () => {
  const context = { subscriptions: [], extensionPath: path.join(root, "integrations/vscode") };
  await extension.activate(context);
  assert.deepStrictEqual(Object.keys(calls.commands).sort(), manifest.contributes.commands.map((each) => each.command).sort());
  const [, , run, client] = calls.clients[0].args;
  assert.deepStrictEqual([run.run.command, run.run.args], [program, ["lsp"]]);
  assert.deepStrictEqual(client.documentSelector, [{ language: manifest.contributes.languages[0].id }]);
  await calls.commands["sgm.restart"]();
  assert.ok(calls.clients[0].stopped && calls.clients[1].started);
  calls.commands["sgm.preview"]();
  assert.match(calls.errors.pop(), /Open a grammar first/);
  settings = { program: "/nowhere" };
  await calls.commands["sgm.restart"]();
  assert.match(calls.errors.pop(), /sgm doesn't start.*sgm\.program/);
  settings = { program };
  await extension.deactivate();
});

test("what the manifest names is there", () => {
  for (const file of [manifest.main, manifest.contributes.grammars[0].path, manifest.contributes.languages[0].configuration, "preview.html"])
    assert.ok(fs.existsSync(path.join(root, "integrations/vscode", file)), file);
});

test("values are written as --set reads them", () => {
  assert.strictEqual(valueText({ kind: "real", unit: "%" }, 30), "30%");
  assert.strictEqual(valueText({ kind: "vector", unit: "m" }, [1, 2, 3]), "(1m, 2m, 3m)");
  assert.strictEqual(valueText({ kind: "text" }, 'a"b'), '"a\\"b"');
  assert.strictEqual(valueText({ kind: "boolean" }, true), "true");
  assert.strictEqual(valueText({ kind: "color" }, "#a0b0c0"), "#a0b0c0");
});

test("the preview follows the text and the sliders", { timeout: 120000 }, async () => {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), "sgm-test-"));
  const fileName = path.join(folder, "a.sgm");
  let text = "grammar 2\nparam n = 2 in 1..9\nstart A -> cube size (n, 1, 1)\n";
  const shown = [];
  const drawing = new Drawing(() => program, (message) => shown.push(message), 64);
  const document = { fileName, getText: () => text };
  await drawing.draw(document);
  assert.deepStrictEqual(shown.map((message) => Object.keys(message)[0]), ["panel", "picture"]);
  const first = shown[1].picture;
  assert.match(first, /^data:image\/png;base64,/);
  drawing.values.n = 9;
  await drawing.draw(document);
  assert.notStrictEqual(shown[3].picture, first);
  text = "grammar 2\nstart A -> spere\n";
  await drawing.draw(document);
  assert.match(shown[4].problems, /a\.sgm:2:12: error: unknown solid 'spere'/);
  text = "grammar 2\nstart A -> sphere\n";
  await Promise.all([drawing.draw(document), drawing.draw(document)]);
  assert.strictEqual(shown.filter((message) => message.picture).length, 3, "a newer picture takes the place of an older one");
  assert.deepStrictEqual(fs.readdirSync(folder), [], "nothing is left beside the grammar");
  drawing.dispose();
  fs.rmSync(folder, { recursive: true });
});
