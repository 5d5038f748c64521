// The builder while a derivation runs again with other numbers: what is put is there already, and must be the same but
// for numbers.
#include <tuple>

#include "grammar/derive/builder.h"

namespace sgm::derive {

uint32_t TreeBuilder::put(SolidValue solid, bool shared) {
    auto& solids = tree().solids;
    if (!isReplaying()) {
        if (recording() && shared) recording()->made().sharedSolid(solids.size());
        solids.push_back(std::move(solid));
        return static_cast<uint32_t>(solids.size() - 1);
    }
    const uint32_t index = shared ? none : recording()->nextSolid();
    if (index == none)
        monitor_.diverge();
    else
        replace(index, std::move(solid));
    return index;
}

void TreeBuilder::replace(uint32_t index, SolidValue value) {
    if (tree().solids[index] == value) return;
    tree().solids[index] = std::move(value);
    recording()->changes().addSolid(index);
}

uint32_t TreeBuilder::put(Extras extras) {
    auto& all = tree().extras;
    if (!isReplaying()) {
        all.push_back(std::move(extras));
        return static_cast<uint32_t>(all.size() - 1);
    }
    const uint32_t index = recording()->nextExtras();
    if (index == none) {
        monitor_.diverge();
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
        monitor_.diverge();
    const bool looks = known.clad != extras.clad || known.displace != extras.displace;
    extrasChange_ = static_cast<uint8_t>((looks ? ShapeChanges::LookChanged : 0) |
                                         (known.values != extras.values ? ShapeChanges::Values : 0));
    if (extrasChange_ != 0)
        known = std::move(extras);
    else
        known.reports = std::move(extras.reports), known.laidScope = extras.laidScope;
    return index;
}

ShapeId TreeBuilder::replayShape(const Shape& made) {
    ShapeTree& t = tree();
    const ShapeId id = monitor_.work() ? recording()->nextShape() : none;
    if (id == none) {
        monitor_.diverge();
        return none;
    }
    const Shape known = t.shapes[id];
    const auto told = [](const Shape& s) {
        return std::tie(s.key, s.parent, s.symbol, s.label, s.jointSet, s.material, s.extras, s.chainRule, s.op,
                        s.span.source, s.span.begin, s.span.end);
    };
    const bool shares = made.parent != none && made.parent != 0 && made.op == rules::Operator::None &&
                        made.scope == t.shapes.scopeOf(made.parent);
    const bool cleared = recording()->made().isCleared(id);
    if (recording()->made().isAnnotated(id) || told(known) != told(made) || known.madeBy != monitor_.step() ||
        shares != known.sharesPlace || (!cleared && known.solid != made.solid)) {
        monitor_.diverge();
        return none;
    }
    uint8_t change = made.extras != none ? extrasChange_ : 0;
    if (made.solid != none && recording()->changes().hasSolid(made.solid)) change |= ShapeChanges::LookChanged;
    if (made.amount != known.amount || made.blend_m != known.blend_m) change |= ShapeChanges::LookChanged;
    if (made.scope.axes != known.scope.axes) change |= ShapeChanges::Turned;
    if (!(made.scope == known.scope)) change |= ShapeChanges::Moved;
    if (change == 0) return id;
    t.shapes.setJoining(id, {made.amount, made.blend_m});
    t.shapes.setScope(id, made.scope);
    recording()->changes().add(t, id, change);
    return id;
}

}  // namespace sgm::derive
