#include "grammar/lower/incremental_lowering.h"

#include <algorithm>

#include "grammar/lower/lowering.h"

namespace sgm::lower {
namespace {

bool sameNode(const Owned& a, const Owned& b) {
    return a.field.value.id() == b.field.value.id() && a.origin == b.origin;
}

bool sameReach(const field::Field& a, const field::Field& b) {
    return a.bounds == b.bounds && a.lipschitz == b.lipschitz && a.growth == b.growth;
}

}  // namespace

/// The part whose content a shape belongs to, itself where it doesn't pour.
ShapeId Lowering::partOf(ShapeId id) const {
    while (flattensIntoParent(id)) id = tree_.shapes[id].parent;
    return id;
}

/// Puts a part in its place in the kept sum; false where it had none, or was another node.
bool Lowering::changeTerm(ShapeId part, ShapeId from, const Owned& to) {
    if (kept_.termOf[from] == none) return to.field.bounds.empty();
    Owned& known = kept_.sums.at(part).terms[kept_.termOf[from]];
    if (!sameNode(known, to) || to.field.bounds.empty()) return false;
    known = to;
    return true;
}

/// Notes which parts have to be made again for a shape that changed.
bool Lowering::mark(ShapeId id, Dirty& dirty) {
    const Shape& s = tree_.shapes[id];
    if (isSum(s) != kept_.joins[id]) return false;
    const ShapeId part = partOf(id);
    dirty.insert(part);
    if (s.solid != none && kept_.sums.contains(part) && !changeTerm(part, id, solidOf(id))) return false;
    // How it joins its parent may have changed.
    if (part == id && s.parent != none && !isSum(s)) dirty.insert(partOf(s.parent));
    return true;
}

/// Makes a part again, and marks what it belongs to where its reach is another.
bool Lowering::replayPart(ShapeId id, Dirty& dirty) {
    const Owned before = kept_.parts[id];
    if (const auto kept = kept_.sums.find(id); kept != kept_.sums.end()) {
        kept_.parts[id] = {field::summed(kept->second.value, kept->second.terms), 0};
        if (id == 0) model_.field = kept_.parts[id].field;
    } else if (!walk(id, nullptr).ok()) {
        return false;
    }
    const Owned& now = kept_.parts[id];
    if (!sameNode(before, now) || before.field.bounds.empty() != now.field.bounds.empty()) return false;
    if (id == 0 || sameReach(before.field, now.field)) return true;
    const ShapeId above = partOf(tree_.shapes[id].parent);
    dirty.insert(above);
    return !kept_.sums.contains(above) || changeTerm(above, id, now);
}

bool Lowering::replay(std::span<const ShapeId> changed) {
    // What dresses a shape hangs on the boxes of all below.
    if (std::any_of(tree_.extras.begin(), tree_.extras.end(), [](const derive::Extras& x) { return !x.clad.empty(); }))
        return false;
    again_ = true;
    plans_.clear();
    for (ShapeId id = 0; id < tree_.shapes.size(); ++id) noteTurn(id);
    open_.clear();
    const size_t nodes = model_.graph.nodeCount(), parts = model_.provenance.parts.size();
    Dirty dirty;
    for (const ShapeId id : changed)
        if (!mark(id, dirty)) return false;
    while (!dirty.empty()) {
        const ShapeId part = *dirty.begin();
        dirty.erase(dirty.begin());
        if (!replayPart(part, dirty)) return false;
    }
    for (const ShapeId id : changed) {
        const derive::Scope& scope = tree_.shapes[id].scope;
        if (owners_[id] != 0) model_.provenance.parts[owners_[id]].pose = {scope.centre, scope.axes};
    }
    poseTheWhole();
    layTextures(d_, model_);
    const Box3f& bounds = model_.field.bounds;
    return model_.graph.nodeCount() == nodes && model_.provenance.parts.size() == parts && !bounds.empty() &&
           bounds.finite();
}

IncrementalLowering::IncrementalLowering() = default;
IncrementalLowering::~IncrementalLowering() = default;
IncrementalLowering::IncrementalLowering(IncrementalLowering&&) noexcept = default;
IncrementalLowering& IncrementalLowering::operator=(IncrementalLowering&&) noexcept = default;

Status IncrementalLowering::startOver(const derive::Derivation& derivation, Progress* progress) {
    whole_ = true;
    lowering_.reset();
    model_ = std::make_unique<Model>();
    auto lowering = std::make_unique<Lowering>(derivation, *model_, Lowering::Options{.keeps = true, .threads = 0});
    const Status done = lowering->run(progress);
    if (done.ok()) lowering_ = std::move(lowering);
    return done;
}

Status IncrementalLowering::follow(const derive::Derivation& derivation, std::span<const ShapeId> changed,
                                   Progress* progress) {
    if (!lowering_ || !lowering_->replay(changed)) return startOver(derivation, progress);
    whole_ = false;
    return Done{};
}

}  // namespace sgm::lower
