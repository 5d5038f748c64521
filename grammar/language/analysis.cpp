#include "grammar/language/analysis.h"

#include <algorithm>

#include "grammar/derive/derive.h"
#include "grammar/operations/operations.h"
#include "grammar/syntax/parser.h"

namespace sgm::language {

Analysis analyze(syntax::SourcePtr source, const rules::Loader& load) {
    Analysis result;
    const auto read = [&](syntax::SourcePtr each, syntax::Diagnostics& diagnostics) {
        result.files.push_back({each, syntax::parse(each, operations::table(), diagnostics), {}});
    };
    read(source, result.diagnostics);
    rules::Loader noting = load;
    std::vector<syntax::SourcePtr> used;
    noting.use = [&](const std::string& name, const syntax::Source& from, std::string& why) {
        syntax::SourcePtr found = load.use(name, from, why);
        const bool known =
            !found || found->name() == source->name() ||
            std::any_of(used.begin(), used.end(), [&](const auto& u) { return u->name() == found->name(); });
        if (!known) used.push_back(found);
        return found;
    };
    result.grammar = rules::check(result.files.front().ast, noting, result.diagnostics);
    for (const auto& each : used) {
        syntax::Diagnostics ignored;  // the check reports them
        read(each, ignored);
        result.diagnostics.keep(each);
    }
    for (const File& file : result.files) result.known.add(file.ast);
    for (File& file : result.files) file.names = occurrencesOf(file.ast, result.known);
    for (const File& file : result.files)
        for (const Occurrence& o : file.names) {
            if (!o.defines || o.kind == NameKind::Local) continue;
            const auto [entry, fresh] = result.definitions.try_emplace({o.kind, o.name}, &o);
            if (!fresh && entry->second->declaration.text().starts_with("start") &&
                !o.declaration.text().starts_with("start"))
                entry->second = &o;
        }
    return result;
}

std::optional<Figures> figuresOf(std::shared_ptr<const rules::Grammar> grammar, Progress* progress) {
    if (!grammar || grammar->starts.empty()) return std::nullopt;
    derive::Options options;
    options.budget.shapes = 100'000;
    options.budget.seconds = 2;
    const auto derivation = derive::derive(grammar, options, progress);
    if (!derivation.ok()) return std::nullopt;
    Figures figures;
    for (const derive::Step& step : derivation->steps) {
        auto& [applied, made] = figures.rules[grammar->rules[step.rule].name];
        ++applied;
        made += step.madeCount;
    }
    for (const derive::Shape& shape : derivation->tree.shapes) {
        ++figures.symbols[derivation->tree.labels[shape.label]];
        if (shape.span.source != grammar->sources[0].get() || shape.parent == derive::none) continue;
        const auto [at, fresh] = figures.sizes.try_emplace(shape.span.begin);
        Sizes& sizes = at->second;
        sizes.least = fresh ? shape.scope.size : min(sizes.least, shape.scope.size);
        sizes.most = fresh ? shape.scope.size : max(sizes.most, shape.scope.size);
        sizes.end = shape.span.end;
        ++sizes.count;
    }
    return figures;
}

}  // namespace sgm::language
