// Makes the shapes of elements: their solids, materials, joints and evaluated attributes.
// Enters: an element and where its expressions stand. Leaves: a shape without a place, its solid and its material in
// the lists of the derivation. Assumes checked elements.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>

#include "grammar/derive/attribute_context.h"
#include "grammar/derive/builder.h"
#include "modeler/image/texture.h"

namespace sgm::derive {

/// What is known of an element before it runs: filled at its first use.
struct ElementCache {
    uint64_t hash = 0;
    uint32_t label = 0, jointSet = 0, solid = none, closed = none;
    bool constantSolid = false;
    uint64_t solidParams = 0;  ///< those that the constant solid reads, as Piece::params
    uint32_t solidTurn = 0;    ///< in which run it was made (Recording::turn)
};

class ShapeMaker {
public:
    explicit ShapeMaker(TreeBuilder& builder) : builder_(builder), grammar_(*builder.derivation().grammar) {}

    ElementCache& factsOf(const rules::Element& e);
    /// Notes that the element found these joints of `host` closed (Derivation::closed).
    void noteClosed(const rules::Element& e, ShapeId host, const std::vector<uint32_t>& joints);
    /// The index of a label in the tree.
    uint32_t labelIndex(std::string_view text);
    /// What the element's attributes say of a newcomer at `place`; false after a failure.
    bool evaluateAttributes(const rules::Element& e, const Place& place, EvaluatedAttributes& out);
    /// The node of an element, unplaced: everything but parent, centre and children. What grows on it in a chain knows
    /// the chain's rule.
    Shape shapeOf(const rules::Element& e, EvaluatedAttributes& attributes, const Place& place, uint64_t key,
                  uint32_t chainRule);

private:
    uint32_t jointSetOf(const rules::Element& e);
    void standAsHigh(const rules::Element& e, const Place& place, EvaluatedAttributes& out);
    bool inBounds(const rules::Element& e, const EvaluatedAttributes& attributes);
    std::string nameOfColor(const rules::Expr& e, Vec3f color, const Place& place) const;
    std::string nameOfLook(const EvaluatedAttributes& attributes, uint32_t base, const Place& place) const;
    std::shared_ptr<const image::Texture> textureOf(const PlacedTexture& asked);
    uint32_t materialOf(const EvaluatedAttributes& attributes, const rules::Element& e, const Place& place);
    uint32_t solidOf(const rules::Element& e, ElementCache& facts, const Place& place, const Scope& scope);
    uint32_t blockSolid();

    TreeBuilder& builder_;
    const rules::Grammar& grammar_;
    std::unordered_map<const rules::Element*, ElementCache> elements_;
    std::map<std::string, uint32_t, std::less<>> labels_;
    /// Colour, roughness, metalness; texture.
    using Look = std::pair<std::array<float, 5>, std::shared_ptr<const image::Texture>>;
    std::map<Look, uint32_t> mixedMaterials_;  ///< those of attributes
    std::map<PlacedTexture, std::shared_ptr<const image::Texture>> textures_;
    uint32_t block_ = none;  ///< index of blockSolid
};

}  // namespace sgm::derive
