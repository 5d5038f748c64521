#include "modeler/mesh/tip_fan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <unordered_map>

#include "modeler/mesh/box_finder.h"
#include "modeler/mesh/exact_meeting.h"

namespace sgm::mesh {
namespace {

constexpr double leastDeterminant = 1e-4;  ///< of the mean of n nᵀ: below it, tangent planes meet in a line
/// Of the depth of the highest vertex below the apex: where the surface is cut off, as far as needed.
constexpr double cuts[] = {nearestCut, 2, 3, 4, farthestCut};
constexpr int rounds = 6;  ///< to find the apex
// In cells:
constexpr double apexRounding = 1e-3;  ///< what rounding leaves of the apex from planes around it
constexpr double leastDepth = 0.05;    ///< of the highest vertex below the apex
constexpr double surfaceSlack = 0.03;  ///< the field at the apex, and the apex from the planes around it
constexpr double nearSurface = 0.25;   ///< the field on the triangles of the fan

constexpr size_t mostCutOff = 3000;  ///< triangles around vertices

std::array<Vec3f, 3> placesOf(const TipSurface& surface, const TipFan& fan, const TipTriangle& t) {
    std::array<Vec3f, 3> places;
    for (int k = 0; k < 3; ++k)
        places[static_cast<size_t>(k)] = t.corners[k] == fan.top ? fan.apex : surface.positions[t.corners[k]];
    return places;
}

/// Whether triangles of a fan cross one another or those among `near`, triangles of the mesh, that stay.
bool crosses(const TipSurface& surface, const TipFan& fan, std::span<const uint32_t> near) {
    std::vector<Vec3f> positions;
    std::unordered_map<uint32_t, uint32_t> numbers;
    std::vector<Triangle> triangles;
    const auto add = [&](const TipTriangle& t) {
        const std::array<Vec3f, 3> places = placesOf(surface, fan, t);
        Triangle own;
        for (int k = 0; k < 3; ++k) {
            const auto [known, isNew] = numbers.emplace(t.corners[k], static_cast<uint32_t>(positions.size()));
            if (isNew) positions.push_back(places[static_cast<size_t>(k)]);
            own[k] = known->second;
        }
        triangles.push_back(own);
    };
    for (const TipTriangle& t : fan.triangles) add(t);
    for (const uint32_t t : near)
        if (!std::binary_search(fan.removed.begin(), fan.removed.end(), t)) add(surface.triangles[t]);
    for (size_t i = 0; i < fan.triangles.size(); ++i)
        for (size_t j = i + 1; j < triangles.size(); ++j)
            if (!intersection(boxOf(positions, triangles[i]), boxOf(positions, triangles[j])).empty() &&
                meetWrongly(positions, triangles[i], triangles[j]))
                return true;
    return false;
}

/// The direction along which depth below an apex is measured: the way from the middle of what is cut off, the mean of
/// the normals of what is around that as well, or of its own. Along a mean, no point of a convex tip is higher than its
/// apex, also where all known vertices lie on one side of it.
enum class Axis { FromMiddle, MeanAround, MeanNormal };

/// Those that are tried: only a confined vertex may lie far to one side.
std::span<const Axis> axesAt(const TipSurface& surface, uint32_t vertex) {
    static constexpr Axis all[] = {Axis::FromMiddle, Axis::MeanAround, Axis::MeanNormal};
    return std::span(all).first(surface.isConfined[vertex] ? 3 : 2);
}

class FanBuilder {
public:
    FanBuilder(const TipSurface& surface, uint32_t vertex, Vec3d apex, Axis axis)
        : surface_(surface), vertex_(vertex), guess_(apex), axisKind_(axis), cutOff_(surface.scratch.vertices) {}

    /// What is cut off at so many times the depth of the highest vertex; see `fanAt`. Nothing where the field on the
    /// fan isn't near 0, and unless `takesConfined`, where the border goes through a confined vertex.
    std::optional<TipFan> fan(double cut, bool takesConfined) {
        begin();
        double within_m = apexSlack * surface_.cell_m;
        for (int round = 0; round < rounds; ++round) {
            if (isTooNear() || !gather(cut * depthOf(top_))) {
                reachesApex_ = round == 0;
                return {};
            }
            const auto meeting = meetingOf(within_m);
            if (!meeting || meeting->error > within_m) return {};
            apex_ = meeting->point;
            axis_ = axisOf();
            within_m = std::clamp(meeting->error, apexRounding * surface_.cell_m, surfaceSlack * surface_.cell_m);
        }
        if (!isApex()) return {};
        TipFan made{top_, apex_.as<float>(), {}, {}, 0};
        if (!fillFrom(made, takesConfined) || !isOneLoop(made)) return {};
        made.error_m = errorOf(made);
        if (!(made.error_m < nearSurface * surface_.cell_m) || crosses(surface_, made, beside(made))) return {};
        return made;
    }

    /// Whether what is cut off first of all ends below the first guess of the apex.
    bool endsBelowApex() {
        begin();
        return !isTooNear() && gather(nearestCut * depthOf(top_));
    }

    /// Whether the last fan wasn't made for a confined vertex alone: else taking those changes nothing.
    bool lacksConfined() const { return lacksConfined_; }

    /// Whether the last fan wasn't made since what is cut off below the first guess of the apex comes too near to that
    /// or is too large: deeper cuts have it as well.
    bool reachesApex() const { return reachesApex_; }

private:
    void begin() {
        top_ = vertex_, apex_ = guess_, lacksConfined_ = reachesApex_ = false;
        cutOff_.clear(surface_.positions.size()), cutOff_.insert(top_);
        triangles_.assign(around(top_).begin(), around(top_).end());
        axis_ = axisOf();
    }

    Vec3d at(uint32_t vertex) const { return surface_.positions[vertex].as<double>(); }
    double depthOf(uint32_t vertex) const { return dot(apex_ - at(vertex), axis_); }

    bool isTooNear() const { return !(depthOf(top_) > leastDepth * surface_.cell_m); }

    std::span<const uint32_t> around(uint32_t vertex) const {
        const uint32_t first = surface_.firstAround[vertex];
        return surface_.around.subspan(first, surface_.firstAround[vertex + 1] - first);
    }

    /// The vertices that can be reached from the top above some depth, and their triangles; the highest becomes the
    /// top. False where there are too many, or one is too near to the apex.
    bool gather(double end) {
        MarkedNumbers& gathered = surface_.scratch.triangles;
        gathered.clear(surface_.triangles.size());
        cutOff_.clear(surface_.positions.size()), cutOff_.insert(top_);
        triangles_.clear();
        size_t aroundVertices = 0;
        std::vector<uint32_t> pending{top_};
        while (!pending.empty()) {
            const uint32_t v = pending.back();
            pending.pop_back();
            if (depthOf(v) < depthOf(top_)) top_ = v;
            if (isTooNear()) return false;
            for (const uint32_t t : around(v)) {
                ++aroundVertices;
                if (!gathered.insert(t)) continue;
                triangles_.push_back(t);
                for (int k = 0; k < 3; ++k) {
                    const uint32_t other = surface_.triangles[t].corners[k];
                    if (depthOf(other) < end && cutOff_.insert(other)) pending.push_back(other);
                }
            }
            if (aroundVertices > mostCutOff) return false;
        }
        std::sort(triangles_.begin(), triangles_.end());
        return true;
    }

    int countOf(const TipTriangle& t) const {
        int inside = 0;
        for (int k = 0; k < 3; ++k) inside += cutOff_.contains(t.corners[k]);
        return inside;
    }

    /// Calls `visit(vertex, normal)` for all corners that are cut off.
    template <class Visit>
    void visitCorners(Visit&& visit) const {
        for (const uint32_t number : triangles_) {
            const TipTriangle& t = surface_.triangles[number];
            for (int k = 0; k < 3; ++k)
                if (cutOff_.contains(t.corners[k])) visit(t.corners[k], t.normals[static_cast<size_t>(k)]);
        }
    }

    /// The same for all corners of their triangles.
    template <class Visit>
    void visitAround(Visit&& visit) const {
        for (const uint32_t number : triangles_) {
            const TipTriangle& t = surface_.triangles[number];
            for (int k = 0; k < 3; ++k) visit(t.corners[k], t.normals[static_cast<size_t>(k)]);
        }
    }

    /// The direction along which depth is measured, from what is cut off to the apex.
    Vec3d axisOf() const {
        Vec3d middle{}, normal{};
        double count = 0;
        visitCorners([&](uint32_t v, Vec3f n) { middle += at(v), normal += n.as<double>(), ++count; });
        const Vec3d way = apex_ - middle * (1 / count);
        if (axisKind_ == Axis::MeanAround) visitAround([&](uint32_t, Vec3f n) { normal += n.as<double>(); });
        return normalized(axisKind_ == Axis::FromMiddle ? way : dot(normal, way) < 0 ? normal * -1.0 : normal);
    }

    /// Where the planes of what is cut off meet, by MeanAround of what is around that as well; those farther than twice
    /// `within_m` from the apex don't count, half of them at most.
    std::optional<TangentPlanes::Intersection> meetingOf(double within_m) const {
        TangentPlanes planes;
        size_t used = 0, all = 0;
        const auto add = [&](uint32_t v, Vec3f normal) {
            if (v == top_ || surface_.isConfined[v]) return;
            ++all;
            const Vec3d n = normal.as<double>(), point = at(v) - apex_;
            if (std::abs(dot(n, point)) > 2 * within_m) return;
            planes.add(n, point);
            ++used;
        };
        if (axisKind_ == Axis::MeanAround)
            visitAround(add);
        else
            visitCorners(add);
        if (2 * used < all) return {};
        auto meeting = planes.meeting();
        if (meeting) meeting->point += apex_;
        return meeting;
    }

    /// Whether the surface goes through the apex, with solid on one side; on both where a tip touches what stands on
    /// it.
    bool isApex() const {
        const Vec3d step = axis_ * (apexSlack * surface_.cell_m);
        const std::array points{apex_.as<float>(), (apex_ + step).as<float>(), (apex_ - step).as<float>()};
        const std::vector<float> values = valuesAt(surface_, points);
        return std::abs(values[0]) < surfaceSlack * surface_.cell_m && std::min(values[1], values[2]) < 0;
    }

    /// The triangles that go and those of the fan; false where one of these has a confined vertex that isn't taken.
    bool fillFrom(TipFan& made, bool takesConfined) {
        made.removed = triangles_;
        for (const uint32_t number : triangles_) {
            const TipTriangle& t = surface_.triangles[number];
            if (countOf(t) != 1) continue;
            size_t k = 0;
            while (!cutOff_.contains(t.corners[static_cast<int>(k)])) ++k;
            const size_t b = (k + 1) % 3, c = (k + 2) % 3;
            for (const size_t corner : {b, c})
                if (!takesConfined && surface_.isConfined[t.corners[static_cast<int>(corner)]]) {
                    lacksConfined_ = true;
                    return false;
                }
            TipTriangle fan = t;
            fan.corners[static_cast<int>(k)] = made.top;
            fan.normals[k] = normalized(t.normals[b] + t.normals[c]);
            fan.ownNormals = static_cast<uint8_t>(t.ownNormals | 1u << k);
            made.triangles.push_back(fan);
        }
        return made.triangles.size() >= 3;
    }

    /// Whether the sides of the fan opposite to the apex are one loop that goes through no vertex twice.
    static bool isOneLoop(const TipFan& made) {
        std::unordered_map<uint32_t, uint32_t> next;
        for (const TipTriangle& t : made.triangles) {
            int k = 0;
            while (t.corners[k] != made.top) ++k;
            if (!next.emplace(t.corners[(k + 1) % 3], t.corners[(k + 2) % 3]).second) return false;
        }
        uint32_t v = next.begin()->first;
        for (size_t i = 0; i < next.size(); ++i) {
            const auto to = next.find(v);
            if (to == next.end()) return false;
            v = to->second;
            if (v == next.begin()->first) return i + 1 == next.size();
        }
        return false;
    }

    /// The triangles around the border of a fan, ascending.
    std::vector<uint32_t> beside(const TipFan& made) const {
        std::vector<uint32_t> found;
        for (const TipTriangle& t : made.triangles)
            for (int k = 0; k < 3; ++k)
                if (t.corners[k] != made.top)
                    for (const uint32_t other : around(t.corners[k])) found.push_back(other);
        std::sort(found.begin(), found.end());
        found.erase(std::unique(found.begin(), found.end()), found.end());
        return found;
    }

    double errorOf(const TipFan& made) const {
        std::vector<Vec3f> points;
        for (const TipTriangle& t : made.triangles) {
            const std::array<Vec3f, 3> p = placesOf(surface_, made, t);
            points.push_back((p[0] + p[1] + p[2]) * (1.0f / 3));
            for (size_t k = 0; k < 3; ++k) {
                points.push_back((p[k] + p[(k + 1) % 3]) * 0.5f);
                if (!surface_.isConfined[t.corners[static_cast<int>(k)]]) points.push_back(p[k]);
            }
        }
        const std::vector<float> values = valuesAt(surface_, points);
        double most = 0;
        for (const float f : values) {
            if (!std::isfinite(f)) return std::numeric_limits<double>::infinity();
            most = std::max(most, static_cast<double>(std::abs(f)));
        }
        return most;
    }

    const TipSurface& surface_;
    const uint32_t vertex_;
    const Vec3d guess_;
    const Axis axisKind_;
    uint32_t top_ = 0;
    Vec3d apex_, axis_;
    bool lacksConfined_ = false, reachesApex_ = false;
    MarkedNumbers& cutOff_;            ///< vertices
    std::vector<uint32_t> triangles_;  ///< with such vertices, ascending
};

}  // namespace

std::optional<TangentPlanes::Intersection> TangentPlanes::meeting() const {
    const auto n = static_cast<double>(count_);
    const double determinant = dot(rows_[0], cross(rows_[1], rows_[2]));
    if (!(determinant > leastDeterminant * n * n * n)) return {};
    const Vec3d p = (cross(rows_[1], rows_[2]) * right_.x + cross(rows_[2], rows_[0]) * right_.y +
                     cross(rows_[0], rows_[1]) * right_.z) *
                    (1 / determinant);
    return Intersection{p, std::sqrt(std::max(0.0, (squares_ - dot(right_, p)) / n))};
}

std::vector<float> valuesAt(const TipSurface& surface, std::span<const Vec3f> points) {
    std::vector<float> x, y, z, values(points.size());
    for (const Vec3f& p : points) x.push_back(p.x), y.push_back(p.y), z.push_back(p.z);
    eval::evaluate(surface.field, {x.data(), y.data(), z.data(), points.size()}, values.data(),
                   surface.scratch.workspace);
    return values;
}

bool mayBeTip(const TipSurface& surface, uint32_t vertex, Vec3d apex) {
    const std::span<const Axis> axes = axesAt(surface, vertex);
    return std::any_of(axes.begin(), axes.end(),
                       [&](Axis axis) { return FanBuilder(surface, vertex, apex, axis).endsBelowApex(); });
}

std::optional<TipFan> fanAt(const TipSurface& surface, uint32_t vertex, Vec3d apex) {
    std::optional<TipFan> first;
    for (const Axis axis : axesAt(surface, vertex)) {
        FanBuilder builder(surface, vertex, apex, axis);
        std::array<bool, std::size(cuts)> isOpen;
        isOpen.fill(true);
        for (const bool takesConfined : {false, true})
            for (size_t i = 0; i < isOpen.size(); ++i) {
                if (!isOpen[i]) continue;
                auto fan = builder.fan(cuts[i], takesConfined);
                isOpen[i] = builder.lacksConfined();
                if (builder.reachesApex()) std::fill(isOpen.begin() + static_cast<ptrdiff_t>(i), isOpen.end(), false);
                if (!fan) continue;
                if (fan->error_m < surfaceSlack * surface.cell_m) return fan;
                if (!first) first = std::move(fan);
            }
    }
    return first;
}

void dropCrossing(const TipSurface& surface, std::vector<TipFan>& fans, const Progress* progress) {
    std::vector<Box3f> boxes;
    for (const TipFan& fan : fans) {
        Box3f box{fan.apex, fan.apex};
        for (const TipTriangle& t : fan.triangles)
            for (int k = 0; k < 3; ++k)
                if (t.corners[k] != fan.top) box = hull(box, surface.positions[t.corners[k]]);
        boxes.push_back(box);
    }
    const BoxFinder finder(boxes);
    std::vector<std::vector<uint32_t>> near(fans.size());
    finder.visitMeeting(
        surface.positions, 0, surface.triangles.size(), [&](size_t t) { return surface.triangles[t].corners; },
        [&](size_t t, std::span<const uint32_t> found) {
            for (const uint32_t i : found) near[i].push_back(static_cast<uint32_t>(t));
        });
    size_t kept = 0;
    for (size_t i = 0; i < fans.size() && !cancelled(progress); ++i) {
        const auto meets = [&](const Box3f& box) { return !intersection(box, boxes[i]).empty(); };
        const auto end = boxes.begin() + static_cast<ptrdiff_t>(kept);
        if (std::any_of(boxes.begin(), end, meets) || crosses(surface, fans[i], near[i])) continue;
        boxes[kept] = boxes[i];
        std::swap(fans[kept++], fans[i]);
    }
    fans.resize(kept);
}

}  // namespace sgm::mesh
