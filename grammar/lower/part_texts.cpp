#include "grammar/lower/part_texts.h"

#include "grammar/derive/path_text.h"

namespace sgm::lower {

using derive::none;

PartSource sourceOf(const derive::Derivation& derivation, const derive::Shape& shape) {
    PartSource source;
    source.symbol = derivation.tree.labels[shape.label];
    if (shape.madeBy != none) source.rule = derivation.grammar->rules[derivation.steps[shape.madeBy].rule].name;
    if (shape.span.source) {
        source.file = shape.span.source->name();
        source.line = shape.span.source->place(shape.span.begin).line;
    }
    return source;
}

PartSourcePtr PartTexts::madeBy(const derive::Shape& shape) {
    const uint32_t rule = shape.madeBy == none ? none : derivation_.steps[shape.madeBy].rule;
    Known& known = known_[(shape.span.begin * 5 + shape.label) % known_.size()];
    const bool same = known.source && known.label == shape.label && known.rule == rule &&
                      known.span.source == shape.span.source && known.span.begin == shape.span.begin;
    if (!same)
        known = {shape.label, rule, shape.span, std::make_shared<const PartSource>(sourceOf(derivation_, shape))};
    return known.source;
}

std::string ShapePaths::of(uint32_t shape) const {
    std::vector<derive::ShapeId> up;
    for (uint32_t s = shape; s != none; s = links_[s].parent) up.push_back(s);
    return derive::pathText(up, derive::shownPathParts, [this](derive::ShapeId s) {
        return derive::PathPart{labels_[links_[s].label], links_[s].occurrence};
    });
}

}  // namespace sgm::lower
