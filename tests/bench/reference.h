// Hand-written fields of the scenes, in compiled loops of the widest vectors: what a user without a modeler would
// write. Enters: a shape tree of cubes, spheres, morphs of both, and roofs, joined by sums and cut by differences, or
// of one kaleidoscopic fractal. Leaves: a flat list of parts, each a solid less its cuts. Assumes no blends,
// displacements or turned solids: a tree that holds anything else has no reference.
#pragma once

#include <optional>
#include <vector>

#include "grammar/derive/derive.h"
#include "modeler/eval/evaluate.h"

namespace sgm::bench {

/// A solid in place, metres.
struct Primitive {
    enum class Kind { Box, Ball, Morph, Roof };
    Kind kind = Kind::Box;
    Vec3f centre, half;
    float amount = 0;  ///< Morph: 0 is the ball, 1 the box; Roof: 0 the pyramid, 1 the dome
};

/// A kaleidoscopic fractal in its box (modeler/field/kifs.h), in the continuous form and without a bailout.
struct Fractal {
    Primitive box;
    int passes = 0;
    bool cubes = false;   ///< the last copies are cubes, else balls
    bool turned = false;  ///< `fold` is no identity
    float scale = 3;
    Vec3f scaleCentre;
    float fold[9] = {};  ///< rotation after the folds, by columns
};

/// The union of parts; part k is primitives[first[k]] less those up to first[k + 1]. Where `morphTo` is a part, the
/// morph of the union of those before it and that of the rest. With a fractal, that alone.
struct Reference {
    std::vector<Primitive> primitives;
    std::vector<size_t> first;
    size_t morphTo = 0;  ///< 0: no morph
    float amount = 0;    ///< of the morph
    std::optional<Fractal> fractal;
};

/// The reference of a tree, if it has one. Whether it is the same field as the tape is for `agrees` to say.
std::optional<Reference> referenceOf(const derive::ShapeTree& tree);
/// out[i] = f(x[i], y[i], z[i]), every primitive at every point.
void evaluate(const Reference& reference, eval::Points points, float* out);
/// True when reference and tape give the same distances, up to rounding, at points spread over `box`.
bool agrees(const Reference& reference, const eval::Tape& tape, const Box3f& box);

}  // namespace sgm::bench
