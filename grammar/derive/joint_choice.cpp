#include "grammar/derive/joint_choice.h"

#include <algorithm>

namespace sgm::derive {
namespace {

/// The joint of a face that a value names; what `with` sets may be anything.
uint32_t faceNamed(TreeBuilder& builder, const rules::Value& value, syntax::SourceSpan span) {
    if (value.kind == rules::Value::Kind::Axis) return static_cast<uint32_t>(value.num());
    builder.monitor().fail(Error::Kind::Input,
                           "'" + std::string(span.text()) + "' is " + rules::toText(value) +
                               " here, and a joint is a direction, as +x, or a joint's name",
                           span);
    return none;
}

uint32_t jointNamed(TreeBuilder& builder, const rules::Expr& expr, ShapeId host, const Place& place) {
    const rules::Value v = evaluate(expr, place);
    if (v.kind != rules::Value::Kind::Word) return faceNamed(builder, v, expr.span);
    const uint32_t joint = builder.tree().findJoint(host, v.text);
    if (joint == none)
        builder.monitor().fail(
            Error::Kind::Input,
            "'" + builder.tree().labels[builder.tree().shapes[host].label] + "' has no joint '" + v.text + "'",
            expr.span);
    return joint;
}

}  // namespace

std::vector<uint32_t> openJoints(TreeBuilder& builder, const rules::JointChoice& at, ShapeId host, const Place& place,
                                 std::vector<uint32_t>& closed) {
    std::vector<uint32_t> joints;
    const ShapeTree& tree = builder.tree();
    for (const rules::Expr& e : at.joints)
        if (const uint32_t j = jointNamed(builder, e, host, place); j != none) joints.push_back(j);
    if (at.free && at.joints.empty())
        for (uint32_t j = 0; j < tree.jointCount(host); ++j)
            if (tree.joint(host, j).direction != Vec3d{}) joints.push_back(j);
    Recording* const recording = builder.recording();
    const std::vector<uint32_t> asked = recording ? joints : std::vector<uint32_t>();
    const auto taken = [&](uint32_t j) {
        return at.free ? builder.bonds().isBonded(host, j) : builder.bonds().isClosed(host, j);
    };
    const auto open = std::stable_partition(joints.begin(), joints.end(), [&](uint32_t j) { return !taken(j); });
    if (open == joints.begin()) closed = joints;
    joints.erase(open, joints.end());
    if (recording && !recording->answer(asked, joints)) builder.monitor().diverge();
    return joints;
}

rules::Joint jointShares(const ShapeTree& tree, uint32_t joint, uint32_t jointSet) {
    if (joint >= firstNamedJoint) return tree.namedJoints[jointSet][joint - firstNamedJoint];
    return {std::string(faceName(joint)), faceDirection(joint), faceDirection(joint)};
}

uint32_t theirJoint(TreeBuilder& builder, const rules::Element& e, uint32_t jointSet, const Joint& ours,
                    const Mat3& axes, const Place& place) {
    if (!e.to) return ours.direction == Vec3d{} ? centreJoint : opposedFace(axes, ours.direction);
    const rules::Value v = evaluate(e.to->joints[0], place);
    if (v.kind != rules::Value::Kind::Word) return faceNamed(builder, v, e.to->joints[0].span);
    const auto& named = builder.tree().namedJoints[jointSet];
    for (uint32_t i = 0; i < named.size(); ++i)
        if (named[i].name == v.text) return firstNamedJoint + i;
    builder.monitor().fail(Error::Kind::Input, "the newcomer has no joint '" + v.text + "'", e.to->span);
    return none;
}

}  // namespace sgm::derive
