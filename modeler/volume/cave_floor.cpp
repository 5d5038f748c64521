// The walkable floor as a mesh: triangles of the surface, halved where only part of them is walkable until a voxel
// bounds them. Halves meet edge to edge (longest-edge bisection, Rivara 1984).
#include <algorithm>
#include <cmath>
#include <tuple>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "modeler/mesh/corners.h"
#include "modeler/volume/cave.h"

namespace sgm::volume {
namespace {

/// Whether the agent can stand, by place.
class Walkable {
public:
    explicit Walkable(const Cave& cave) : cave_(cave) {}

    bool at(Vec3f p) const {
        const Vec3f index = indexOf(p);
        return isWalkable(static_cast<int32_t>(std::lround(index.x)), static_cast<int32_t>(std::lround(index.z)), p.y);
    }

    enum class Share { None, All, Some };
    /// Of a triangle that isn't steep, by the columns whose middles it covers, else by its own middle.
    Share of(Vec3f a, Vec3f b, Vec3f c) const {
        const Vec3f p = indexOf(a), q = indexOf(b), r = indexOf(c);
        const float whole = cross2(p, q, r);
        bool some = false, all = true, any = false;
        const auto look = [&](float lo, float hi, auto&& take) {
            for (auto i = static_cast<int32_t>(std::ceil(lo)); static_cast<float>(i) <= hi; ++i) take(i);
        };
        look(std::min({p.x, q.x, r.x}), std::max({p.x, q.x, r.x}), [&](int32_t x) {
            look(std::min({p.z, q.z, r.z}), std::max({p.z, q.z, r.z}), [&](int32_t z) {
                const Vec3f at{static_cast<float>(x), 0, static_cast<float>(z)};
                const float u = cross2(at, q, r) / whole, v = cross2(p, at, r) / whole, w = 1 - u - v;
                if (!(u >= 0 && v >= 0 && w >= 0)) return;
                const bool stands = isWalkable(x, z, u * a.y + v * b.y + w * c.y);
                any = true;
                some = some || stands;
                all = all && stands;
            });
        });
        if (!any) some = all = at((a + b + c) / 3.0f);
        return all ? Share::All : some ? Share::Some : Share::None;
    }

private:
    Vec3f indexOf(Vec3f p) const { return (p - cave_.origin) / cave_.voxel_m; }
    /// Twice the area seen from above.
    static float cross2(Vec3f a, Vec3f b, Vec3f c) { return (b.x - a.x) * (c.z - a.z) - (b.z - a.z) * (c.x - a.x); }

    bool isWalkable(int32_t x, int32_t z, float y_m) const {
        const auto before = [](const FloorCell& a, const FloorCell& b) {
            return std::tie(a.x, a.z) < std::tie(b.x, b.z);
        };
        const auto [first, last] =
            std::equal_range(cave_.walkable.begin(), cave_.walkable.end(), FloorCell{x, z, 0}, before);
        return std::any_of(first, last, [&](const FloorCell& f) { return std::abs(f.y_m - y_m) <= 2 * cave_.voxel_m; });
    }

    const Cave& cave_;
};

/// A triangle of the floor to be.
struct Piece {
    mesh::Triangle corners;
    Vec3f normals[3];
    OriginId origin = 0;
    mesh::Label label = {};
    Walkable::Share share = Walkable::Share::Some;
};

class FloorCutter {
public:
    FloorCutter(const mesh::Mesh& mesh, const Cave& cave)
        : cave_(cave), walkable_(cave), positionsOnly_(mesh.hasPositionsOnly()) {
        collect(mesh);
    }

    /// Halves pieces until each is walkable whole, or not, or as small as a voxel.
    void refine() {
        for (;;) {
            marked_.clear();
            for (Piece& piece : pieces_) judge(piece);
            if (marked_.empty()) return;
            while (markLonger()) {
            }
            std::vector<Piece> whole = std::exchange(pieces_, {});
            for (const Piece& piece : whole) split(piece);
        }
    }

    mesh::Chunk walkable() const {
        mesh::Chunk kept;
        std::vector<uint32_t> numberOf(positions_.size(), nowhere);
        for (const Piece& piece : pieces_) {
            if (piece.share != Walkable::Share::All) continue;
            mesh::Triangle own;
            for (int corner = 0; corner < 3; ++corner) {
                uint32_t& number = numberOf[piece.corners[corner]];
                if (number == nowhere) {
                    number = static_cast<uint32_t>(kept.positions.size());
                    kept.positions.push_back(positions_[piece.corners[corner]]);
                    if (!positionsOnly_) kept.normals.push_back(piece.normals[corner]);
                }
                own[corner] = number;
                if (!positionsOnly_ && kept.normals[number] != piece.normals[corner])
                    kept.cornerNormals.push_back(
                        {static_cast<uint32_t>(3 * kept.triangles.size()) + static_cast<uint32_t>(corner),
                         piece.normals[corner]});
            }
            kept.triangles.push_back(own);
            if (!positionsOnly_) kept.origins.push_back(piece.origin);
            if (hasLabels_) kept.labels.push_back(piece.label);
        }
        return kept;
    }

private:
    using Edge = std::pair<uint32_t, uint32_t>;

    void collect(const mesh::Mesh& mesh) {
        const float upright = static_cast<float>(std::cos(cave_.agent.slope_rad)) - 0.05f;
        std::vector<Vec3f> normals;
        for (const mesh::Chunk& c : mesh.chunks) {
            positions_.insert(positions_.end(), c.positions.begin(), c.positions.end());
            normals.insert(normals.end(), c.normals.begin(), c.normals.end());
            hasLabels_ = hasLabels_ || !c.labels.empty();
        }
        const mesh::CornerNormalTable own = mesh::collectCornerNormals(mesh);
        size_t number = 0;  // of a triangle of the mesh
        for (const mesh::Chunk& c : mesh.chunks)
            for (size_t t = 0; t < c.triangles.size(); ++t, ++number) {
                Piece piece{c.inMesh(c.triangles[t]), {}};
                const Vec3f a = place(piece, 0), b = place(piece, 1), d = place(piece, 2);
                if (normalized(cross(b - a, d - a)).y < upright) continue;
                if (!positionsOnly_) {
                    for (int k = 0; k < 3; ++k) {
                        const uint32_t ownNormal = own.empty() ? mesh::noIndex : own.of[number][k];
                        piece.normals[k] =
                            ownNormal == mesh::noIndex ? normals[piece.corners[k]] : own.normals[ownNormal];
                    }
                    piece.origin = c.origins[t];
                }
                if (!c.labels.empty()) piece.label = c.labels[t];
                pieces_.push_back(piece);
            }
    }

    Vec3f place(const Piece& piece, int corner) const { return positions_[piece.corners[corner]]; }
    /// The edge across from a corner, the lower vertex first.
    static Edge edgeOf(const Piece& piece, int corner) {
        return std::minmax({piece.corners[(corner + 1) % 3], piece.corners[(corner + 2) % 3]});
    }
    static uint64_t keyOf(Edge edge) { return uint64_t(edge.first) << 32 | edge.second; }
    bool isMarked(const Piece& piece, int corner) const { return marked_.contains(keyOf(edgeOf(piece, corner))); }
    float length2(Edge edge) const {
        const Vec3f along = positions_[edge.second] - positions_[edge.first];
        return dot(along, along);
    }
    /// The corner across from the longest edge; equal lengths are told apart by their vertices.
    int acrossFromLongest(const Piece& piece) const {
        int best = 0;
        for (int k = 1; k < 3; ++k)
            if (std::pair(length2(edgeOf(piece, k)), edgeOf(piece, k)) >
                std::pair(length2(edgeOf(piece, best)), edgeOf(piece, best)))
                best = k;
        return best;
    }

    /// Decides about a piece, or marks its longest edge to be halved.
    void judge(Piece& piece) {
        if (piece.share != Walkable::Share::Some) return;
        piece.share = walkable_.of(place(piece, 0), place(piece, 1), place(piece, 2));
        if (piece.share != Walkable::Share::Some) return;
        const Edge longest = edgeOf(piece, acrossFromLongest(piece));
        if (length2(longest) > cave_.voxel_m * cave_.voxel_m)
            marked_.insert(keyOf(longest));
        else
            piece.share = walkable_.at((place(piece, 0) + place(piece, 1) + place(piece, 2)) / 3.0f)
                              ? Walkable::Share::All
                              : Walkable::Share::None;
    }

    /// A piece with a marked edge is halved along its longest one first; true when that marked another.
    bool markLonger() {
        bool more = false;
        for (const Piece& piece : pieces_)
            if (isMarked(piece, 0) || isMarked(piece, 1) || isMarked(piece, 2))
                more |= marked_.insert(keyOf(edgeOf(piece, acrossFromLongest(piece)))).second;
        return more;
    }

    uint32_t middleOf(Edge edge) {
        const auto [known, isNew] = middles_.try_emplace(keyOf(edge), static_cast<uint32_t>(positions_.size()));
        if (isNew) positions_.push_back((positions_[edge.first] + positions_[edge.second]) * 0.5f);
        return known->second;
    }

    /// Halves a piece at its longest marked edge, and the halves at theirs.
    void split(const Piece& piece) {
        int at = -1;
        for (int k = 0; k < 3; ++k)
            if (isMarked(piece, k) && (at < 0 || length2(edgeOf(piece, k)) > length2(edgeOf(piece, at)))) at = k;
        if (at < 0) return pieces_.push_back(piece);
        const int next = (at + 1) % 3, last = (at + 2) % 3;
        const uint32_t middle = middleOf(edgeOf(piece, at));
        const Vec3f normal = positionsOnly_ ? Vec3f{} : normalized(piece.normals[next] + piece.normals[last]);
        Piece first = piece, second = piece;
        first.corners[last] = second.corners[next] = middle;
        first.normals[last] = second.normals[next] = normal;
        split(first);
        split(second);
    }

    const Cave& cave_;
    Walkable walkable_;
    bool positionsOnly_, hasLabels_ = false;
    std::vector<Vec3f> positions_;
    std::vector<Piece> pieces_;
    std::unordered_set<uint64_t> marked_;
    std::unordered_map<uint64_t, uint32_t> middles_;
};

}  // namespace

mesh::Mesh walkableFloor(const mesh::Mesh& mesh, const Cave& cave) {
    FloorCutter cutter(mesh, cave);
    cutter.refine();
    mesh::Mesh floor;
    floor.chunks.push_back(cutter.walkable());
    return floor;
}

}  // namespace sgm::volume
