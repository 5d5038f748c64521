// The extension: starts `sgm lsp`, and shows a preview beside the text.
"use strict";
const vscode = require("vscode");
const { LanguageClient, TransportKind } = require("vscode-languageclient/node");
const { openPreview } = require("./preview");

let client;

function program() {
  return vscode.workspace.getConfiguration("sgm").get("program", "sgm");
}

async function start() {
  const run = { command: program(), args: ["lsp"], transport: TransportKind.stdio };
  client = new LanguageClient("sgm", "sgm", { run, debug: run }, { documentSelector: [{ language: "sgm" }] });
  try {
    await client.start();
  } catch (problem) {
    client = undefined;
    vscode.window.showErrorMessage(`sgm doesn't start: ${problem.message}. Name the program in the setting sgm.program.`);
  }
}

async function stop() {
  const stopped = client;
  client = undefined;
  if (stopped) await stopped.stop();
}

async function activate(context) {
  context.subscriptions.push(
    vscode.commands.registerCommand("sgm.restart", async () => {
      await stop();
      await start();
    }),
    vscode.commands.registerCommand("sgm.preview", () => {
      const editor = vscode.window.activeTextEditor;
      if (editor && editor.document.languageId === "sgm") return openPreview(context, editor.document, program);
      vscode.window.showInformationMessage("Open a grammar first: the preview shows the text of the active editor.");
    }),
    vscode.workspace.onDidChangeConfiguration((change) => {
      if (change.affectsConfiguration("sgm.program")) return vscode.commands.executeCommand("sgm.restart");
    }),
  );
  await start();
}

module.exports = { activate, deactivate: stop };
