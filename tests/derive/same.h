// Whether two derivations are the same, field by field.
#pragma once

#include <cmath>
#include <tuple>

#include "modeler/core/random.h"
#include "tests/derive/grammars.h"

namespace sgm::testing_ {

inline auto told(const derive::Shape& s) {
    return std::tie(s.key, s.parent, s.firstChild, s.lastChild, s.nextSibling, s.symbol, s.label, s.occurrence, s.depth,
                    s.solid, s.material, s.extras, s.valuesAt, s.jointSet, s.madeBy, s.chainRule, s.op, s.live, s.dead,
                    s.sharesPlace, s.meetsNobody, s.amount, s.blend_m, s.scope.centre, s.scope.axes, s.scope.size,
                    s.span.source, s.span.begin, s.span.end);
}
inline auto told(const derive::Bond& b) {
    return std::tie(b.shape[0], b.shape[1], b.joint[0], b.joint[1], b.shift, b.directed, b.next[0], b.next[1]);
}
inline auto told(const derive::Body& b) {
    return std::tuple(b.owner, b.firstBond, std::vector<uint32_t>(std::begin(b.bond), std::end(b.bond)));
}
inline auto told(const derive::Step& s) {
    return std::tie(s.rule, s.shape, s.generation, s.chainIndex, s.morphic, s.closing, s.firstMade, s.madeCount);
}
inline auto told(const derive::Extras& x) { return std::tie(x.clad, x.displace, x.values, x.tags); }

template <class List>
void expectSame(const List& a, const List& b, const char* what) {
    ASSERT_EQ(a.size(), b.size()) << what;
    for (size_t i = 0; i < a.size(); ++i) ASSERT_TRUE(told(a[i]) == told(b[i])) << what << ' ' << i;
}

/// The plan of a shape's scope, which each derivation numbers by itself; null for none.
inline const plan::Footprint* planOf(const derive::ShapeTree& tree, const derive::Shape& s) {
    return s.scope.footprint == derive::none ? nullptr : &tree.footprints[s.scope.footprint].footprint;
}

inline void expectSame(const derive::Derivation& a, const derive::Derivation& b) {
    for (size_t i = 0; i < std::min(a.tree.shapes.size(), b.tree.shapes.size()); ++i) {
        const plan::Footprint *mine = planOf(a.tree, a.tree.shapes[i]), *theirs = planOf(b.tree, b.tree.shapes[i]);
        ASSERT_EQ(mine == nullptr, theirs == nullptr) << "footprint of shape " << i;
        ASSERT_TRUE(!mine || *mine == *theirs) << "footprint of shape " << i;
    }
    expectSame(a.tree.shapes, b.tree.shapes, "shape");
    expectSame(a.tree.bonds().all, b.tree.bonds().all, "bond");
    expectSame(a.tree.bonds().bodies, b.tree.bonds().bodies, "body");
    EXPECT_EQ(a.tree.bonds().bodyOf, b.tree.bonds().bodyOf);
    EXPECT_EQ(a.tree.bonds().named, b.tree.bonds().named);
    expectSame(a.tree.extras, b.tree.extras, "extras");
    expectSame(a.steps, b.steps, "step");
    EXPECT_TRUE(a.tree.solids == b.tree.solids);
    EXPECT_EQ(a.tree.labels, b.tree.labels);
    EXPECT_TRUE(a.materials == b.materials);
    EXPECT_TRUE(a.params == b.params);
    EXPECT_EQ(a.closed.size(), b.closed.size());
    for (size_t i = 0; i < std::min(a.closed.size(), b.closed.size()); ++i)
        EXPECT_EQ(a.closed[i].count, b.closed[i].count);
    EXPECT_EQ(std::pair(a.classic, a.morphic), std::pair(b.classic, b.morphic));
}

/// A value somewhere in the parameter's range; where it has none, one of the choices or the other truth.
inline rules::Value drawn(const rules::Param& param, const rules::Value& now, uint64_t key) {
    rules::Value value = now;
    for (size_t i = 0; param.lo && i < param.value.count; ++i) {
        const double n = uniform(combine(key, i), param.lo->n[i], param.hi->n[i]);
        value.n[i] = param.value.integer ? std::round(n) : n;
    }
    if (!param.choices.empty()) value.text = param.choices[pick(key, param.choices.size())];
    if (param.value.kind == rules::Value::Kind::Bool) value.n[0] = 1 - now.n[0];
    return value;
}

}  // namespace sgm::testing_
