// Which material a shape's surface has: its own, or inherited down the tree.
// Enters: shapes in tree order. Leaves: indices into Derivation::materials. Assumes `enter` is called for a parent
// before its children and for elder siblings' subtrees before the younger.
#pragma once

#include "grammar/derive/derive.h"
#include "modeler/core/pages.h"

namespace sgm::lower {

class Materials {
public:
    explicit Materials(const derive::Derivation& derivation)
        : tree_(derivation.tree), own_(tree_.shapes.size(), 0), first_(tree_.shapes.size(), derive::none) {}

    /// Its own material where one is named, else its parent's; a cutter that names none takes that of the first solid
    /// it cuts, so that the wall of the cut looks like its host.
    void enter(derive::ShapeId id) {
        const derive::Shape& s = tree_.shapes[id];
        if (s.material != derive::none)
            own_[id] = s.material;
        else if (s.parent != derive::none) {
            const bool cuts = s.op == rules::Operator::Difference && first_[s.parent] != derive::none;
            own_[id] = cuts ? first_[s.parent] : own_[s.parent];
        }
        if (s.solid == derive::none) return;
        for (derive::ShapeId a = id; a != derive::none && first_[a] == derive::none; a = tree_.shapes[a].parent)
            first_[a] = own_[id];
    }
    uint32_t of(derive::ShapeId id) const { return own_[id]; }
    /// Of what stands, morphed with a newcomer that has been entered whole: the newcomer's own look where it
    /// has one, else that of the first solid that stands, else that of the newcomer's first.
    uint32_t ofMorph(derive::ShapeId id) const {
        const derive::Shape& s = tree_.shapes[id];
        const uint32_t stands = s.parent == derive::none ? derive::none : first_[s.parent];
        for (const uint32_t material : {s.material, stands, first_[id], own_[id]})
            if (material != derive::none && material != 0) return material;
        return 0;
    }

private:
    const derive::ShapeTree& tree_;
    PageVector<uint32_t> own_;
    PageVector<uint32_t> first_;  ///< material of the first solid below a node, so far
};

}  // namespace sgm::lower
