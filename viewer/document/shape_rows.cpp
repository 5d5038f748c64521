#include "viewer/document/shape_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "grammar/syntax/printer.h"

namespace sgm::document {
namespace {

using derive::none;
using derive::ShapeId;
using derive::ShapeTree;

bool contains(std::string_view text, std::string_view wanted) {
    const auto alike = [](char a, char b) {
        return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
    };
    return std::search(text.begin(), text.end(), wanted.begin(), wanted.end(), alike) != text.end();
}

/// Which shapes a filter matches; labels and rules are few, shapes many, so each text is looked at once.
class Matches {
public:
    Matches(const derive::Derivation& d, const ShapeFilter& filter) : d_(d), filter_(filter) {
        for (const std::string& label : d.tree.labels) label_.push_back(contains(label, filter.text));
        for (const rules::Rule& rule : d.grammar->rules) rule_.push_back(contains(rule.name, filter.text));
    }
    bool operator()(ShapeId id) const {
        const derive::Shape& s = d_.tree.shapes[id];
        if (filter_.liveOnly && !s.live) return false;
        return label_[s.label] || (s.madeBy != none && rule_[d_.steps[s.madeBy].rule]);
    }

private:
    const derive::Derivation& d_;
    const ShapeFilter& filter_;
    std::vector<bool> label_, rule_;
};

}  // namespace

std::vector<ShapeRow> shapeRows(const derive::Derivation& derivation, const ShapeFilter& filter, const Folded& folded) {
    const ShapeTree& tree = derivation.tree;
    std::vector<ShapeRow> rows;
    if (tree.shapes.empty()) return rows;
    const bool filters = !filter.text.empty() || filter.liveOnly;
    const Matches matches(derivation, filter);
    std::vector<bool> holds(tree.shapes.size(), !filters);  // itself or something below it matches
    if (filters)
        for (ShapeId id = 0; id != none; id = tree.next(id))
            if (matches(id))
                for (ShapeId above = id; above != none && !holds[above]; above = tree.shapes[above].parent)
                    holds[above] = true;
    for (ShapeId id = 0; id != none;) {
        const derive::Shape& s = tree.shapes[id];
        const bool open = filters || !folded.contains(s.key);
        if (holds[id]) rows.push_back({id, s.depth, s.firstChild != none, open, !filters || matches(id)});
        id = tree.next(id, 0, !holds[id] || !open);
    }
    return rows;
}

void reveal(const ShapeTree& tree, ShapeId shape, Folded& folded) {
    for (ShapeId above = tree.shapes[shape].parent; above != none; above = tree.shapes[above].parent)
        folded.erase(tree.shapes[above].key);
}

bool isTerminal(const derive::Derivation& derivation, ShapeId shape) {
    const derive::Shape& s = derivation.tree.shapes[shape];
    return s.symbol == rules::none ? s.solid != none : derivation.grammar->symbols[s.symbol].terminal;
}

ShapeLabel labelOf(const derive::Derivation& derivation, ShapeId shape) {
    const derive::Shape& s = derivation.tree.shapes[shape];
    ShapeLabel label;
    label.name = derivation.tree.labels[s.label];
    if (s.occurrence > 1) label.name += fmt::format("[{}]", s.occurrence);
    label.sign = syntax::sign(s.op);
    label.terminal = isTerminal(derivation, shape);
    label.live = s.live;
    if (s.madeBy == none) {
        label.rule = "start";
    } else {
        const derive::Step& step = derivation.steps[s.madeBy];
        label.rule = derivation.grammar->rules[step.rule].name;
        if (step.chainIndex) label.rule += fmt::format(" step {}", step.chainIndex);
        if (step.closing) label.rule += " finally";
    }
    return label;
}

std::string closedJoints(const derive::Derivation& derivation, ShapeId shape) {
    constexpr size_t most = 8;
    const derive::Bonds& bonds = derivation.tree.bonds();
    std::string lines;
    for (uint32_t j = 0, told = 0; j < derivation.tree.jointCount(shape) && told < most; ++j) {
        if (!bonds.closed(shape, j)) continue;
        const std::string line = derive::closedBy(derivation, derive::Closed{{}, 1, shape, {j}});
        if (line.empty()) continue;
        lines += (told++ > 0 ? "\n" : "") + line;
    }
    return lines;
}

std::vector<JointMark> jointMarks(const ShapeTree& tree, ShapeId shape) {
    std::vector<JointMark> marks;
    const derive::Bonds& bonds = tree.bonds();
    for (uint32_t j = 0; j < tree.jointCount(shape); ++j) {
        const derive::Joint joint = tree.joint(shape, j);
        const uint32_t bond = bonds.at(shape, j);
        const bool bonded = bond != none;
        const bool pointless = joint.direction == Vec3d{};
        marks.push_back({shape, j, joint.name, joint.point, joint.direction,
                         bonded ? !bonds.all[bond].directed : pointless, bonded});
    }
    return marks;
}

std::vector<BondMark> bondMarks(const ShapeTree& tree, size_t most) {
    std::vector<BondMark> marks;
    for (const derive::Bond& bond : tree.bonds().all) {
        if (marks.size() == most) break;
        const Vec3d at = tree.joint(bond.shape[0], bond.joint[0]).point + bond.shift;
        marks.push_back({{bond.shape[0], bond.shape[1]},
                         tree.shapes[bond.shape[0]].scope.centre,
                         tree.shapes[bond.shape[1]].scope.centre,
                         at,
                         !bond.directed});
    }
    return marks;
}

}  // namespace sgm::document
