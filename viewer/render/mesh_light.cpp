#include "viewer/render/mesh_light.h"

#include <algorithm>
#include <cmath>

#include "viewer/render/scene.h"

namespace sgm::render {
namespace {

constexpr int sunMapEdge = 2048, skyMapEdge = 256, mostSunMaps = 3;
constexpr double widestPenumbra = 0.012;  ///< of the mesh's diagonal: how far away the sun's shadow is looked for
constexpr double worthwhile = 0.7;        ///< a map of at most this share of another's side is worth drawing
constexpr double subjectShare = 0.25;     ///< of the places seen: nearer ones tell how far away a view's subject is
constexpr double subjectDepth = 2;        ///< how much farther than these the map of the nearer places reaches

/// Metres across a map that takes in all of the object from any side.
double mapSpan(const Box3f& bounds) { return 1.02 * length(bounds.size().as<double>()); }

/// Directions spread evenly over the sphere (Fibonacci's lattice).
Vec3d skyDirection(size_t i, size_t count) {
    const double y = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(count), r = std::sqrt(1 - y * y);
    const double angle = static_cast<double>(i) * 2.39996322972865332;
    return {r * std::cos(angle), y, r * std::sin(angle)};
}

double side(const LightBox& from) { return std::max(from.box.size().x, from.box.size().y); }

/// As wide as high, and wider by a margin on all sides.
LightBox squared(LightBox from, double margin_m) {
    const Vec3d middle = from.box.centre();
    const double half = side(from) / 2 + margin_m;
    for (int k = 0; k < 2; ++k) from.box.lo[k] = middle[k] - half, from.box.hi[k] = middle[k] + half;
    return from;
}

}  // namespace

LightBox::LightBox(Vec3d towardsLight) {
    const Vec3d right =
        normalized(cross(std::abs(towardsLight.y) > 0.99 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0}, towardsLight));
    axes = {right, cross(towardsLight, right), -towardsLight};
}

void LightBox::add(Vec3d place) {
    const Vec3d at{dot(axes[0], place), dot(axes[1], place), dot(axes[2], place)};
    box = hull(box, at);
}

Matrix4 LightBox::matrix(double lo, double hi) const {
    Matrix4 matrix{};
    for (int r = 0; r < 3; ++r) {
        const double scale = (hi - lo) / (box.hi[r] - box.lo[r]);
        const Vec3d axis = axes[static_cast<size_t>(r)] * scale;
        for (int c = 0; c < 3; ++c) matrix[static_cast<size_t>(c * 4 + r)] = static_cast<float>(axis[c]);
        matrix[static_cast<size_t>(12 + r)] = static_cast<float>(lo - scale * box.lo[r]);
    }
    matrix[15] = 1;
    return matrix;
}

size_t skyMapsFor(size_t triangles, SkyBudget budget) {
    // Software draws some 3 million triangles a second (docs/lab/pictures.md).
    const double drawn = budget.seconds * (softwareGl() ? 2.6e6 : 25e6);
    const auto count = static_cast<size_t>(drawn / static_cast<double>(std::max<size_t>(triangles, 1)));
    return std::clamp(count, leastSkyMaps, budget.most);
}

MeshLight::MeshLight(const Box3f& bounds, size_t skyCount) : bounds_(bounds), skyCount_(skyCount) {
    sun_ = MapStack::create(MapStack::Kind::Depth, sunMapEdge, mostSunMaps);
    sky_ = MapStack::create(MapStack::Kind::Number, skyMapEdge, static_cast<int>(skyCount_));
    skyDepth_ = MapStack::create(MapStack::Kind::Depth, skyMapEdge, 1);
    std::vector<Matrix4> matrices;
    for (size_t i = 0; i < skyCount_; ++i) matrices.push_back(wholeBox(skyDirection(i, skyCount_)).matrix(0, 1));
    skyMatrices_ = Buffer::of<Matrix4>(matrices);
}

/// All of the mesh, as large from any side.
LightBox MeshLight::wholeBox(Vec3d towardsLight) const {
    LightBox from(towardsLight);
    from.add(bounds_.centre().as<double>());
    from.box = from.box.inflated(mapSpan(bounds_) / 2);
    return from;
}

Status MeshLight::drawSun(const LightBox& from, Programs programs, const Draw& draw) {
    setDepthTest(true);
    sun_.bindCleared(static_cast<int>(sunMaps_.size()));
    programs.depth.set("clipFromWorld", from.matrix(-1, 1));
    sunMaps_.push_back({from.matrix(0, 1), side(from)});
    return draw(programs.depth);
}

Status MeshLight::drawSky(size_t i, Programs programs, const Draw& draw) const {
    setDepthTest(true);
    skyDepth_.bindCleared(0);
    programs.depth.set("clipFromWorld", wholeBox(skyDirection(i, skyCount_)).matrix(-1, 1));
    if (Status s = draw(programs.depth); !s) return s;
    setDepthTest(false);
    sky_.bindCleared(static_cast<int>(i));
    skyDepth_.bindTexture(0);
    programs.blur.use();
    ScreenTriangle().draw();
    return Done{};
}

Result<bool> MeshLight::drawNext(Programs programs, const Draw& draw) {
    if (drawn_ > skyCount_) return true;
    const Status done = drawn_ == 0 ? drawSun(wholeBox(sunDirection().as<double>()), programs, draw)
                                    : drawSky(drawn_ - 1, programs, draw);
    if (!done) return done.error();
    return ++drawn_ > skyCount_;
}

Status MeshLight::fitSun(std::span<const Vec3f> seen, Programs programs, const Draw& draw) {
    const LightBox whole = wholeBox(sunDirection().as<double>());
    LightBox from(sunDirection().as<double>());
    for (const Vec3f p : seen) from.add(p.as<double>());
    from.box.lo.z = whole.box.lo.z, from.box.hi.z = whole.box.hi.z;  // all that casts a shadow there
    from = squared(from, 1.5 * widestPenumbra * mapSpan(bounds_));
    if (side(from) > worthwhile * sunMaps_.back().span_m) return Done{};
    return drawSun(from, programs, draw);
}

Status MeshLight::fit(std::span<const Vec3f> seen, Vec3d eye, Programs programs, const Draw& draw) {
    if (sunMaps_.empty()) return Done{};
    sunMaps_.resize(1);
    if (seen.empty()) return Done{};
    const auto away = [&](Vec3f p) { return length(p.as<double>() - eye); };
    std::vector<Vec3f> places(seen.begin(), seen.end());
    std::sort(places.begin(), places.end(), [&](Vec3f a, Vec3f b) { return away(a) < away(b); });
    const auto subject = static_cast<size_t>(subjectShare * static_cast<double>(places.size() - 1));
    const double reach_m = subjectDepth * away(places[subject]);
    const auto end = std::upper_bound(places.begin(), places.end(), reach_m,
                                      [&](double distance_m, Vec3f p) { return distance_m < away(p); });
    if (Status s = fitSun(places, programs, draw); !s) return s;
    return fitSun({places.begin(), end}, programs, draw);
}

void MeshLight::bind(const Program& program, bool sky) const {
    const double span = mapSpan(bounds_);
    program.set("sunMaps", 1);
    program.set("skyMaps", 2);
    program.set("mapSpan", static_cast<float>(span));
    program.set("widestPenumbra", static_cast<float>(widestPenumbra * span));
    program.set("sunCount", static_cast<int>(sunMaps_.size()));
    for (size_t i = 0; i < sunMaps_.size(); ++i) {
        const SunMap& map = sunMaps_[sunMaps_.size() - 1 - i];  // narrow ones are asked first
        const std::string place = "[" + std::to_string(i) + "]";
        program.set(("sunFromWorld" + place).c_str(), map.fromWorld);
        program.set(("sunSpan" + place).c_str(), static_cast<float>(map.span_m));
    }
    program.set("skyCount", sky && drawn_ > skyCount_ ? static_cast<int>(skyCount_) : 0);
    sun_.bindTexture(1);
    sky_.bindTexture(2);
    skyMatrices_.bindStorage(6);
}

}  // namespace sgm::render
