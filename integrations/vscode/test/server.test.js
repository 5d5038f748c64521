// The server over its streams, as an editor drives it; and the highlighting beside the server's tokens.
"use strict";
const assert = require("assert");
const { spawn } = require("child_process");
const fs = require("fs");
const path = require("path");
const test = require("node:test");
const { pathToFileURL } = require("url");
const rpc = require("vscode-jsonrpc/node");

const root = path.resolve(__dirname, "../../..");
const program = process.env.SGM_PROGRAM ?? path.join(root, "build/release/cli/sgm");

function grammars(folder) {
  return fs
    .readdirSync(path.join(root, folder), { recursive: true })
    .filter((name) => name.endsWith(".sgm"))
    .sort()
    .map((name) => path.join(root, folder, name));
}

/** A server and a connection to it. */
async function connect() {
  const child = spawn(program, ["lsp"], { stdio: ["pipe", "pipe", "inherit"] });
  const connection = rpc.createMessageConnection(new rpc.StreamMessageReader(child.stdout), new rpc.StreamMessageWriter(child.stdin));
  const told = [];
  const waiting = [];
  connection.onNotification("textDocument/publishDiagnostics", (params) => {
    told.push(params);
    waiting.splice(0).forEach((resolve) => resolve());
  });
  connection.listen();
  const { capabilities } = await connection.sendRequest("initialize", { processId: process.pid, rootUri: null, capabilities: {} });
  connection.sendNotification("initialized", {});
  return {
    capabilities,
    told,
    ask: (method, params, ...token) => connection.sendRequest(method, params, ...token),
    tell: (method, params) => connection.sendNotification(method, params),
    /** Processor time of the server: other work on the machine doesn't count. */
    processorMs() {
      const tasks = fs.readdirSync(`/proc/${child.pid}/task`);
      return tasks.reduce((sum, task) => sum + Number(fs.readFileSync(`/proc/${child.pid}/task/${task}/schedstat`, "utf8").split(" ")[0]), 0) / 1e6;
    },
    /** The first diagnostics of this version or a later one that `fits`. */
    async problems(uri, version, fits = () => true) {
      for (;;) {
        const found = told.find((params) => params.uri === uri && params.version >= version && fits(params.diagnostics));
        if (found) return found.diagnostics;
        await new Promise((resolve) => waiting.push(resolve));
      }
    },
    async end() {
      await connection.sendRequest("shutdown");
      const code = new Promise((resolve) => child.on("exit", resolve));
      connection.sendNotification("exit");
      assert.strictEqual(await code, 0);
      connection.dispose();
    },
  };
}

function open(server, file, text = fs.readFileSync(file, "utf8")) {
  const uri = pathToFileURL(file).href;
  server.tell("textDocument/didOpen", { textDocument: { uri, languageId: "sgm", version: 1, text } });
  return uri;
}

test("problems are those of sgm check, with the model's", { timeout: 120000 }, async () => {
  const server = await connect();
  const file = path.join(root, "tests/bad/never.sgm");
  const uri = open(server, file, "grammar 2\nstart A -> cube size 1 - cube size 1 move (9, 0, 0)\n");
  const problems = await server.problems(uri, 1, (list) => list.length > 0);
  assert.match(problems[0].message, /this cuts nothing/);
  assert.strictEqual(problems[0].severity, 2);
  await server.end();
});

test("figures come to hovers when the models were tried", { timeout: 300000 }, async () => {
  const server = await connect();
  const uri = open(server, path.join(root, "examples/tower.sgm"));
  await server.problems(uri, 1);
  const at = { line: fs.readFileSync(path.join(root, "examples/tower.sgm"), "utf8").split("\n").findIndex((line) => line.startsWith("rule Storey")), character: 6 };
  // The models are tried once nothing has come in for a while; then the problems are told again.
  while (server.told.filter((params) => params.uri === uri).length < 2) await new Promise((resolve) => setTimeout(resolve, 100));
  const hover = await server.ask("textDocument/hover", { textDocument: { uri }, position: at });
  assert.match(hover.contents.value, /the rule runs \d+ times and makes \d+ shapes/);
  await server.end();
});

test("stale work is cancelled", { timeout: 60000 }, async () => {
  const server = await connect();
  const text = fs.readFileSync(path.join(root, "examples/buildings/palace.sgm"), "utf8");
  const uri = open(server, path.join(root, "examples/buildings/palace.sgm"), text);
  const changes = 200;
  for (let version = 2; version < changes + 2; version++)
    server.tell("textDocument/didChange", { textDocument: { uri, version }, contentChanges: [{ text: `${text}// ${version}\n` }] });
  const source = new rpc.CancellationTokenSource();
  const asked = server.ask("textDocument/completion", { textDocument: { uri }, position: { line: 3, character: 0 } }, source.token);
  source.cancel();
  await assert.rejects(asked, (problem) => problem.code === -32800);
  await server.problems(uri, changes + 1);
  const versions = server.told.filter((params) => params.uri === uri).length;
  assert.ok(versions < changes, `${versions} of ${changes} texts were checked`);
  await server.end();
});

test("a keystroke is answered in 50 ms", { timeout: 60000 }, async () => {
  const server = await connect();
  let text = 'grammar 2\nuse "std/house.sgm"\nstart Town -> P0\n';
  for (let i = 0; i < 330; i++) text += `param n${i} = 2 in 1..9\n// ${i}\nrule P${i} -> cube size (n${i}, 2, 3)${i < 329 ? ` + P${i + 1} at +x` : ""}\n`;
  const uri = open(server, path.join(root, "examples/long.sgm"), text);
  await server.problems(uri, 1);
  const times = [];
  for (let version = 2; version < 32; version++) {
    const begin = server.processorMs();
    const end = { line: 500, character: 0 };
    server.tell("textDocument/didChange", { textDocument: { uri, version }, contentChanges: [{ range: { start: end, end }, text: "\n" }] });
    await server.problems(uri, version);
    times.push(server.processorMs() - begin);
  }
  times.sort((a, b) => a - b);
  console.log(`a keystroke in 1,000 lines: median ${times[15].toFixed(1)} ms of the processor, most ${times[29].toFixed(1)} ms`);
  assert.ok(times[29] < 50, `${times[29]} ms`);
  await server.end();
});

test("streams that hold no messages end the server", { timeout: 20000 }, async () => {
  for (const input of ["", "nonsense\n\n", "Content-Length: 7\r\n\r\n{broken", "Content-Length: 99999999999\r\n\r\n", "Content-Length: 2\r\n\r\n[]"]) {
    const child = spawn(program, ["lsp"], { stdio: ["pipe", "pipe", "inherit"] });
    child.stdin.end(input);
    assert.strictEqual(await new Promise((resolve) => child.on("exit", resolve)), 0, input);
  }
});

async function textMate() {
  const oniguruma = require("vscode-oniguruma");
  const textmate = require("vscode-textmate");
  const wasm = fs.readFileSync(path.join(path.dirname(require.resolve("vscode-oniguruma")), "onig.wasm"));
  await oniguruma.loadWASM(wasm.buffer.slice(wasm.byteOffset, wasm.byteOffset + wasm.byteLength));
  const file = path.join(root, "integrations/vscode/syntaxes/sgm.tmLanguage.json");
  const registry = new textmate.Registry({
    onigLib: Promise.resolve({ createOnigScanner: (p) => new oniguruma.OnigScanner(p), createOnigString: (s) => new oniguruma.OnigString(s) }),
    loadGrammar: async () => textmate.parseRawGrammar(fs.readFileSync(file, "utf8"), file),
  });
  return { grammar: await registry.loadGrammar("source.sgm"), initial: textmate.INITIAL };
}

/** The tokens of a text by the TextMate grammar: for each line [{begin, end, scope}]. */
async function textMateTokens() {
  const { grammar, initial } = await textMate();
  return (lines) => {
    let state = initial;
    return lines.map((line) => {
      const result = grammar.tokenizeLine(line, state);
      state = result.ruleStack;
      return result.tokens.map((token) => ({ begin: token.startIndex, end: Math.min(token.endIndex, line.length), scope: token.scopes[token.scopes.length - 1] }));
    });
  };
}

/** The same by the tree-sitter grammar: what its generator makes of these rules, the longest token, words before names. */
function treeSitterTokens() {
  let rules;
  const names = { grammar: (read) => (rules = read.rules), choice: (...words) => words, repeat: (each) => each, token: (each) => each };
  new Function("module", ...Object.keys(names), fs.readFileSync(path.join(root, "integrations/tree-sitter/grammar.js"), "utf8"))({}, ...Object.values(names));
  const words = new Map();
  const patterns = [];
  for (const [kind, rule] of Object.entries(rules)) {
    if (kind === "source_file") continue;
    const made = rule(new Proxy({}, { get: (_, name) => name }));
    if (made instanceof RegExp) patterns.push([kind, new RegExp(made.source, "y")]);
    else made.forEach((word) => assert.ok(!words.has(word) && words.set(word, kind), `${word} is of two kinds`));
  }
  const scopes = { comment: "comment", string: "string", number: "constant.numeric", color: "constant.other", name: "variable.other", operator: "operator" };
  return (lines) =>
    lines.map((line) => {
      const tokens = [];
      for (let begin = 0; begin < line.length; ) {
        let end = begin;
        let kind;
        for (const [each, pattern] of /\s/.test(line[begin]) ? [] : patterns) {
          pattern.lastIndex = begin;
          if (pattern.test(line) && pattern.lastIndex > end) [end, kind] = [pattern.lastIndex, each];
        }
        const scope = kind === "name" && words.has(line.slice(begin, end)) ? "keyword" : scopes[kind];
        if (kind) tokens.push({ begin, end, scope });
        begin = Math.max(end, begin + 1);
      }
      return tokens;
    });
}

/** Compares tokens with those of the server over all grammars; `perMetre`: 3/m is a number and what follows. */
async function compareTokens(tokensOf, perMetre = false) {
  const server = await connect();
  const legend = server.capabilities.semanticTokensProvider.legend.tokenTypes;
  const wanted = { comment: /^comment/, string: /^string/, number: /^constant\.(numeric|other)/, keyword: /^(keyword|support|variable\.language|storage)/ };
  let compared = 0;
  for (const file of [...grammars("examples"), ...grammars("grammar/std")]) {
    const uri = open(server, file);
    const { data } = await server.ask("textDocument/semanticTokens/full", { textDocument: { uri } });
    const lines = fs.readFileSync(file, "utf8").split("\n");
    const tokens = tokensOf(lines);
    const literal = new Set();
    for (let i = 0, line = 0, character = 0; i < data.length; i += 5) {
      line += data[i];
      character = data[i] ? data[i + 1] : character + data[i + 1];
      const type = legend[data[i + 3]];
      const place = `${file}:${line + 1}:${character + 1} (${type})`;
      const token = tokens[line].find((each) => each.begin === character);
      const end = character + data[i + 2];
      const less = perMetre && type === "number" && lines[line].slice(character, end).endsWith("/m") ? 2 : 0;
      assert.ok(token && token.end === end - less, `${place}: ${JSON.stringify(token)}`);
      if (type in wanted) assert.match(token.scope, wanted[type], place);
      if (["comment", "string", "number"].includes(type)) literal.add(`${line}:${character}`);
      compared++;
    }
    tokens.forEach((row, line) =>
      row.forEach((token) => {
        if (/^(comment|string|constant)/.test(token.scope)) assert.ok(literal.has(`${line}:${token.begin}`), `${file}:${line + 1}:${token.begin + 1} ${token.scope}`);
      }),
    );
  }
  console.log(`${compared} tokens are alike`);
  assert.ok(compared > 5000);
  await server.end();
}

test("highlighting has the tokens of the lexer", { timeout: 120000 }, async () => compareTokens(await textMateTokens()));

test("the tree-sitter grammar has the tokens of the lexer", { timeout: 120000 }, async () => compareTokens(treeSitterTokens(), true));
