// The rule operations of the language: one file a family (scope, placement, look, whole, clad, footprint, tag, split,
// turtle, copies, faces, network, lots), one row an operation. Enters: nothing. Leaves: the table that the parser,
// checker and derivation read, and the reference page prints. Assumes a new operation is defined in a file of its own
// and named in the list below.
#pragma once

#include "grammar/syntax/operations.h"

// clang-format off
/// Every operation, in the order of the reference page.
#define SGM_OPERATIONS(X) \
    X(size) X(move) X(turn) X(from) X(at) X(to) X(overlap) X(shift) X(on) X(by) X(blend) X(through) X(displace) \
    X(of) X(color) X(rough) X(metal) X(texture) X(normals) X(lay) X(fitted) X(walk) X(report) X(with) \
    X(footprint) X(extrude) X(offset) \
    X(setback) X(court) X(rectify) X(inner) X(tag) X(split) X(snap) X(turtle) X(row) X(around) X(faces) X(network) \
    X(lots) X(place) X(variety) X(clad) X(thickness) X(tile) X(mirror)
// clang-format on

namespace sgm::operations {

#define SGM_DECLARE(name) extern const syntax::Operation name;
SGM_OPERATIONS(SGM_DECLARE)
#undef SGM_DECLARE
/// `mirror x { … }`, which shares its name with a part of `clad`.
extern const syntax::Operation mirrored;

/// The operations of the language.
const syntax::OperationTable& table();

}  // namespace sgm::operations
