// A picture of the grammar beside its text. It follows edits and sliders: a newer one stops the drawing of an older one.
"use strict";
const { spawn } = require("child_process");
const fs = require("fs");
const os = require("os");
const path = require("path");
const vscode = require("vscode");

const SETTLED_MS = 300;

/** Runs sgm; resolves to {code, out, problems}. `stop()` ends it, and it resolves with code null. */
function run(program, args) {
  const child = spawn(program, args, { stdio: ["ignore", "pipe", "pipe"] });
  const out = [];
  const problems = [];
  child.stdout.on("data", (data) => out.push(data));
  child.stderr.on("data", (data) => problems.push(data));
  const done = new Promise((resolve) => {
    child.on("error", (problem) => resolve({ code: -1, out: "", problems: problem.message }));
    child.on("close", (code) => resolve({ code, out: Buffer.concat(out).toString(), problems: Buffer.concat(problems).toString() }));
  });
  return { done, stop: () => child.kill("SIGTERM") };
}

/** A parameter's value as `--set` takes it. */
function valueText(parameter, value) {
  const unit = parameter.unit ?? "";
  if (parameter.kind === "text") return JSON.stringify(String(value));
  if (Array.isArray(value)) return `(${value.map((part) => `${part}${unit}`).join(", ")})`;
  if (parameter.kind === "integer" || parameter.kind === "real") return `${value}${unit}`;
  return String(value);
}

/** Draws one document, again and again. `show(message)` takes {panel}, {picture} and {problems}. */
class Drawing {
  constructor(program, show, size) {
    this.program = program;
    this.show = show;
    this.size = size;
    this.values = {};
    this.folder = fs.mkdtempSync(path.join(os.tmpdir(), "sgm-preview-"));
    this.turn = 0;
  }

  /** Draws the text as it is now, saved or not. */
  async draw(document) {
    const turn = ++this.turn;
    this.running?.stop();
    // Beside the file, so that what it uses is found; hidden, and gone when the picture is there.
    const file = path.join(path.dirname(document.fileName), `.${path.basename(document.fileName, ".sgm")}.preview.sgm`);
    const picture = path.join(this.folder, `${turn}.png`);
    fs.writeFileSync(file, document.getText());
    try {
      const read = await this.step(["params", file, "--panel"]);
      if (turn !== this.turn) return;
      if (read.code !== 0) return this.show({ problems: read.problems.replaceAll(file, document.fileName) });
      const panel = JSON.parse(read.out);
      const settings = panel.parameters
        .filter((parameter) => parameter.name in this.values)
        .flatMap((parameter) => ["--set", `${parameter.name}=${valueText(parameter, this.values[parameter.name])}`]);
      this.show({ panel, values: this.values });
      const drawn = await this.step(["render", file, "-q", "--size", `${this.size}x${this.size}`, "-o", picture, ...settings]);
      if (turn !== this.turn) return;
      if (drawn.code !== 0) return this.show({ problems: drawn.problems.replaceAll(file, document.fileName) });
      this.show({ picture: `data:image/png;base64,${fs.readFileSync(picture).toString("base64")}` });
    } finally {
      if (turn === this.turn) fs.rmSync(file, { force: true });
      fs.rmSync(picture, { force: true });
    }
  }

  step(args) {
    this.running = run(this.program(), args);
    return this.running.done;
  }

  dispose() {
    this.turn++;
    this.running?.stop();
    fs.rmSync(this.folder, { recursive: true, force: true });
  }
}

function openPreview(context, document, program) {
  const panel = vscode.window.createWebviewPanel("sgm.preview", path.basename(document.fileName), vscode.ViewColumn.Beside, {
    enableScripts: true,
    retainContextWhenHidden: true,
  });
  panel.webview.html = fs.readFileSync(path.join(context.extensionPath, "preview.html"), "utf8");
  const size = vscode.workspace.getConfiguration("sgm").get("preview.size", 480);
  const drawing = new Drawing(program, (message) => panel.webview.postMessage(message), size);
  let timer;
  const soon = () => {
    clearTimeout(timer);
    timer = setTimeout(() => drawing.draw(document), SETTLED_MS);
  };
  const listeners = [
    vscode.workspace.onDidChangeTextDocument((change) => change.document === document && soon()),
    panel.webview.onDidReceiveMessage((message) => {
      if (message.reset) drawing.values = {};
      else drawing.values[message.name] = message.value;
      soon();
    }),
  ];
  panel.onDidDispose(() => {
    clearTimeout(timer);
    drawing.dispose();
    listeners.forEach((listener) => listener.dispose());
  });
  drawing.draw(document);
}

module.exports = { openPreview, Drawing, valueText };
