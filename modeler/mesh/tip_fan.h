// The tip of a cone, a pyramid or a spire as a fan of triangles.
// Enters: the triangles near a tip and the field. Leaves: which of them go and what takes their place. Assumes a mesh
// that doesn't cross itself.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "modeler/core/progress.h"
#include "modeler/eval/evaluate.h"
#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

/// The point nearest to tangent planes, by least squares.
class TangentPlanes {
public:
    void add(Vec3d normal, Vec3d point) {
        const double d = dot(normal, point);
        rows_[0] += normal * normal.x, rows_[1] += normal * normal.y, rows_[2] += normal * normal.z;
        right_ += normal * d;
        squares_ += d * d;
        ++count_;
    }
    struct Intersection {
        Vec3d point;
        double error;  ///< root mean square of its distances from the planes
    };
    /// Nothing where the planes are almost parallel to a line. O(1).
    std::optional<Intersection> meeting() const;

private:
    std::array<Vec3d, 3> rows_{};  ///< Σ n nᵀ
    Vec3d right_{};                ///< Σ n (n·p)
    double squares_ = 0;
    size_t count_ = 0;
};

/// A triangle of a mesh whose vertices are counted in the whole of it.
struct TipTriangle {
    Triangle corners;
    std::array<Vec3f, 3> normals;  ///< of the corners, unit
    uint32_t number;               ///< counted in the whole mesh
    OriginId origin;
    Label label;
    uint8_t ownNormals;  ///< a bit for each corner that has a normal of its own, as at creases
};

/// Numbers below a bound, few of which are in the set at a time: each in O(1), and so is leaving all out.
class MarkedNumbers {
public:
    /// Empties it; numbers are less than `end`.
    void clear(size_t end) {
        if (marks_.size() < end) marks_.resize(end, 0);
        if (++mark_ == 0) std::fill(marks_.begin(), marks_.end(), 0), mark_ = 1;
    }
    /// Whether it was not there.
    bool insert(uint32_t number) { return std::exchange(marks_[number], mark_) != mark_; }
    bool contains(uint32_t number) const { return marks_[number] == mark_; }

private:
    std::vector<uint32_t> marks_;
    uint32_t mark_ = 0;
};

/// What fans are made with, one after the other.
struct TipScratch {
    eval::Workspace workspace;
    MarkedNumbers vertices, triangles;
};

/// A mesh and its field.
struct TipSurface {
    std::span<const Vec3f> positions;     ///< metres
    const std::vector<bool>& isConfined;  ///< by vertex: lies off the planes of its triangles
    std::span<const TipTriangle> triangles;
    std::span<const uint32_t> around;       ///< triangles by vertex, one vertex's after another's
    std::span<const uint32_t> firstAround;  ///< by vertex: its first in `around`; at last the end
    const eval::Tape& field;
    TipScratch& scratch;
    double cell_m;
};

/// Triangles from the border of what is cut off to an apex.
struct TipFan {
    uint32_t top;                   ///< a vertex that is cut off: the apex takes its place
    Vec3f apex;                     ///< metres
    std::vector<uint32_t> removed;  ///< triangles, as TipSurface::triangles counts them, ascending
    std::vector<TipTriangle>
        triangles;       ///< as the removed ones on the same pieces beside the border, whose `number` they have
    double error_m = 0;  ///< the field on these triangles, at most
};

/// The field at points.
std::vector<float> valuesAt(const TipSurface& surface, std::span<const Vec3f> points);

/// False where fanAt finds nothing since the surface around `vertex` comes too near to `apex`. Of the surface's
/// triangles those within `nearestCut` of the way suffice.
bool mayBeTip(const TipSurface& surface, uint32_t vertex, Vec3d apex);

/// Cuts off the surface around `vertex` below `apex`, as near to the apex as triangles lie on the surface, else as they
/// come near it, and fans the border to the apex, which the planes of what was cut off tell exactly. Nothing where they
/// don't agree or the field says otherwise, and where what is cut off isn't one disk. O(n) in the triangles that are
/// cut off.
std::optional<TipFan> fanAt(const TipSurface& surface, uint32_t vertex, Vec3d apex);

/// Drops fans that cross triangles which stay, or may cross a fan before. O(n log n) in the triangles.
void dropCrossing(const TipSurface& surface, std::vector<TipFan>& fans, const Progress* progress);

/// Of the depth of the highest vertex below the apex: how far below it the surface is cut off, at first and at most.
inline constexpr double nearestCut = 1.5, farthestCut = 6;
/// Of a cell: how far a first guess of an apex may be from the surface and from the planes around it.
inline constexpr double apexSlack = 0.3;
}  // namespace sgm::mesh
