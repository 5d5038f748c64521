#include "grammar/derive/shape_tree.h"

#include <algorithm>
#include <charconv>

#include "grammar/derive/bond_maker.h"
#include "grammar/derive/path_text.h"

namespace sgm::derive {

Vec3d faceDirection(uint32_t joint) {
    Vec3d d;
    if (joint < faceCount) d[static_cast<int>(joint / 2)] = joint % 2 ? -1 : 1;
    return d;
}

std::string_view faceName(uint32_t joint) {
    constexpr std::string_view names[] = {"+x", "-x", "+y", "-y", "+z", "-z", "centre"};
    return names[joint];
}

uint32_t ShapeTree::jointCount(ShapeId id) const {
    return firstNamedJoint + static_cast<uint32_t>(namedJoints[shapes[id].jointSet].size());
}

Joint ShapeTree::joint(ShapeId id, uint32_t index) const {
    const ShapeRecord& s = shapes.record(id);
    const Mat3& axes = shapes.axesOf(id);
    const auto placed = [&](std::string_view name, Vec3d at, Vec3d facing) {
        return Joint{name, s.centre + axes * (at * (s.size * 0.5)), axes * facing};
    };
    if (index < firstNamedJoint) {
        const Vec3d d = faceDirection(index);
        return placed(faceName(index), d, d);
    }
    const rules::Joint& named = namedJoints[shapes[id].jointSet][index - firstNamedJoint];
    return placed(named.name, named.at, named.facing);
}

uint32_t ShapeTree::findJoint(ShapeId id, std::string_view name) const {
    for (uint32_t j = 0; j < firstNamedJoint; ++j)
        if (faceName(j) == name) return j;
    const auto& named = namedJoints[shapes[id].jointSet];
    for (uint32_t i = 0; i < named.size(); ++i)
        if (named[i].name == name) return firstNamedJoint + i;
    return none;
}

const Bonds& ShapeTree::bonds() const {
    return bondsOnDemand.get([&] { return bondsOf(*this); });
}

ShapeId ShapeTree::next(ShapeId id, ShapeId root, bool over) const {
    if (!over && shapes[id].firstChild != none) return shapes[id].firstChild;
    for (; id != root; id = shapes[id].parent)
        if (shapes[id].nextSibling != none) return shapes[id].nextSibling;
    return none;
}

namespace {

/// Counted on the fly while the tree still grows.
uint32_t occurrenceOf(const ShapeTree& tree, ShapeId id) {
    const Shape s = tree.shapes[id];
    if (s.occurrence || s.parent == none) return s.occurrence;
    uint32_t n = 1;
    for (ShapeId c = tree.shapes[s.parent].firstChild; c != none && c != id; c = tree.shapes[c].nextSibling)
        n += tree.shapes[c].label == s.label;
    return n;
}

}  // namespace

std::string ShapeTree::path(ShapeId id, bool whole) const {
    std::vector<ShapeId> up;
    for (ShapeId s = id; s != none; s = shapes[s].parent) up.push_back(s);
    return pathText(up, whole ? up.size() : shownPathParts, [this](ShapeId s) {
        return PathPart{labels[shapes[s].label], occurrenceOf(*this, s)};
    });
}

namespace {

PathPart readPart(std::string_view text) {
    PathPart part{text, 1};
    const size_t open = text.find('[');
    if (open == std::string_view::npos) return part;
    part.label = text.substr(0, open);
    std::from_chars(text.data() + open + 1, text.data() + text.size(), part.occurrence);
    return part;
}

ShapeId findBelow(const ShapeTree& tree, ShapeId under, const PathPart& part) {
    uint32_t seen = 0;  // counted along the way: to ask each child would take its siblings squared
    for (ShapeId c = tree.shapes[under].firstChild; c != none; c = tree.shapes[c].nextSibling) {
        const Shape child = tree.shapes[c];
        if (tree.labels[child.label] != part.label) continue;
        ++seen;
        if ((child.occurrence ? child.occurrence : seen) == part.occurrence) return c;
    }
    uint32_t left = part.occurrence;
    for (ShapeId s = tree.next(under, under); s != none; s = tree.next(s, under))
        if (tree.labels[tree.shapes[s].label] == part.label && --left == 0) return s;
    return none;
}

}  // namespace

ShapeId ShapeTree::find(std::string_view path) const {
    ShapeId at = none;
    while (!path.empty()) {
        const size_t cut = std::min(path.find('/'), path.size());
        const PathPart part = readPart(path.substr(0, cut));
        path.remove_prefix(std::min(cut + 1, path.size()));
        if (at == none) {
            if (labels[shapes[0].label] != part.label) return none;
            at = 0;
        } else {
            at = findBelow(*this, at, part);
        }
        if (at == none) return none;
    }
    return at;
}

Scope ShapeTree::contentBox(ShapeId root) const {
    const Scope own = shapes.scopeOf(root);
    const Mat3 localFromWorld = own.axes.transposed();
    Box3d box;
    for (ShapeId s = root; s != none;) {
        const bool cuts = s != root && shapes[s].op == rules::Operator::Difference;
        if (!cuts && shapes[s].solid != none) {
            const Scope scope = shapes.scopeOf(s);
            const Mat3 axes = localFromWorld * scope.axes;
            const Vec3d centre = localFromWorld * (scope.centre - own.centre), h = scope.half();
            Vec3d reach;
            for (int i = 0; i < 3; ++i)
                reach[i] = std::abs(axes.x[i]) * h.x + std::abs(axes.y[i]) * h.y + std::abs(axes.z[i]) * h.z;
            box = hull(box, Box3d{centre - reach, centre + reach});
        }
        s = next(s, root, cuts);
    }
    if (box.empty()) return own;
    return {own.centre + own.axes * box.centre(), own.axes, box.size()};
}

}  // namespace sgm::derive
