// The order of a solid's arguments.
// Enters: a written solid and its row. Leaves: errors with what to write. For solids.cpp alone.
#pragma once

#include "grammar/rules/check_context.h"
#include "modeler/field/primitives.h"

namespace sgm::rules {

/// Two arguments without names, an angle where a length belongs and the other way round: an error of both.
bool refuseExchanged(CheckContext& ctx, const syntax::Expr& e, const field::Primitive& row);
/// An argument without a name behind one with, where its place is taken or is of another unit: an error.
bool refuseUnnamedBehindNamed(CheckContext& ctx, const syntax::Expr& e, const field::Primitive& row);

}  // namespace sgm::rules
