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
        warnings.push_back(
            {model.derivation.tree.shapes[model.lowered->shapeOf[parts.first]].span,
             fmt::format("{}:{}: ", part.file(), part.line()),
             fmt::format("{} '{}' {} within other solids and add{} nothing: move {} out, or leave {} out",
                         one ? "a" : std::to_string(parts.count), part.symbol(), one ? "lies" : "lie", one ? "s" : "",
                         one ? "it" : "them", one ? "it" : "them")});
    }
    return warnings;
}

}  // namespace sgm::pipeline
