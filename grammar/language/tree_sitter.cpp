#include "grammar/language/tree_sitter.h"

#include <fmt/format.h>

#include <set>
#include <vector>

#include "grammar/language/words.h"
#include "grammar/operations/operations.h"
#include "grammar/rules/functions.h"
#include "grammar/rules/plans.h"
#include "modeler/field/primitives.h"

namespace sgm::language {
namespace {

/// The rules of words. A word that several tables have is of the first: a grammar's tokens may not overlap.
class Words {
public:
    template <class Rows, class NameOf>
    void add(const char* kind, const Rows& rows, NameOf nameOf) {
        std::vector<std::string> fresh;
        for (const auto& row : rows)
            if (const std::string word(nameOf(row)); taken_.insert(word).second) fresh.push_back("\"" + word + "\"");
        kinds_ += fmt::format(", $.{}", kind);
        rules_ += fmt::format("    {}: ($) => choice({}),\n", kind, fmt::join(fresh, ", "));
    }
    const std::string& kinds() const { return kinds_; }
    const std::string& rules() const { return rules_; }

private:
    std::set<std::string> taken_;
    std::string kinds_, rules_;
};

Words allWords() {
    const auto keyword = [](const Keyword& k) { return k.word; };
    const auto name = [](const auto& row) { return row.name; };
    Words words;
    words.add("declaration", declarationWords(), keyword);
    words.add("clause", clauseWords(), keyword);
    words.add("operation", operations::table().rows(), [](const auto* row) { return row->name; });
    words.add("solid", field::primitives(), name);
    words.add("function", rules::functions(), name);
    words.add("plan", rules::planRows(), name);
    words.add("value", valueWords(), keyword);
    return words;
}

}  // namespace

std::string treeSitterGrammar() {
    const Words words = allWords();
    return fmt::format(
        R"js(// Printed by `sgm reference --tree-sitter` from the parser's tables: the input of `tree-sitter generate`.
module.exports = grammar({{
  name: "sgm",
  extras: () => [/\s/],
  word: ($) => $.name,
  rules: {{
    source_file: ($) => repeat(choice($.comment, $.string, $.color, $.number{}, $.name, $.operator)),
    comment: () => token(/\/\/[^\n]*/),
    string: () => token(/"(\\["\\]|[^"\n])*"?/),
    color: () => token(/#[A-Za-z0-9_]*/),
    number: () => token(/(\d+(\.\d+)?|\.\d+)([eE][+-]?\d+)?(%|[A-Za-z0-9_]*)/),
{}    name: () => /[A-Za-z_][A-Za-z0-9_]*/,
    operator: () => token(/->|=>|~>|\.\.|==|!=|<=|>=|[-+*\/%&|:,=<>.~!(){{}}\[\];]/),
  }},
}});
)js",
        words.kinds(), words.rules());
}

}  // namespace sgm::language
