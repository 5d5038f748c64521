#include "grammar/rules/check.h"

#include <fmt/format.h>

#include "grammar/rules/checker.h"
#include "grammar/rules/evaluate.h"
#include "grammar/rules/judge.h"
#include "grammar/rules/params.h"
#include "grammar/rules/uses.h"
#include "grammar/syntax/parser.h"

namespace sgm::rules {

std::shared_ptr<const Grammar> check(const syntax::Ast& ast, const Loader& load, syntax::Diagnostics& diagnostics) {
    const std::vector<syntax::Ast> asts = withUses(ast, load, diagnostics);
    auto grammar = std::make_shared<Grammar>();
    grammar->materials.emplace_back();
    grammar->sources.push_back(ast.source);
    for (size_t i = 0; i + 1 < asts.size(); ++i) grammar->sources.push_back(asts[i].source);

    Checker checker(*grammar, diagnostics);
    checker.excuse(diagnostics);
    const auto each = [&](void (Checker::*step)(const syntax::Ast&)) {
        for (const syntax::Ast& part : asts) (checker.*step)(part);
    };
    each(&Checker::declare);
    each(&Checker::refuse);
    each(&Checker::parameters);
    each(&Checker::terminals);
    each(&Checker::productions);
    each(&Checker::sayings);
    if (grammar->starts.empty() && !diagnostics.hasErrors())
        diagnostics.error({ast.source.get(), 0, 0}, "there is nothing to begin with", "write 'start Name -> cube'");
    if (!diagnostics.hasErrors()) findEndless(*grammar, diagnostics);
    if (diagnostics.hasErrors()) return nullptr;
    checker.unused(ast);
    findUnreachable(*grammar, diagnostics);
    return grammar;
}

std::shared_ptr<const Grammar> load(syntax::SourcePtr source, const Loader& load, syntax::Diagnostics& diagnostics) {
    return check(syntax::parse(std::move(source), diagnostics), load, diagnostics);
}

Result<Value> parseValue(const Param& param, const std::string& text) {
    const auto source = std::make_shared<const syntax::Source>("--set " + param.name, text);
    syntax::Diagnostics diagnostics;
    const syntax::Expr expr = syntax::parseExpression(source, diagnostics);
    Grammar empty;
    std::optional<Value> value;
    if (!diagnostics.hasErrors()) value = Checker(empty, diagnostics).plain(expr, !param.choices.empty());
    if (value) return conform(param, std::move(*value));
    const std::string why = diagnostics.all().empty() ? "it is no value" : diagnostics.all()[0].message;
    return Error{Error::Kind::Input, fmt::format("'{}' can't be '{}': {}", param.name, text, why)};
}

}  // namespace sgm::rules
