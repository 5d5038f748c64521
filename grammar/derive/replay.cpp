// The builder while a derivation runs again with other numbers: what is put is there already, and must be the same but
// for numbers.
#include <tuple>

#include "grammar/derive/builder.h"

namespace sgm::derive {

void TreeBuilder::diverge() {
    if (!failure_) failure_ = Error{Error::Kind::Internal, "the derivation takes another course"};
}

void TreeBuilder::beginPiece(Piece piece) {
    if (!recording_) return;
    endPiece();
    piece.from = end();
    recording_->begin(piece);
}

void TreeBuilder::endPiece() {
    if (!recording_->pieces().empty()) recording_->now().work = work_ - pieceBegan_;
    pieceBegan_ = work_;
}

Piece::Place TreeBuilder::end() const {
    const ShapeTree& t = derivation_.tree;
    return {t.shapes.size(), t.solids.size(), t.extras.size(), t.bonds.size(), derivation_.steps.size(), 0};
}

uint32_t TreeBuilder::put(SolidValue solid, bool shared) {
    auto& solids = tree().solids;
    if (!isReplaying()) {
        if (recording_ && shared) recording_->sharedSolid(solids.size());
        solids.push_back(std::move(solid));
        return static_cast<uint32_t>(solids.size() - 1);
    }
    const uint32_t index = shared ? none : recording_->nextSolid();
    if (index == none)
        diverge();
    else
        replace(index, std::move(solid));
    return index;
}

void TreeBuilder::replace(uint32_t index, SolidValue value) {
    if (tree().solids[index] == value) return;
    tree().solids[index] = std::move(value);
    recording_->solidDiffers(index);
}

uint32_t TreeBuilder::put(Extras extras) {
    auto& all = tree().extras;
    if (!isReplaying()) {
        all.push_back(std::move(extras));
        return static_cast<uint32_t>(all.size() - 1);
    }
    const uint32_t index = recording_->nextExtras();
    if (index == none) {
        diverge();
        return none;
    }
    Extras& known = all[index];
    const auto sameName = [](const auto& a, const auto& b) { return a.first == b.first; };
    const auto sameReport = [](const auto& a, const auto& b) { return a.first == b.first; };
    if (known.tags != extras.tags || known.laid != extras.laid ||
        !std::equal(known.reports.begin(), known.reports.end(), extras.reports.begin(), extras.reports.end(),
                    sameReport) ||
        !std::equal(known.values.begin(), known.values.end(), extras.values.begin(), extras.values.end(), sameName) ||
        known.clad.size() != extras.clad.size() || known.displace.size() != extras.displace.size())
        diverge();
    const bool looks = known.clad != extras.clad || known.displace != extras.displace;
    extrasChange_ = static_cast<uint8_t>((looks ? Recording::LookChanged : 0) |
                                         (known.values != extras.values ? Recording::Values : 0));
    if (extrasChange_ != 0)
        known = std::move(extras);
    else
        known.reports = std::move(extras.reports), known.laidScope = extras.laidScope;
    return index;
}

ShapeId TreeBuilder::replayShape(const Shape& made) {
    ShapeTree& t = tree();
    const ShapeId id = work() ? recording_->nextShape() : none;
    if (id == none) {
        diverge();
        return none;
    }
    Shape& known = t.shapes[id];
    const auto told = [](const Shape& s) {
        return std::tie(s.key, s.parent, s.symbol, s.label, s.jointSet, s.material, s.extras, s.chainRule, s.op,
                        s.span.source, s.span.begin, s.span.end);
    };
    const bool shares = made.parent != none && made.parent != 0 && made.op == rules::Operator::None &&
                        made.scope == t.shapes[made.parent].scope;
    const bool cleared = recording_->isCleared(id);
    if (recording_->isAnnotated(id) || told(known) != told(made) || known.madeBy != step_ || shares == ownsBody(id) ||
        (!cleared && known.solid != made.solid)) {
        diverge();
        return none;
    }
    uint8_t change = made.extras != none ? extrasChange_ : 0;
    if (made.solid != none && recording_->solidDiffered(made.solid)) change |= Recording::LookChanged;
    if (made.amount != known.amount || made.blend_m != known.blend_m) change |= Recording::LookChanged;
    if (made.scope.axes != known.scope.axes) change |= Recording::Turned;
    if (!(made.scope == known.scope)) change |= Recording::Moved;
    if (change == 0) return id;
    known.amount = made.amount;
    known.blend_m = made.blend_m;
    known.scope = made.scope;
    recording_->change(t, id, change);
    return id;
}

void TreeBuilder::replayBond(ShapeId a, uint32_t jointA, ShapeId b, uint32_t jointB) {
    const uint32_t index = recording_->nextBond();
    if (index == none) return diverge();
    const Bond& known = tree().bonds[index];
    const std::tuple told(known.shape[0], known.joint[0], known.shape[1], known.joint[1]);
    // A centre that came to a face closes the newcomer's face that looks back: which one, hangs on how both are turned.
    const bool turned =
        !known.directed && (recording_->has(a, Recording::Turned) || recording_->has(b, Recording::Turned));
    if (told != std::tuple(a, jointA, b, jointB) || turned) diverge();
}

void TreeBuilder::replayContacts(ShapeId id) {
    if (!recording_->has(id, Recording::Moved)) return;
    for (uint32_t j = 0; j < tree().jointCount(id); ++j) {
        const Joint joint = tree().joint(id, j);
        if (joint.direction == Vec3d{}) continue;
        joints_.move({id, j}, joints_.expect(joint));
        if (joints_.partner(tree(), {id, j}, joint) != recording_->partnerOf({id, j})) return diverge();
    }
}

bool TreeBuilder::revalidateContacts() {
    ShapeTree& t = tree();
    const auto moved = [&](ShapeId id) { return recording_->has(id, Recording::Moved); };
    const auto asBefore = [&](JointIndex::Entry e) {
        return moved(e.shape) || joints_.partner(t, e, t.joint(e.shape, e.joint)) == recording_->partnerOf(e);
    };
    for (const Recording::Contact& m : recording_->contacts())
        if (moved(m.partner.shape) && !asBefore(m.at)) return false;
    for (const ShapeId id : recording_->changed()) {
        if (!moved(id) || !ownsBody(id)) continue;
        for (uint32_t j = 0; j < t.jointCount(id); ++j) {
            const Joint joint = t.joint(id, j);
            bool same = true;
            if (joint.direction != Vec3d{})
                joints_.forFacing(t, joint, [&](JointIndex::Entry e) {
                    same = same && (e < JointIndex::Entry{id, j} || asBefore(e));
                });
            if (!same) return false;
        }
    }
    for (Bond& b : t.bonds)
        if (moved(b.shape[0]) || moved(b.shape[1]))
            b.shift = t.joint(b.shape[1], b.joint[1]).point - t.joint(b.shape[0], b.joint[0]).point;
    return true;
}

}  // namespace sgm::derive
