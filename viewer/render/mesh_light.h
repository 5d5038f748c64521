// Maps of what hides the sun and the sky from a mesh: of all of it, and finer ones of the sun for what a picture shows.
// Enters: bounds, what draws the triangles, places that are seen. Leaves: maps and the uniforms of the shader part
// `visibility`. Assumes a current GL 4.3 context.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "modeler/core/result.h"
#include "viewer/render/gpu.h"

namespace sgm::render {

/// A box along a light's axes, metres.
struct LightBox {
    std::array<Vec3d, 3> axes;  ///< unit: to the right, up and away from the light, as seen from it
    Box3d box;

    /// An empty box for a light in that direction.
    explicit LightBox(Vec3d towardsLight);
    /// Takes in a place.
    void add(Vec3d place);
    /// Maps the box to lo … hi in all three.
    Matrix4 matrix(double lo, double hi) const;
};

/// The maps of a mesh. Those of all of it serve any view; others the places that one view shows.
class MeshLight {
public:
    /// Draws all triangles with a program.
    using Draw = std::function<Status(const Program&)>;
    /// The shaders that make maps.
    struct Programs {
        const Program &depth, &blur;
    };

    /// No maps are drawn yet. `skyCount` directions sample the sky.
    MeshLight(const Box3f& bounds, size_t skyCount);
    size_t skyCount() const { return skyCount_; }
    /// Draws the next map of all of the mesh: first the sun's, then those of the sky, which count once all are there.
    /// True when none is left.
    Result<bool> drawNext(Programs programs, const Draw& draw);
    /// Draws finer maps of the sun for places that are seen from an eye, instead of those of the last view: one of all
    /// places and one of the nearer ones, where these take little enough of the mesh. Without places there is none.
    Status fit(std::span<const Vec3f> seen, Vec3d eye, Programs programs, const Draw& draw);
    /// Sets what the shaders ask; without `sky` all of it is open. The maps become the textures of units 1 and 2.
    void bind(const Program& program, bool sky) const;

private:
    struct SunMap {
        Matrix4 fromWorld;
        double span_m;  ///< across
    };

    Status drawSun(const LightBox& from, Programs programs, const Draw& draw);
    Status drawSky(size_t i, Programs programs, const Draw& draw) const;
    Status fitSun(std::span<const Vec3f> seen, Programs programs, const Draw& draw);
    LightBox wholeBox(Vec3d towardsLight) const;

    Box3f bounds_;
    size_t skyCount_, drawn_ = 0;
    MapStack sun_, sky_, skyDepth_;
    std::vector<SunMap> sunMaps_;  ///< by layer: of all of the mesh, then of the last view, wide to narrow
    Buffer skyMatrices_;
};

/// How many directions sample the sky: `most` at most, fewer where drawing the mesh from them takes longer.
struct SkyBudget {
    size_t most;
    double seconds;
};

/// As many directions of the sky as the driver draws so many triangles from within a budget.
size_t skyMapsFor(size_t triangles, SkyBudget budget);

/// The least number of directions.
inline constexpr size_t leastSkyMaps = 12;

}  // namespace sgm::render
