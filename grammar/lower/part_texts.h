// What parts say of where they came from: the text that made them and their path in the shape tree.
// Enters: a derivation. Leaves: texts, one for all parts of the same text, and paths that are made when asked for.
// Assumes a finished shape tree. Most paths of a large model are never asked for.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "grammar/derive/derive.h"
#include "modeler/core/pages.h"
#include "modeler/core/provenance.h"

namespace sgm::lower {

/// Symbol, rule, file and line of a shape.
PartSource sourceOf(const derive::Derivation& derivation, const derive::Shape& shape);

/// What paths are made of, which outlives the tree.
class ShapePaths final : public PartPaths {
public:
    explicit ShapePaths(const derive::ShapeTree& tree) : labels_(tree.labels) { links_.reserve(tree.shapes.size()); }
    /// The next shape of the tree, in order.
    void add(const derive::Shape& shape) { links_.push_back({shape.parent, shape.label, shape.occurrence}); }
    /// As ShapeTree::path: the middle of very deep ones is elided.
    std::string of(uint32_t shape) const override;

private:
    struct Link {
        uint32_t parent, label, occurrence;
    };
    std::vector<std::string> labels_;
    PageVector<Link> links_;
};

/// The texts of a derivation's parts.
class PartTexts {
public:
    explicit PartTexts(const derive::Derivation& derivation) : derivation_(derivation) {}
    /// Once, before `pathOf`.
    void take(std::shared_ptr<const ShapePaths> paths) { paths_ = std::move(paths); }
    PartPath pathOf(derive::ShapeId shape) const { return {paths_, shape}; }
    /// As `sourceOf`, shared by shapes that the same text made as long as it is among the latest.
    PartSourcePtr madeBy(const derive::Shape& shape);

private:
    struct Known {
        uint32_t label = derive::none, rule = derive::none;
        syntax::SourceSpan span;
        PartSourcePtr source;
    };
    const derive::Derivation& derivation_;
    std::array<Known, 256> known_;
    std::shared_ptr<const ShapePaths> paths_;
};

}  // namespace sgm::lower
