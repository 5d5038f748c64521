// `sgm lsp` over its streams, and the VS Code extension, by the extension's own tests in Node.
#include "tests/cli/program.h"

namespace sgm::cli {
namespace {

bool works(const std::string& command) { return std::system((command + " > /dev/null 2>&1").c_str()) == 0; }

TEST(Editor, TextMateGrammarIsUpToDate) {
    EXPECT_EQ(sgm("reference --textmate").out, read("integrations/vscode/syntaxes/sgm.tmLanguage.json"))
        << "run: sgm reference --textmate > integrations/vscode/syntaxes/sgm.tmLanguage.json";
}

TEST(Editor, TreeSitterGrammarIsUpToDate) {
    EXPECT_EQ(sgm("reference --tree-sitter").out, read("integrations/tree-sitter/grammar.js"))
        << "run: sgm reference --tree-sitter > integrations/tree-sitter/grammar.js";
}

/// A message as the stream has it.
std::string framed(const Json& message) {
    const std::string text = message.dump();
    return "Content-Length: " + std::to_string(text.size()) + "\r\n\r\n" + text;
}

TEST(Editor, AnswersOnTheStreamsAndEnds) {
    const Scratch scratch;
    const std::string uri = "file:///nowhere/a.sgm";
    std::string input = framed({{"jsonrpc", "2.0"}, {"id", 1}, {"method", "initialize"}, {"params", Json::object()}});
    input += framed(
        {{"jsonrpc", "2.0"},
         {"method", "textDocument/didOpen"},
         {"params", {{"textDocument", {{"uri", uri}, {"version", 1}, {"text", "grammar 1\nstart A -> spere\n"}}}}}});
    // Long enough that others arrive while one is checked, however the threads are scheduled.
    std::string text = "grammar 1\nstart A -> sphere : B0\n";
    for (int i = 0; i < 1000; ++i)
        text += "rule B" + std::to_string(i) + " -> + cube at +x : B" + std::to_string(i + 1) + "\n";
    for (int version = 2; version < 40; ++version)
        input += framed(
            {{"jsonrpc", "2.0"},
             {"method", "textDocument/didChange"},
             {"params",
              {{"textDocument", {{"uri", uri}, {"version", version}}}, {"contentChanges", {{{"text", text}}}}}}});
    input += framed({{"jsonrpc", "2.0"},
                     {"id", 2},
                     {"method", "textDocument/hover"},
                     {"params", {{"textDocument", {{"uri", uri}}}, {"position", {{"line", 1}, {"character", 12}}}}}});
    input += framed({{"jsonrpc", "2.0"}, {"id", 3}, {"method", "shutdown"}}) +
             framed({{"jsonrpc", "2.0"}, {"method", "exit"}});
    const fs::path file = scratch.write("input", input);
    const Outcome run = sgm("lsp < " + file.string());
    EXPECT_EQ(run.code, 0) << run.out;
    EXPECT_NE(run.out.find("\"hoverProvider\":true"), std::string::npos);
    EXPECT_NE(run.out.find("`sphere`, solid"), std::string::npos) << run.out;
    EXPECT_NE(run.out.find("\"version\":39"), std::string::npos) << "the last text is checked";
    size_t told = 0;
    for (size_t at = 0; (at = run.out.find("publishDiagnostics", at)) != std::string::npos; ++at) ++told;
    EXPECT_LT(told, 20u) << "texts that are followed at once by another aren't";
}

TEST(Editor, TheExtensionsOwnTestsPass) {
    if (!works("command -v node")) GTEST_SKIP() << "node isn't installed";
    const std::string modules = fs::absolute("build/node_modules").string();
    if (!fs::exists(modules + "/vscode-textmate") || !fs::exists(modules + "/vscode-oniguruma") ||
        !fs::exists(modules + "/vscode-jsonrpc"))
        GTEST_SKIP() << "npm install --prefix build vscode-jsonrpc vscode-textmate vscode-oniguruma";
    const Scratch scratch;
    const std::string log = (scratch / "log").string();
    const std::string command = "SGM_PROGRAM=" SGM_PROGRAM " NODE_PATH=" + modules +
                                " node --test --test-concurrency=1 integrations/vscode/test/server.test.js "
                                "integrations/vscode/test/extension.test.js > " +
                                log + " 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0) << read(log);
}

}  // namespace
}  // namespace sgm::cli
