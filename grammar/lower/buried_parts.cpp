#include "grammar/lower/buried_parts.h"

#include <algorithm>
#include <array>
#include <map>
#include <tuple>

#include "grammar/derive/boxes.h"
#include "grammar/derive/lift.h"
#include "grammar/lower/cutters.h"
#include "modeler/eval/evaluate.h"

namespace sgm::lower {
namespace {

constexpr size_t mostSampled = 12;     ///< parts of an element
constexpr size_t mostElements = 200;   ///< that are sampled, the first ones
constexpr int latticeEdge = 9;         ///< points along each axis of a scope; odd, so that its middle lines are met
constexpr double leastAir = 0.95;      ///< share of the points of what a cut takes away
constexpr double latticeReach = 0.98;  ///< of a scope's half extent

/// What one element of a rule's body made.
struct ElementParts {
    std::vector<OriginId> parts;
    bool isVisible = false;
};

/// Whether a shape adds its solid to what stands, sharply, and so do all shapes above it; and nothing that follows them
/// blends or morphs what stands.
bool isAdded(const derive::ShapeTree& tree, derive::ShapeId shape) {
    // A shape's own solid comes before its children.
    derive::ShapeId next = tree.shapes[shape].firstChild;
    for (; shape != derive::none; next = tree.shapes[shape].nextSibling, shape = tree.shapes[shape].parent) {
        const rules::Operator op = tree.shapes[shape].op;
        if ((op != rules::Operator::None && op != rules::Operator::Sum) || tree.shapes[shape].blend_m > 0) return false;
        for (; next != derive::none; next = tree.shapes[next].nextSibling)
            if (tree.shapes[next].op == rules::Operator::Morph || tree.shapes[next].blend_m > 0) return false;
    }
    return true;
}

/// Whether the field at points of each scope belongs to its part.
class Lattice {
public:
    explicit Lattice(const eval::Tape& tape) : tape_(tape) {}

    /// Whether one of at most `mostSampled` parts owns a point of its scope.
    bool anyOwns(std::span<const OriginId> parts, std::span<const derive::Scope> scopes) {
        airOf_.clear(), points_ = 0;
        std::vector<Box3f> boxes;
        for (const derive::Scope& scope : scopes) boxes.push_back(derive::boxOf(scope).as<float>());
        std::array<eval::FloatInterval, mostSampled> ranges;
        const eval::RangeTrace trace =
            eval::evaluateRanges(tape_, {boxes.data(), boxes.size()}, ranges.data(), workspace_);
        for (size_t i = 0; i < parts.size(); ++i) {
            eval::shorten(tape_, trace, i, workspace_, local_);
            if (owns(parts[i], scopes[i])) return true;
        }
        return false;
    }
    /// Who made air of nearly all points that the last call looked at, and of most of them; 0 where nobody did.
    OriginId cutter() const {
        const auto most = std::max_element(airOf_.begin(), airOf_.end(),
                                           [](const auto& a, const auto& b) { return a.second < b.second; });
        size_t air = 0;
        for (const auto& [part, count] : airOf_) air += count;
        const bool isAir = static_cast<double>(air) >= leastAir * static_cast<double>(points_);
        return isAir && air > 0 && 2 * most->second > air ? most->first : 0;
    }

private:
    bool owns(OriginId part, const derive::Scope& scope) {
        std::vector<float> x, y, z;
        const auto share = [](int i) { return latticeReach * (2.0 * i / (latticeEdge - 1) - 1); };
        for (int k = 0; k < latticeEdge; ++k)
            for (int j = 0; j < latticeEdge; ++j)
                for (int i = 0; i < latticeEdge; ++i) {
                    const Vec3f p = scope.point({share(i), share(j), share(k)}).as<float>();
                    x.push_back(p.x), y.push_back(p.y), z.push_back(p.z);
                }
        std::vector<OriginId> owners(x.size());
        eval::evaluateOrigin(local_, {x.data(), y.data(), z.data(), x.size()}, owners.data(), workspace_);
        std::vector<float> values(x.size());
        eval::evaluate(local_, {x.data(), y.data(), z.data(), x.size()}, values.data(), workspace_);
        points_ += x.size();
        for (size_t i = 0; i < x.size(); ++i)
            if (values[i] > 0) ++airOf_[owners[i]];
        return std::find(owners.begin(), owners.end(), part) != owners.end();
    }

    const eval::Tape& tape_;
    eval::Tape local_;
    eval::Workspace workspace_;
    std::map<OriginId, size_t> airOf_;  ///< points in the air, by the part that made it
    size_t points_ = 0;
};

/// A scope whose lattice has points amid what stands out of a solid.
derive::Scope latticeScope(derive::Scope scope, const derive::SolidValue& solid) {
    if (const double out_m = derive::standsOut_m(solid, scope.size.y); out_m > 0) {
        scope.size.x = (scope.size.x + out_m) / latticeReach;
        scope.size.z = (scope.size.z + out_m) / latticeReach;
    }
    return scope;
}

/// Which parts the mesh shows, by part.
std::vector<bool> visibleParts(const mesh::Mesh& mesh, size_t count) {
    std::vector<bool> visible(count);
    for (const mesh::Chunk& chunk : mesh.chunks)
        for (const OriginId origin : chunk.origins) visible[origin] = true;
    return visible;
}

}  // namespace

Result<std::vector<BuriedParts>> findBuriedParts(const derive::Derivation& derivation, const Model& model,
                                                 const eval::Tape& tape, const mesh::Mesh& mesh, Progress* progress) {
    if (mesh.hasPositionsOnly() || mesh.triangleCount() == 0) return std::vector<BuriedParts>{};
    const derive::ShapeTree& tree = derivation.tree;
    const std::vector<bool> visible = visibleParts(mesh, model.shapeOf.size());
    std::map<std::tuple<const syntax::Source*, size_t, size_t>, ElementParts> elements;
    for (OriginId part = 1; part < model.shapeOf.size(); ++part) {
        if (model.shapeOf[part] == derive::none) continue;
        const derive::Shape shape = tree.shapes[model.shapeOf[part]];
        if (shape.solid == derive::none || !shape.span.source) continue;
        ElementParts& element = elements[{shape.span.source, shape.span.begin, shape.span.end}];
        element.isVisible = element.isVisible || visible[part];
        if (!element.isVisible) element.parts.push_back(part);
    }
    std::vector<ElementParts> hidden;
    for (auto& [span, element] : elements)
        if (!element.isVisible) hidden.push_back(std::move(element));
    std::sort(hidden.begin(), hidden.end(),
              [](const ElementParts& a, const ElementParts& b) { return a.parts[0] < b.parts[0]; });
    hidden.resize(std::min(hidden.size(), mostElements));
    const std::vector<bool> cuts = cutters(tree.shapes);
    Lattice lattice(tape);
    std::vector<BuriedParts> found;
    for (const ElementParts& element : hidden) {
        if (cancelled(progress)) return cancelledError();
        std::vector<OriginId> some;
        std::vector<derive::Scope> scopes;
        const size_t count = std::min(mostSampled, element.parts.size());
        for (size_t i = 0; i < count; ++i) {
            some.push_back(element.parts[i * element.parts.size() / count]);
            const derive::ShapeId shape = model.shapeOf[some.back()];
            scopes.push_back(latticeScope(derive::liftedScope(derivation, shape), *tree.solidOf(shape)));
        }
        const auto isAddedHere = [&](OriginId part) { return isAdded(tree, model.shapeOf[part]); };
        if (!std::all_of(some.begin(), some.end(), isAddedHere) || lattice.anyOwns(some, scopes)) continue;
        const OriginId by = lattice.cutter();
        const derive::ShapeId shape = by == 0 ? derive::none : model.shapeOf[by];
        const bool isCut = shape != derive::none && cuts[shape];
        found.push_back({element.parts.front(), element.parts.size(), isCut ? by : 0});
    }
    return found;
}

}  // namespace sgm::lower
