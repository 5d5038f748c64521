#include "grammar/lower/off_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>

#include "grammar/derive/boxes.h"
#include "modeler/eval/evaluate.h"
#include "modeler/eval/local_tapes.h"
#include "modeler/mesh/one_chunk.h"

namespace sgm::lower {
namespace {

/// So many cells off the surface the middle of a triangle or of its edges is wrong: of flat parts, of those whose edges
/// end thinner than any cell, as eaves and mouldings, and of round ones, beside what a chord is off that.
constexpr float offFlat = 0.03f, offEaves = 0.12f, offRound = 0.06f;
constexpr float chordSlack = 2;     ///< times what a chord is off by the normals at its ends
constexpr float boxCells = 8;       ///< of the cubes whose triangles are looked at together
constexpr double placeCells = 0.5;  ///< edge of a place: the triangle's own cell and those beside it

/// The middles of the triangles that lie in a cube, and those of their edges.
struct Patch {
    Vec3i index;
    Box3f box;
    std::vector<Vec3f> points;
    std::vector<OriginId> parts;
    std::vector<float> most_m;  ///< that they may be off
    std::vector<float> off_m;   ///< by the field

    void add(Vec3f point, OriginId part, float mostOff_m) {
        box = hull(box, point);
        points.push_back(point), parts.push_back(part), most_m.push_back(mostOff_m);
    }
    Vec3d centre() const { return ((box.lo + box.hi) * 0.5f).as<double>(); }
    uint64_t number() const {
        return (static_cast<uint64_t>(index.x) & 0x1fffff) << 42 | (static_cast<uint64_t>(index.y) & 0x1fffff) << 21 |
               (static_cast<uint64_t>(index.z) & 0x1fffff);
    }
};

/// One worker's.
class OffProber {
public:
    OffProber(const eval::Tape& tape, float cell_m) : tapes_(tape), cell_m_(cell_m) {}

    Box3f boxOf(const Patch& patch) const { return patch.box.inflated(cell_m_); }
    eval::LocalTapes& tapes() { return tapes_; }

    void probe(std::span<Patch> patches, std::span<const Box3f> boxes) {
        tapes_.visit(boxes, [&](size_t i, const eval::Tape& tape) {
            Patch& patch = patches[i];
            points_.clear();
            for (const Vec3f& p : patch.points) points_.add(p);
            patch.off_m.resize(points_.size());
            eval::evaluate(tape, points_.points(), patch.off_m.data(), tapes_.workspace());
        });
    }

private:
    eval::LocalTapes tapes_;
    float cell_m_;
    eval::PointList points_;
};

/// By vertex: where it belongs.
std::vector<Vec3f> placesOf(const mesh::Mesh& mesh) {
    std::vector<Vec3f> places;
    places.reserve(mesh.vertexCount());
    for (const mesh::Chunk& c : mesh.chunks) {
        places.insert(places.end(), c.positions.begin(), c.positions.end());
        for (const mesh::ConfinedVertex& v : c.confined) places[c.firstVertex + v.vertex] = v.place;
    }
    return places;
}

/// The normals at a triangle's corners, of its own piece.
std::array<Vec3f, 3> normalsOf(const std::vector<Vec3f>& ofVertices, const mesh::Triangle& corners,
                               std::span<const mesh::CornerNormal> own) {
    std::array<Vec3f, 3> normals{ofVertices[corners.x], ofVertices[corners.y], ofVertices[corners.z]};
    for (const mesh::CornerNormal& n : own) normals[n.corner % 3] = n.normal;
    return normals;
}

/// How far an edge of a triangle is off a round surface with these normals at its ends: the sagitta.
float sagittaOf(const std::array<Vec3f, 3>& corners, const std::array<Vec3f, 3>& normals) {
    float most = 0;
    for (size_t k = 0; k < 3; ++k) {
        const size_t next = (k + 1) % 3;
        most = std::max(most, length(corners[next] - corners[k]) * length(normals[next] - normals[k]) / 8);
    }
    return most;
}

/// By vertex: whether it lies between two pieces.
std::vector<bool> bordersOf(const mesh::Mesh& mesh) {
    constexpr uint64_t unseen = ~uint64_t{0};
    std::vector<uint64_t> pieces(mesh.vertexCount(), unseen);
    std::vector<bool> areBorders(pieces.size());
    for (const mesh::Chunk& c : mesh.chunks)
        for (size_t t = 0; t < c.triangles.size(); ++t) {
            const uint64_t piece = uint64_t{c.origins[t]} << 32 | c.labels[t];
            const mesh::Triangle corners = c.inMesh(c.triangles[t]);
            for (int k = 0; k < 3; ++k) {
                uint64_t& known = pieces[corners[k]];
                if (known == unseen) known = piece;
                if (known != piece) areBorders[corners[k]] = true;
            }
        }
    return areBorders;
}

/// How far a triangle's corners lie apart along a face's normal.
float extentAlong(Vec3f normal, const std::array<Vec3f, 3>& corners) {
    const float a = dot(corners[0], normal), b = dot(corners[1], normal), c = dot(corners[2], normal);
    return std::max({a, b, c}) - std::min({a, b, c});
}

/// How far triangles of a part may be off the surface.
struct MostOff {
    float cells = 0;  ///< 0: nobody asks
    bool isRound = false;
};

/// Of parts by how far they may be off. A triangle in the plane of its face is
/// right also where a round border cuts a corner of it off.
std::vector<Patch> patchesOf(const mesh::Mesh& mesh, float cell_m, const std::vector<MostOff>& mostOff) {
    const std::vector<Vec3f> places = placesOf(mesh);
    std::vector<Vec3f> ofVertices;
    ofVertices.reserve(places.size());
    for (const mesh::Chunk& c : mesh.chunks) ofVertices.insert(ofVertices.end(), c.normals.begin(), c.normals.end());
    const std::vector<bool> areBorders = bordersOf(mesh);
    std::map<uint64_t, size_t> numbers;
    std::vector<Patch> patches;
    const float perMetre = 1 / (boxCells * cell_m);
    for (const mesh::Chunk& c : mesh.chunks)
        mesh::visitTriangles(c, [&](uint32_t t, std::span<const mesh::CornerNormal> own) {
            const MostOff most = mostOff[c.origins[t]];
            if (most.cells == 0) return;
            const mesh::Triangle corners = c.inMesh(c.triangles[t]);
            if (areBorders[corners.x] + areBorders[corners.y] + areBorders[corners.z] < 2) return;
            const std::array<Vec3f, 3> triangle{places[corners.x], places[corners.y], places[corners.z]};
            const float sagitta_m = most.isRound ? sagittaOf(triangle, normalsOf(ofVertices, corners, own)) : 0;
            const float most_m = most.cells * cell_m + chordSlack * sagitta_m;
            if (!own.empty() && extentAlong(own[0].normal, triangle) <= most.cells * cell_m) return;
            const Vec3f middle = (triangle[0] + triangle[1] + triangle[2]) * (1.0f / 3);
            Patch at;
            for (int axis = 0; axis < 3; ++axis) at.index[axis] = static_cast<int>(std::floor(middle[axis] * perMetre));
            const auto [known, isNew] = numbers.emplace(at.number(), patches.size());
            if (isNew) patches.push_back(at);
            Patch& patch = patches[known->second];
            patch.add(middle, c.origins[t], most_m);
            // A triangle across a corner that is cut off is farthest off at its edges.
            for (size_t k = 0; k < 3; ++k)
                patch.add((triangle[k] + triangle[(k + 1) % 3]) * 0.5f, c.origins[t], most_m);
        });
    return patches;
}

/// By shape: whether flat faces of it bend, since it or one that holds it blends, morphs, is clad or displaced, or what
/// follows one of them blends into it or morphs it.
std::vector<bool> bentShapes(const derive::ShapeTree& tree) {
    const auto bendsOthers = [&](derive::ShapeId s) {
        return tree.shapes[s].op == rules::Operator::Morph || tree.shapes[s].blend_m > 0;
    };
    const auto isBent = [&](derive::ShapeId s) {
        const derive::Extras* const extras = tree.extrasOf(s);
        return bendsOthers(s) ||
               (extras && (!extras->clad.empty() || !extras->displace.empty() || extras->relief != derive::none));
    };
    std::vector<bool> areBent(tree.shapes.size());
    if (!areBent.empty()) areBent[0] = isBent(0);
    std::vector<derive::ShapeId> children;
    for (derive::ShapeId parent = 0; parent < tree.shapes.size(); ++parent) {
        children.clear();
        for (derive::ShapeId s = tree.shapes[parent].firstChild; s != derive::none; s = tree.shapes[s].nextSibling)
            children.push_back(s);
        bool bends = areBent[parent];
        for (; !children.empty(); children.pop_back()) {
            areBent[children.back()] = bends || isBent(children.back());
            bends = bends || bendsOthers(children.back());
        }
        // A shape's own solid comes before its children.
        areBent[parent] = areBent[parent] || bends;
    }
    return areBent;
}

/// By part; nobody asks where it bends, or isn't among others, where those aren't null.
std::vector<MostOff> mostOffOf(const derive::Derivation& derivation, const Model& model,
                               const std::vector<ThinPart>* among) {
    std::vector<bool> areWanted(model.shapeOf.size(), !among);
    std::vector<MostOff> mostOff(model.shapeOf.size());
    if (among)
        for (const ThinPart& part : *among) areWanted[part.part] = true;
    const std::vector<bool> areBent = bentShapes(derivation.tree);
    for (OriginId part = 1; part < model.shapeOf.size(); ++part) {
        const derive::ShapeId shape = model.shapeOf[part];
        if (shape == derive::none || !areWanted[part] || areBent[shape]) continue;
        const derive::SolidValue* const solid = derivation.tree.solidOf(shape);
        if (!solid || !solid->primitive) continue;
        const bool standsOut = derive::standsOut_m(*solid, derivation.tree.shapes[shape].scope.size.y) > 0;
        const bool isRound = !standsOut && !solid->primitive->hasFlatFaces;
        mostOff[part] = {standsOut ? offEaves : isRound ? offRound : offFlat, isRound};
    }
    return mostOff;
}

}  // namespace

Result<std::vector<ThinPart>> findOffSurface(const derive::Derivation& derivation, const Model& model,
                                             const eval::Tape& tape, const mesh::Mesh& mesh, float cell_m, int threads,
                                             Progress* progress, const std::vector<ThinPart>* among) {
    std::vector<ThinPart> found;
    const bool hasNoPieces = std::any_of(mesh.chunks.begin(), mesh.chunks.end(), [](const mesh::Chunk& c) {
        return c.labels.size() != c.triangles.size() || c.origins.size() != c.triangles.size();
    });
    if (hasNoPieces) return found;
    std::vector<Patch> patches = patchesOf(mesh, cell_m, mostOffOf(derivation, model, among));
    eval::orderByPlace(std::span(patches));
    eval::probeInGroups(
        std::span(patches), threads, progress, "creases", [&] { return OffProber(tape, cell_m); },
        [](OffProber& prober, std::span<Patch> some, std::span<const Box3f> boxes, size_t) {
            prober.probe(some, boxes);
        });
    if (cancelled(progress)) return cancelledError();
    std::map<OriginId, ThinPart> parts;
    for (const Patch& patch : patches)
        for (size_t k = 0; k < patch.off_m.size(); ++k) {  // none in an empty box
            if (std::abs(patch.off_m[k]) <= patch.most_m[k]) continue;
            ThinPart& part = parts[patch.parts[k]];
            const double edge_m = placeCells * static_cast<double>(cell_m);
            part.places.push_back({patch.points[k].as<double>(), {}, {edge_m, edge_m, edge_m}});
        }
    for (auto& [number, part] : parts) {
        part.kind = ThinPart::Kind::Rim, part.part = number;
        part.thickness_m = part.cell_m = static_cast<double>(cell_m) / 2;
        found.push_back(std::move(part));
    }
    return found;
}

}  // namespace sgm::lower
