// What stands around a shape: volumes of other shapes by name, for `overlaps`, `touches`, `inside` and `covered`.
// Enters: a tree. Leaves: answers about the state it was built from. Assumes no shape is removed while it is asked.
// Volumes are blocks over footprints where shapes have one and stand upright, else their boxes. A shape is never
// compared with those it stands in or that stand in it.
#pragma once

#include <unordered_map>
#include <vector>

#include "grammar/derive/shape_tree.h"
#include "modeler/core/vec.h"

namespace sgm::derive {

class Surroundings {
public:
    /// Takes note of every shape that lives now. O(shapes).
    explicit Surroundings(const ShapeTree& tree);

    /// Whether another shape of that symbol shares volume with this one, by more than a tenth of a millimetre.
    bool overlaps(const ShapeTree& tree, ShapeId shape, rules::SymbolId symbol) const;
    /// Whether one shares volume with it or meets it within a millimetre.
    bool touches(const ShapeTree& tree, ShapeId shape, rules::SymbolId symbol) const;
    /// Whether one holds it whole.
    bool inside(const ShapeTree& tree, ShapeId shape, rules::SymbolId symbol) const;
    /// The share of the shape's outer face (+z), 0 … 1, by 5 × 5 points of it, at which the solid of another shape
    /// stands.
    double covered(const ShapeTree& tree, ShapeId shape) const;

    /// The same share of the outer face of `part`, a part of the shape's volume, at which the volume of a shape stands
    /// that lives or is solid.
    double shared(const ShapeTree& tree, ShapeId shape, const Scope& part) const;

    /// Shapes of that symbol, oldest first.
    std::vector<ShapeId> shapesOf(rules::SymbolId symbol) const;

private:
    struct Entry {
        Box3d box;
        ShapeId shape;
    };
    /// Shapes in the order of their least x, and the widest of them: a search looks that far back.
    struct List {
        std::vector<Entry> entries;
        double widest_m = 0;
    };
    template <class F>
    static void forNear(const List& list, const Box3d& box, F f);
    static void add(List& list, const Scope& scope, ShapeId shape);
    static void sort(List& list);

    std::unordered_map<rules::SymbolId, List> bySymbol_;
    double shareOf(const ShapeTree& tree, ShapeId shape, const Scope& own, const List& list) const;

    List solids_, standing_;
};

}  // namespace sgm::derive
