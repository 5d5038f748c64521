// The Shapes panel and what is drawn over the view: the derived tree as rows, joints and bonds in space (figure 11).
// Enters: a derivation. Leaves: light rows (a tree may have hundreds of thousands) and, for those that are seen,
// labels. Assumes that rows are made anew for another derivation.
#pragma once

#include <string>
#include <unordered_set>
#include <vector>

#include "grammar/derive/derive.h"

namespace sgm::document {

struct ShapeRow {
    derive::ShapeId shape = 0;
    uint32_t depth = 0;
    bool hasChildren = false;
    bool open = true;     ///< its children have rows
    bool matches = true;  ///< false: shown only because something below it matches the filter
};

struct ShapeFilter {
    std::string text;  ///< part of a label or of the rule that made it, capitals alike; "" for all
    bool liveOnly = false;
    friend bool operator==(const ShapeFilter&, const ShapeFilter&) = default;
};
/// Folded shapes by Shape::key, which survives another derivation.
using Folded = std::unordered_set<uint64_t>;

/// Rows in tree order: what matches, with all above it. A filter opens what is folded.
std::vector<ShapeRow> shapeRows(const derive::Derivation& derivation, const ShapeFilter& filter, const Folded& folded);
/// Unfolds all above a shape, so that it has a row.
void reveal(const derive::ShapeTree& tree, derive::ShapeId shape, Folded& folded);

/// What a row says.
struct ShapeLabel {
    std::string name;       ///< "Storey[3]"
    std::string rule;       ///< that made it, "Up step 2"; "start"
    std::string_view sign;  ///< "+", "-", "&", "morph", "" for content
    bool terminal = false;  ///< red as in figure 1; non-terminals are blue
    bool live = false;      ///< rules may still rewrite it
};
ShapeLabel labelOf(const derive::Derivation& derivation, derive::ShapeId shape);
/// True for V_T: a terminal symbol or a plain solid.
bool isTerminal(const derive::Derivation& derivation, derive::ShapeId shape);

/// Which shapes closed the joints of a shape, a line each as derive::closedBy says it; the first eight. O(joints).
std::string closedJoints(const derive::Derivation& derivation, derive::ShapeId shape);

/// A joint as figure 11 draws it.
struct JointMark {
    derive::ShapeId shape = 0;
    uint32_t joint = 0;
    std::string_view name;   ///< "+x" …
    Vec3d point, direction;  ///< metres, object frame; direction is zero for the centre
    bool toCentre = false;   ///< red: it joins to a centre, or is one; else green, face to face
    bool bonded = false;     ///< filled
};
/// The joints of a shape: six faces, the centre, those declared.
std::vector<JointMark> jointMarks(const derive::ShapeTree& tree, derive::ShapeId shape);

struct BondMark {
    derive::ShapeId shapes[2];
    Vec3d from, to;         ///< the centres of the two shapes
    Vec3d at;               ///< where they are mated
    bool toCentre = false;  ///< red; else green
};
/// Every bond of the tree, at most `most` of them.
std::vector<BondMark> bondMarks(const derive::ShapeTree& tree, size_t most = 100'000);

}  // namespace sgm::document
