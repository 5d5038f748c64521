#include "grammar/lower/lower.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <map>
#include <set>

#include "grammar/derive/lift.h"
#include "grammar/lower/lowering.h"
#include "grammar/lower/solids.h"
#include "modeler/core/distinct_names.h"
#include "modeler/core/pages.h"
#include "modeler/core/parallel.h"
#include "modeler/core/random.h"
#include "modeler/field/domain.h"
#include "modeler/field/drape.h"

namespace sgm::lower {

void Lowering::noteTurn(ShapeId id) {
    const Shape& s = tree_.shapes[id];
    const bool turned = s.parent == none || !tree_.shapes.haveSameAxes(id, s.parent);
    turnedAt_[id] = turned ? id : turnedAt_[s.parent];
}

/// What hangs on a shape and its parent alone, in one pass: the shapes of a large tree are far more than the caches
/// hold. Makes room for all solids.
void Lowering::surveyShapes() {
    std::vector<PlacedPlan> plans;
    plain_.assign(tree_.shapes.size(), true);
    turnedAt_.resize(tree_.shapes.size());
    auto paths = std::make_shared<ShapePaths>(tree_);
    size_t solids = 0, planEdges = 0;
    for (ShapeId id = 0; id < tree_.shapes.size(); ++id) {
        const Shape& s = tree_.shapes[id];
        paths->add(s);
        const auto* x = tree_.extrasOf(id);
        if (x && !(x->displace.empty() && x->clad.empty() && x->relief == none)) plain_[id] = false;
        if (s.parent != none && !isSum(s)) plain_[s.parent] = false;
        noteTurn(id);
        solids += s.solid != none;
        if (s.solid == none || s.scope.footprint == none) continue;
        if (const auto plan = planUnder(tree_.solids[s.solid], s.scope)) {
            planEdges += tree_.footprints[plan->footprint].footprint.edgeCount();
            if (options_.threads != 1) plans.push_back(*plan);
        }
    }
    plans_.prepare(plans, options_.threads);
    texts_.take(std::move(paths));
    model_.graph.reserve(solids, planEdges);
    model_.provenance.parts.reserve(solids + 1);
    model_.shapeOf.reserve(solids + 1);
}

/// True when the shape's terms belong to its parent's sum.
bool Lowering::flattensIntoParent(ShapeId id) const {
    return tree_.shapes[id].parent != none && isSum(tree_.shapes[id]) && plain_[id];
}

namespace {

bool hasFlatFaces(const derive::SolidValue& solid) {
    if (solid.kind == rules::Solid::Kind::Primitive) return solid.primitive->hasFlatFaces;
    return solid.kind == rules::Solid::Kind::Combination &&
           std::all_of(solid.parts.begin(), solid.parts.end(), hasFlatFaces);
}

}  // namespace

/// Who owns surface: the part is made when it is first asked for.
OriginId Lowering::ownerOf(ShapeId id) {
    if (owners_[id] == 0) addPart(id);
    return owners_[id];
}

void Lowering::addPart(ShapeId id) {
    owners_[id] = static_cast<OriginId>(model_.provenance.parts.size());
    const Shape& s = tree_.shapes[id];
    Part& part = model_.provenance.parts.emplace_back();
    part.path = texts_.pathOf(id);
    part.madeBy = texts_.madeBy(s);
    part.material = materials_.of(id);
    part.pose = {s.scope.centre, s.scope.axes};
    if (!d_.reliefs.empty()) part.pose.origin = derive::liftedScope(d_, id).centre;
    const derive::SolidValue* solid = tree_.solidOf(id);
    part.hasFlatFaces = solid && hasFlatFaces(*solid);
    model_.shapeOf.push_back(id);
}

Owned Lowering::take(Content& content) {
    const Owned stands = takeParts(content);
    if (content.cuts.terms.empty()) return stands;
    const double blend_m = content.cuts.blend_m;
    if (blend_m <= 0) return {field::difference(stands, takeParts(content.cuts)), 0};
    const field::NodeRef radius =
        model_.graph.slot({content.cuts.blendKey, hashText("blend")}, static_cast<float>(blend_m));
    const field::Field cut = field::difference(stands, content.cuts.terms, radius, blend_m);
    content.cuts = {};
    return {cut, 0};
}

/// One part in place of the terms and the cuts.
void Lowering::flush(Content& content) {
    if (!content.terms.empty()) content.terms = {take(content)};
}

Owned Lowering::takeParts(Parts& content) {
    Owned result{field::nothing(model_.graph), 0};
    if (content.terms.size() == 1)
        result = content.terms[0];
    else if (content.blend_m > 0)
        result.field =
            field::blend(model_.graph, content.terms,
                         model_.graph.slot({content.blendKey, hashText("blend")}, static_cast<float>(content.blend_m)),
                         content.blend_m);
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
        if (content.blend_m > 0 || !content.cuts.terms.empty()) flush(content);
        content.terms.push_back(part);
        if (options_.keeps) content.from.push_back(id);
        return;
    }
    if (s.op == Operator::Sum || s.op == Operator::None) {
        if (content.blend_m != s.blend_m || !content.cuts.terms.empty()) {
            flush(content);
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
        if (alone || content.cuts.blend_m != s.blend_m) flush(content);
        if (alone) {
            content.terms = {{field::difference(content.terms[0], part), 0}};
            return;
        }
        if (content.cuts.terms.empty()) content.cuts.blend_m = s.blend_m, content.cuts.blendKey = s.key;
        content.cuts.terms.push_back(part);
        return;
    }
    const Owned stands = take(content);
    if (s.op == Operator::Intersection)
        content.terms = {{field::intersection(stands, part), 0}};
    else if (empty)
        content.terms = {part};
    else {
        const field::NodeRef t = model_.graph.slot({s.key, hashText("by")}, static_cast<float>(s.amount));
        const OriginId owner = ownerOf(id);
        model_.provenance.parts[owner].material = materials_.ofMorph(id);
        content.terms = {{field::morph(stands.field, part.field, t, s.amount, owner), owner}};
    }
}

/// The shape's own solid.
Owned Lowering::solidOf(ShapeId id) {
    const Shape& s = tree_.shapes[id];
    if (!again_) model_.graph.beginPath(s.key);
    return {lowerSolid(model_.graph, *tree_.solidOf(id), s.scope, s.key, tree_.shapes[turnedAt_[id]].key, plans_,
                       d_.grammar->meshes),
            ownerOf(id)};
}

/// Makes the boxes that wait: before anything else comes into the graph, or their terms are asked for.
void Lowering::placeBoxes() {
    if (row_.empty()) return;
    PageVector<Owned>& terms = open_.back().terms;
    if (terms.empty() && open_.back().shape == 0) terms.reserve(model_.shapeOf.capacity());
    if (options_.joinsBoxes) row_.join([this](ShapeId id) { return materials_.of(id); });
    row_.place(terms, static_cast<OriginId>(model_.provenance.parts.size()), [this] {
        for (const ShapeId id : row_.shapes()) addPart(id);
    });
}

void Lowering::enter(ShapeId id) {
    if (!again_) materials_.enter(id);
    if (!flattensIntoParent(id)) {
        placeBoxes();
        open_.push_back({{}, id, {}, {}});
    }
    const derive::SolidValue* const solid = tree_.solidOf(id);
    if (!solid) return;
    Content& content = open_.back();
    // A shape that is turned itself has its rotation's slots under its own key: a row has none but the boxes' there.
    const bool isBox =
        !again_ && turnedAt_[id] != id &&
        (BoxRow::takes(*solid) ||
         (options_.joinsBoxes && BoxRow::isWholeBlock(*solid, tree_.shapes.scopeOf(id), tree_.footprints)));
    if (!isBox || !row_.hasPlaceFor(turnedAt_[id])) placeBoxes();
    if (isBox) {
        if (content.blend_m > 0 || !content.cuts.terms.empty()) flush(content);
        row_.add(id, turnedAt_[id]);
    } else {
        const Owned part = solidOf(id);
        if (content.blend_m > 0 || !content.cuts.terms.empty()) flush(content);
        content.terms.push_back(part);
    }
    if (options_.keeps) content.from.push_back(id);
}

void Lowering::leave(ShapeId id) {
    if (flattensIntoParent(id)) return;
    placeBoxes();
    Owned part = draped(displaced(applyCladding(whole(open_.back(), id), id), id), id);
    open_.pop_back();
    if (options_.keeps) kept_.parts[id] = part;
    if (id == 0)
        model_.field = field::sum(model_.graph, std::span(&part, 1));  // one part alone keeps its owner
    else if (!open_.empty())
        attachToParent(id, part);
}

/// All that the node holds; a large plain sum is kept.
Owned Lowering::whole(Content& content, ShapeId id) {
    constexpr size_t many = 16;
    if (!options_.keeps || !plain_[id] || content.terms.size() < many) return take(content);
    for (uint32_t i = 0; i < content.from.size(); ++i) kept_.termOf[content.from[i]] = i;
    const field::Field sum = field::sum(model_.graph, content.terms);
    kept_.sums[id] = {std::move(content.terms), sum.value};
    return {sum, 0};
}

/// Gives a finished child to the node that is open.
void Lowering::attachToParent(ShapeId id, const Owned& part) {
    if (!part.field.bounds.empty())
        join(open_.back(), id, part);
    else if (tree_.shapes[id].op == Operator::Intersection)
        take(open_.back());  // nothing is shared with ε
}

/// Enters and leaves the shapes below `top`, and itself; the second time parts below it are known.
Status Lowering::walk(ShapeId top, Progress* progress) {
    uint32_t visited = 0;
    for (ShapeId s = top;;) {
        const bool known = again_ && s != top && !flattensIntoParent(s);
        if (known)
            attachToParent(s, kept_.parts[s]);
        else
            enter(s);
        if (progress) progress->tick();
        if (++visited % 256 == 0 && cancelled(progress))
            return Error{Error::Kind::Cancelled, "cancelled while lowering"};
        if (!known && tree_.shapes[s].firstChild != none) {
            s = tree_.shapes[s].firstChild;
            continue;
        }
        if (!known) leave(s);
        while (s != top && tree_.shapes[s].nextSibling == none) leave(s = tree_.shapes[s].parent);
        if (s == top) return Done{};
        s = tree_.shapes[s].nextSibling;
    }
}

Status Lowering::run(Progress* progress) {
    surveyShapes();
    if (options_.keeps) {
        kept_.parts.resize(tree_.shapes.size());
        kept_.termOf.resize(tree_.shapes.size(), none);
        for (const Shape& s : tree_.shapes) kept_.joins.push_back(isSum(s));
    }
    if (progress) progress->begin("lower", tree_.shapes.size());
    model_.shapeOf.push_back(none);
    Status done = Done{};
    std::atomic<bool> isWalked{false};
    const std::vector<UnusedMemory> unused = model_.graph.unusedMemory();
    parallelFor(2, options_.threads, nullptr, [&](size_t task, int) {
        if (task == 1) return clearAhead(unused, &isWalked);
        done = walk(0, progress);
        isWalked = true;
    });
    if (!done.ok()) return done;
    plans_.clear();
    if (noted_.refused != none)
        return syntax::errorAt(tree_.shapes[noted_.refused].span, Error::Kind::Budget,
                               fmt::format("'{}' is cladding in cladding in cladding: each level doubles the work; "
                                           "clad the parts, or fewer levels",
                                           tree_.path(noted_.refused)));
    if (noted_.boundless != none)
        return syntax::errorAt(tree_.shapes[noted_.boundless].span, Error::Kind::Input,
                               fmt::format("'{}': so much noise lies on noise that nobody can tell how far it reaches; "
                                           "displace less often, or by less",
                                           tree_.path(noted_.boundless)));
    nameTheWhole();
    mergeMaterials();
    layTextures(d_, model_);
    const bool nothing = model_.field.bounds.empty();
    if (nothing && !d_.objects.empty()) return Done{};  // objects of their own are all there is
    if (!nothing && model_.field.bounds.finite()) return Done{};
    if (nothing) return derive::nothingSolid(d_);
    return syntax::errorAt(tree_.shapes[0].span, Error::Kind::Input,
                           fmt::format("'{}' has no end: a half-space may only cut", tree_.path(0)));
}

/// Surface that no operand owns (a field of a single part) is the root's, with the first part's look.
void Lowering::nameTheWhole() {
    auto& parts = model_.provenance.parts;
    Part all = parts.size() > 1 ? parts[1] : Part{};
    if (parts.size() > 2) {
        PartSource source = all.source();
        source.symbol = tree_.labels[0], source.rule.clear();
        all.path = tree_.path(0);
        all.madeBy = std::make_shared<const PartSource>(std::move(source));
    }
    parts[0] = std::move(all);
    poseTheWhole();
}

/// The whole stands as the root does, or as the only part.
void Lowering::poseTheWhole() {
    auto& parts = model_.provenance.parts;
    const derive::Scope& root = tree_.shapes[0].scope;
    parts[0].pose = parts.size() == 2 ? parts[1].pose : Pose{root.centre, root.axes};
}

/// One material a look, of those that parts have: a look keeps the name of the first one that the grammar gives it, the
/// default's only where no other has it. Looks of one name are numbered.
void Lowering::mergeMaterials() {
    using Look = std::pair<std::array<float, 5>, std::shared_ptr<const image::Texture>>;
    const auto lookOf = [&](size_t i) {
        const Material& m = d_.materials[i];
        return Look{{m.color.x, m.color.y, m.color.z, m.roughness, m.metallic}, m.texture};
    };
    std::vector<bool> used(d_.materials.size());
    for (const Part& part : model_.provenance.parts) used[part.material] = true;
    const auto isNamed = [&](size_t i) { return i > 0 && lookOf(i) == lookOf(0); };
    std::vector<size_t> order;
    for (size_t i = 0; i < used.size(); ++i)
        if (used[i]) order.push_back(i);
    if (std::any_of(order.begin(), order.end(), isNamed)) std::stable_partition(order.begin(), order.end(), isNamed);

    std::vector<Material>& merged = model_.provenance.materials;
    merged.clear();
    std::vector<uint32_t> numbers(d_.materials.size(), 0);
    std::map<Look, uint32_t> looks;
    DistinctNames names;
    for (const size_t i : order) {
        const auto [at, fresh] = looks.try_emplace(lookOf(i), static_cast<uint32_t>(merged.size()));
        numbers[i] = at->second;
        if (!fresh) continue;
        merged.push_back(d_.materials[i]);
        merged.back().name = names.take(d_.materials[i].name);
    }
    for (Part& part : model_.provenance.parts) part.material = numbers[part.material];
}

Result<std::unique_ptr<Model>> lower(const derive::Derivation& derivation, Progress* progress, int threads,
                                     bool joinsBoxes) {
    auto model = std::make_unique<Model>();
    Lowering lowering(derivation, *model, {.keeps = false, .joinsBoxes = joinsBoxes, .threads = threads});
    if (const Status done = lowering.run(progress); !done.ok()) return done.error();
    return model;
}

}  // namespace sgm::lower
