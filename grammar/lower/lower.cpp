#include "grammar/lower/lower.h"

#include <fmt/format.h>

#include "grammar/lower/materials.h"
#include "grammar/lower/solids.h"
#include "modeler/core/random.h"
#include "modeler/field/combine.h"

namespace sgm::lower {
namespace {

using derive::none;
using derive::Shape;
using derive::ShapeId;
using derive::ShapeTree;
using field::Owned;
using rules::Operator;

/// Parts of one pending n-ary sum, or of one pending blend.
struct Parts {
    std::vector<Owned> terms;
    double blend_m = 0;  ///< > 0: the terms are those of a blend with this radius
    uint64_t blendKey = 0;
};

/// What a node holds so far. Cuts in a row are gathered, for a − b − c = a − (b + c) and one sum of many parts is cheap.
struct Content : Parts {
    ShapeId shape = none;  ///< the node whose content this is
    Parts cuts;            ///< taken from the terms when anything else comes
};

/// Walks the tree once, without recursion. A child that only adds to what stands, and is itself a plain sum, pours its
/// terms into its parent's, so that thousands of parts meet in one n-ary sum.
class Lowering {
public:
    Lowering(const derive::Derivation& d, Model& model) : d_(d), tree_(d.tree), model_(model), materials_(d), owners_(d.tree.shapes.size()) {}

    Status run(Progress* progress);

private:
    void enter(ShapeId id);
    void leave(ShapeId id);
    void join(Content& content, ShapeId id, Owned part);
    Owned take(Content& content);
    Owned takeParts(Parts& parts);
    void settle(Content& content);
    OriginId ownerOf(ShapeId id);
    Owned dressed(Owned part, ShapeId id);
    Owned displaced(Owned part, ShapeId id);
    bool pours(ShapeId id) const;
    bool isSum(const Shape& s) const { return (s.op == Operator::Sum || s.op == Operator::None) && s.blend_m <= 0; }
    std::vector<bool> plainSums() const;

    const derive::Derivation& d_;
    const ShapeTree& tree_;
    Model& model_;
    Materials materials_;
    std::vector<Content> open_;
    std::vector<bool> plain_;  ///< by shape: its content is nothing but a sum
    std::vector<OriginId> owners_;  ///< by shape; 0: not asked for
};

std::vector<bool> Lowering::plainSums() const {
    std::vector<bool> plain(tree_.shapes.size(), true);
    for (ShapeId s = 0; s < tree_.shapes.size(); ++s) {
        const Shape& shape = tree_.shapes[s];
        if (const auto* x = tree_.extrasOf(s); x && !(x->displace.empty() && x->clad.empty())) plain[s] = false;
        if (shape.parent != none && !isSum(shape)) plain[shape.parent] = false;
    }
    return plain;
}

/// True when the shape's terms belong to its parent's sum.
bool Lowering::pours(ShapeId id) const { return tree_.shapes[id].parent != none && isSum(tree_.shapes[id]) && plain_[id]; }

/// Who owns surface: the part is made when it is first asked for.
OriginId Lowering::ownerOf(ShapeId id) {
    if (owners_[id] != 0) return owners_[id];
    owners_[id] = static_cast<OriginId>(model_.provenance.parts.size());
    const Shape& s = tree_.shapes[id];
    Part part;
    part.path = tree_.path(id);
    part.symbol = tree_.labels[s.label];
    if (s.madeBy != none) part.rule = d_.grammar->rules[d_.steps[s.madeBy].rule].name;
    if (s.span.source) {
        part.file = s.span.source->name();
        part.line = s.span.source->place(s.span.begin).line;
    }
    part.material = materials_.of(id);
    model_.provenance.parts.push_back(std::move(part));
    model_.shapeOf.push_back(id);
    return owners_[id];
}

Owned Lowering::take(Content& content) {
    const Owned stands = takeParts(content);
    if (content.cuts.terms.empty()) return stands;
    const double blend_m = content.cuts.blend_m;
    if (blend_m <= 0) return {field::difference(stands, takeParts(content.cuts)), 0};
    const field::Num radius = model_.graph.slot({content.cuts.blendKey, hashText("blend")}, static_cast<float>(blend_m));
    const field::Field cut = field::difference(stands, content.cuts.terms, radius, blend_m);
    content.cuts = {};
    return {cut, 0};
}

/// One part in place of the terms and the cuts.
void Lowering::settle(Content& content) {
    if (!content.terms.empty()) content.terms = {take(content)};
}

Owned Lowering::takeParts(Parts& content) {
    Owned result{field::nothing(model_.graph), 0};
    if (content.terms.size() == 1) result = content.terms[0];
    else if (content.blend_m > 0)
        result.field = field::blend(model_.graph, content.terms, model_.graph.slot({content.blendKey, hashText("blend")}, static_cast<float>(content.blend_m)), content.blend_m);
    else if (!content.terms.empty())
        result.field = field::sum(model_.graph, content.terms);
    content.terms.clear();
    content.blend_m = 0;
    return result;
}

/// Combines a finished child with what its parent holds so far.
void Lowering::join(Content& content, ShapeId id, Owned part) {
    const Shape& s = tree_.shapes[id];
    if (isSum(s)) {
        if (content.blend_m > 0 || !content.cuts.terms.empty()) settle(content);
        content.terms.push_back(part);
        return;
    }
    if (s.op == Operator::Sum || s.op == Operator::None) {
        if (content.blend_m != s.blend_m || !content.cuts.terms.empty()) {
            settle(content);
            content.blend_m = s.blend_m;
            content.blendKey = s.key;
        }
        content.terms.push_back(part);
        return;
    }
    const bool empty = content.terms.empty();
    if (empty && s.op != Operator::Morph) return;  // nothing to cut from, nothing to share
    if (s.op == Operator::Difference) {
        const bool alone = !part.field.bounds.finite() && s.blend_m <= 0;  // a half-space has no place in a hierarchy
        if (alone || content.cuts.blend_m != s.blend_m) settle(content);
        if (alone) {
            content.terms = {{field::difference(content.terms[0], part), 0}};
            return;
        }
        if (content.cuts.terms.empty()) content.cuts.blend_m = s.blend_m, content.cuts.blendKey = s.key;
        content.cuts.terms.push_back(part);
        return;
    }
    const Owned stands = take(content);
    if (s.op == Operator::Intersection) content.terms = {{field::intersection(stands, part), 0}};
    else if (empty) content.terms = {part};
    else {
        const field::Num t = model_.graph.slot({s.key, hashText("by")}, static_cast<float>(s.amount));
        content.terms = {{field::morph(stands.field, part.field, t, s.amount, ownerOf(id)), ownerOf(id)}};
    }
}

/// Cladding is a part of its own, named after its terminal.
Owned Lowering::dressed(Owned part, ShapeId id) {
    const auto* x = tree_.extrasOf(id);
    if (!x || x->clad.empty() || part.field.bounds.empty()) return part;
    const derive::Cladding& clad = x->clad[0];
    OriginId ornament = ownerOf(id);
    if (!clad.name.empty()) {
        Part own = model_.provenance.parts[ornament];
        own.path += "/" + clad.name;
        own.symbol = clad.name;
        if (clad.material != none) own.material = clad.material;
        ornament = static_cast<OriginId>(model_.provenance.parts.size());
        model_.provenance.parts.push_back(std::move(own));
        model_.shapeOf.push_back(id);
    }
    const derive::Scope box = tree_.contentBox(id);
    return {lowerClad(model_.graph, {part.field, part.origin, ornament}, clad.ornament, box, combine(tree_.shapes[id].key, hashText("clad"))), 0};
}

Owned Lowering::displaced(Owned part, ShapeId id) {
    const auto* x = tree_.extrasOf(id);
    if (!x || x->displace.empty() || part.field.bounds.empty()) return part;
    const Shape& s = tree_.shapes[id];
    for (size_t i = 0; i < x->displace.size(); ++i) {
        const derive::Displacement& n = x->displace[i];
        const uint64_t key = combine(s.key, i);
        part.field = field::displace(part.field, model_.graph.position(), n.fbm ? field::Noise::Fbm : field::Noise::Billow,
                                     model_.graph.slot({key, hashText("displace.amplitude")}, static_cast<float>(n.amplitude_m)), n.amplitude_m,
                                     model_.graph.slot({key, hashText("displace.frequency")}, static_cast<float>(n.frequency)), n.frequency, n.octaves,
                                     static_cast<uint32_t>(key >> 32));
    }
    return part;
}

void Lowering::enter(ShapeId id) {
    materials_.enter(id);
    if (!pours(id)) open_.push_back({{}, id, {}});
    if (const derive::SolidValue* solid = tree_.solidOf(id)) {
        const field::Field f = lowerSolid(model_.graph, *solid, tree_.shapes[id].scope, tree_.shapes[id].key,
                                          d_.grammar->meshes);
        Content& content = open_.back();
        if (content.blend_m > 0 || !content.cuts.terms.empty()) settle(content);
        content.terms.push_back({f, ownerOf(id)});
    }
}

void Lowering::leave(ShapeId id) {
    if (pours(id)) return;
    Owned part = displaced(dressed(take(open_.back()), id), id);
    open_.pop_back();
    if (open_.empty()) model_.field = field::sum(model_.graph, std::span(&part, 1));  // one part alone keeps its owner
    else if (!part.field.bounds.empty()) join(open_.back(), id, part);
    else if (tree_.shapes[id].op == Operator::Intersection) take(open_.back());  // nothing is shared with ε
}

Status Lowering::run(Progress* progress) {
    plain_ = plainSums();
    if (progress) progress->begin("lower", tree_.shapes.size());
    uint32_t visited = 0;
    for (ShapeId s = 0; s != none;) {
        enter(s);
        if (progress) progress->tick();
        if (++visited % 256 == 0 && cancelled(progress)) return Error{Error::Kind::Cancelled, "cancelled while lowering"};
        if (tree_.shapes[s].firstChild != none) {
            s = tree_.shapes[s].firstChild;
            continue;
        }
        for (;; s = tree_.shapes[s].parent) {
            leave(s);
            if (s == 0 || tree_.shapes[s].nextSibling != none) break;
        }
        s = s == 0 ? none : tree_.shapes[s].nextSibling;
    }
    return Done{};
}

}  // namespace

Result<std::unique_ptr<Model>> lower(const derive::Derivation& derivation, Progress* progress) {
    auto model = std::make_unique<Model>();
    model->provenance.materials = derivation.materials;
    model->shapeOf.push_back(none);
    Lowering lowering(derivation, *model);
    const Status done = lowering.run(progress);
    if (!done.ok()) return done.error();
    const bool nothing = model->field.bounds.empty();
    if (nothing || !model->field.bounds.finite()) {
        const std::string path = derivation.tree.path(0);
        const std::string what = nothing ? fmt::format("nothing solid is left of '{}'", path) : fmt::format("'{}' has no end: a half-space may only cut", path);
        return Error{Error::Kind::Input, syntax::placeText(derivation.tree.shapes[0].span) + what};
    }
    // Surface that no operand owns (a field of a single part) is the root's, with the first part's look.
    Part whole = model->provenance.parts.size() > 1 ? model->provenance.parts[1] : Part{};
    if (model->provenance.parts.size() > 2) whole.path = derivation.tree.path(0), whole.symbol = derivation.tree.labels[0], whole.rule.clear();
    model->provenance.parts[0] = std::move(whole);
    return model;
}

}  // namespace sgm::lower
