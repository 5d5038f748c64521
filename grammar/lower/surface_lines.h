// Where a part's own surface is, by lines through its scope.
// Enters: a scope and a field's tape. Leaves: points. Assumes nothing of a mesh.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "grammar/derive/shapes.h"
#include "modeler/core/provenance.h"
#include "modeler/eval/local_tapes.h"

namespace sgm::lower {

/// One worker's.
class SurfaceLines {
public:
    /// How closely a part is looked at.
    struct Density {
        int mostAlong;      ///< lines along an axis
        size_t mostPoints;  ///< of the part's surface
    };
    /// A step on a line at the ends of which the field has other signs.
    struct Bracket {
        Vec3d from, to;   ///< metres
        size_t line = 0;  ///< of those that findOnLines was given
        Vec3d middle() const { return (from + to) * 0.5; }
    };

    struct Line {
        Vec3d from, along;  ///< of length 1
        double size_m = 0;
    };

    /// `bounds` hold the field's surface; cells in metres.
    SurfaceLines(const Box3f& bounds, float cell_m) : bounds_(bounds), cell_m_(static_cast<double>(cell_m)) {}

    /// Finds where lines along the scope's axes, about a cell apart, cross the field's surface and that is the part's
    /// alone. Returns how far apart that is at most, metres. The tape is good for a box around the scope.
    double find(const derive::Scope& scope, OriginId part, const Density& density, const eval::Tape& tape,
                eval::Workspace& workspace);
    /// The same of a box, whose surface lies on the scope's faces: these alone are looked at.
    double findOnFaces(const derive::Scope& scope, OriginId part, const Density& density, const eval::Tape& tape,
                       eval::Workspace& workspace);
    /// Finds where the lines cross the field's surface and that is the part's alone.
    void findOnLines(std::span<const Line> lines, OriginId part, const eval::Tape& tape, eval::Workspace& workspace);
    std::span<const Bracket> found() const { return found_; }

    /// Halves the steps around crossings.
    void halve(std::vector<Bracket>& brackets, const eval::Tape& tape, eval::Workspace& workspace);

private:
    /// A line, and how far along it the field has been followed.
    struct Ray {
        Vec3d from, along;
        double at_m = 0, end_m = 0, leastStep_m = 0;
        std::array<double, 2> faces_m;  ///< where it crosses the scope's faces
        size_t line = 0;
        float value = 0;
        Vec3d place() const { return from + along * at_m; }
    };

    double listLines(const derive::Scope& scope, int mostAlong);
    void addLine(const Line& line, size_t number = 0);
    void followLines(const eval::Tape& tape, eval::Workspace& workspace);
    void probeFaces(const eval::Tape& tape, eval::Workspace& workspace);
    double keepOwn(OriginId part, const eval::Tape& tape, eval::Workspace& workspace, size_t mostPoints);
    void evaluate(const eval::Tape& tape, eval::Workspace& workspace);

    Box3f bounds_;
    double cell_m_;
    std::vector<Ray> rays_;
    std::vector<Bracket> found_;
    eval::PointList points_;
    std::vector<float> values_;
    eval::SurfaceOwners owners_;
};

}  // namespace sgm::lower
