#include "grammar/derive/derive.h"

#include <fmt/format.h>

#include <algorithm>

#include "grammar/derive/rewriter.h"
#include "grammar/rules/params.h"

namespace sgm::derive {

using rules::Grammar;

Result<Derivation> emptyDerivation(std::shared_ptr<const Grammar> grammar, const Options& options) {
    if (options.start >= grammar->starts.size())
        return Error{Error::Kind::Usage, "the grammar has no start to derive from"};
    Derivation d;
    d.materials = grammar->materials;
    if (d.materials.empty()) d.materials.emplace_back();
    d.start = options.start;
    d.seed = options.seed;
    d.isPlaced = options.isPlaced;
    d.planAlone = options.planAlone;
    d.way = options.derive;
    d.isAlongWay = !options.derive.empty();
    d.params = options.params.empty() ? rules::valuesOf(*grammar, options.start) : options.params;
    for (size_t i = d.params.size(); i < grammar->params.size(); ++i) d.params.push_back(grammar->params[i].value);
    d.grammar = std::move(grammar);
    return d;
}

std::vector<Placement> placementsOf(const Derivation& derivation) {
    std::vector<Placement> placements;
    if (derivation.objects.empty()) return placements;
    for (ShapeId s = 0; s != none; s = derivation.tree.next(s))
        if (const Extras* extras = derivation.tree.extrasOf(s); extras && extras->object != none)
            placements.push_back({s, extras->object});
    return placements;
}

Result<Derivation> derive(std::shared_ptr<const Grammar> grammar, const Options& options, Progress* progress) {
    const rules::Derive* way = nullptr;
    if (!options.derive.empty()) {
        const auto found = std::find_if(grammar->derives.begin(), grammar->derives.end(),
                                        [&](const rules::Derive& d) { return d.name == options.derive; });
        if (found == grammar->derives.end())
            return Error{Error::Kind::Usage, fmt::format("the grammar has no derive way '{}'", options.derive)};
        way = &*found;
    }
    auto d = emptyDerivation(grammar, options);
    if (!d.ok()) return d;
    if (progress) progress->begin("derive", 0);

    TreeBuilder builder(*d, options.budget, progress);
    Rewriter rewriter(builder, d->params);
    rewriter.start(grammar->starts[options.start], options);
    if (way)
        rewriter.along(*way);
    else
        rewriter.automatic();
    if (builder.monitor().failed()) return builder.monitor().takeFailure();
    builder.finish();
    return d;
}

}  // namespace sgm::derive
