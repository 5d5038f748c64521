#include "grammar/pipeline/buried.h"

#include <fmt/format.h>

#include "grammar/lower/buried_parts.h"

namespace sgm::pipeline {

Result<std::vector<MeshWarning>> buriedWarnings(const Model& model, const mesh::Mesh& mesh, Context& context) {
    constexpr size_t most = 5;
    const auto buried = lower::findBuriedParts(model.derivation, *model.lowered, model.tape, mesh, context.progress);
    if (!buried.ok()) return buried.error();
    std::vector<MeshWarning> warnings;
    for (const lower::BuriedParts& parts : *buried) {
        if (warnings.size() == most) {
            const size_t left = buried->size() - most;
            warnings.push_back(
                {{}, {}, fmt::format("parts of {} more line{} add nothing", left, left == 1 ? "" : "s")});
            break;
        }
        const Part& part = model.lowered->provenance.parts[parts.first];
        const bool one = parts.count == 1;
        const std::string what = fmt::format("{} '{}'", one ? "a" : std::to_string(parts.count), part.symbol());
        std::string text =
            fmt::format("{} {} within other solids and add{} nothing: move {} out, or leave {} out", what,
                        one ? "lies" : "lie", one ? "s" : "", one ? "it" : "them", one ? "it" : "them");
        if (parts.cutter != 0) {
            const Part& cutter = model.lowered->provenance.parts[parts.cutter];
            text = fmt::format("{} {} cut away whole by '{}' ({}:{}): move either, or make the cut smaller", what,
                               one ? "is" : "are", cutter.symbol(), cutter.file(), cutter.line());
        }
        warnings.push_back({model.derivation.tree.shapes[model.lowered->shapeOf[parts.first]].span,
                            fmt::format("{}:{}: ", part.file(), part.line()), std::move(text)});
    }
    return warnings;
}

}  // namespace sgm::pipeline
