// Which joints a newcomer and its host meet at.
// Enters: what `at` and `to` say. Leaves: indices of joints, or a failure of the builder.
#pragma once

#include <vector>

#include "grammar/derive/builder.h"
#include "grammar/derive/expressions.h"

namespace sgm::derive {

/// The host's joints that `at` may take: a named one unless a directed bond closed it; of `free(…)` those nobody met.
/// Where none is open, `closed` has those that it asked for.
std::vector<uint32_t> openJoints(TreeBuilder& builder, const rules::JointChoice& at, ShapeId host, const Place& place,
                                 std::vector<uint32_t>& closed);
/// The newcomer's joint that meets `ours`; `jointSet` holds its named ones. none after a failure.
uint32_t theirJoint(TreeBuilder& builder, const rules::Element& e, uint32_t jointSet, const Joint& ours,
                    const Mat3& axes, const Place& place);
/// A joint in shares of the solid: a face, or one of `jointSet`.
rules::Joint jointShares(const ShapeTree& tree, uint32_t joint, uint32_t jointSet);

}  // namespace sgm::derive
