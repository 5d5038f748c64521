#include "grammar/language/textmate.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "grammar/language/words.h"
#include "grammar/operations/operations.h"
#include "grammar/rules/functions.h"
#include "grammar/rules/plans.h"
#include "modeler/field/primitives.h"

namespace sgm::language {
namespace {

using Json = nlohmann::ordered_json;

/// One of these words, whole.
template <class Rows, class NameOf>
std::string anyOf(const Rows& rows, NameOf nameOf) {
    std::vector<std::string> words;
    for (const auto& row : rows) words.emplace_back(nameOf(row));
    return fmt::format("\\b(?:{})\\b", fmt::join(words, "|"));
}

Json rule(const char* scope, const std::string& match) { return {{"name", scope}, {"match", match}}; }

/// Words of the language, the operations' before the solids' and functions', which share some.
void addWords(Json& patterns) {
    const auto keyword = [](const Keyword& k) { return k.word; };
    const auto name = [](const auto& row) { return row.name; };
    patterns.push_back(rule("keyword.control.declaration.sgm", "^" + anyOf(declarationWords(), keyword)));
    patterns.push_back(rule("storage.type.function.sgm", anyOf(rules::functions(), name) + "(?=\\()"));
    patterns.push_back(rule("keyword.control.sgm", anyOf(clauseWords(), keyword)));
    patterns.push_back(rule("keyword.control.declaration.sgm", anyOf(declarationWords(), keyword)));
    patterns.push_back(rule("support.function.operation.sgm",
                            anyOf(operations::table().rows(), [](const auto* row) { return row->name; })));
    patterns.push_back(rule("support.type.solid.sgm", anyOf(field::primitives(), name)));
    patterns.push_back(rule("support.function.plan.sgm", anyOf(rules::planRows(), name)));
    patterns.push_back(rule("variable.language.sgm", anyOf(valueWords(), keyword)));
    patterns.push_back(rule("entity.name.type.shape.sgm", "\\b[A-Z][A-Za-z0-9_]*\\b"));
    patterns.push_back(rule("variable.other.sgm", "\\b[a-z_][A-Za-z0-9_]*\\b"));
}

}  // namespace

std::string textMateGrammar() {
    Json patterns = Json::array();
    patterns.push_back(rule("comment.line.double-slash.sgm", "//.*$"));
    patterns.push_back(rule("string.quoted.double.sgm", R"("(?:\\["\\]|[^"])*(?:"|$))"));
    patterns.push_back(rule("constant.other.color.sgm", "#[A-Za-z0-9_]*"));
    patterns.push_back(rule("constant.numeric.sgm",
                            R"((?:\d+(?:\.\d+)?|\.\d+)(?:[eE][+-]?\d+)?(?:%|/m(?![A-Za-z0-9_])|[A-Za-z0-9_]*))"));
    addWords(patterns);
    patterns.push_back(rule("keyword.operator.sgm", R"(->|=>|~>|\.\.|==|!=|<=|>=|[-+*/%&|:,=<>.~!])"));
    const Json grammar{{"$schema", "https://raw.githubusercontent.com/martinring/tmlanguage/master/tmlanguage.json"},
                       {"name", "sgm"},
                       {"scopeName", "source.sgm"},
                       {"fileTypes", {"sgm"}},
                       {"patterns", patterns}};
    return grammar.dump(2) + "\n";
}

}  // namespace sgm::language
