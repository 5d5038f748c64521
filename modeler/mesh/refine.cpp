#include "modeler/mesh/refine.h"

#include <algorithm>
#include <iterator>
#include <optional>

#include "modeler/mesh/cell_seams.h"
#include "modeler/mesh/fine_cells.h"
#include "modeler/mesh/one_chunk.h"
#include "modeler/mesh/surface_patch.h"
#include "modeler/mesh/wrong_meetings.h"

namespace sgm::mesh {
namespace {

constexpr int mostFittings = 24;            ///< of the cells, which change each time
constexpr int mostWidenings = 4;            ///< the first of them: cells that don't fit are added; they go afterwards
constexpr size_t mostGrowth = 4;            ///< times the cells that were asked for there may come to be
constexpr size_t marginDivisor = 4;         ///< of the cells, for how many are meshed beyond where they grow
constexpr size_t leastGrowth = 512;         ///< as many may always
constexpr int reachOfSeam = 2;              ///< cells beside one that is halved: triangles in them may cross
constexpr float sameNormal = 1.0f - 1e-5f;  ///< cosine between normals that needn't be told apart
constexpr uint32_t noFine = 0xffffffffu;

/// How the fine surface in some cells fits the coarse one around them.
struct Fits {
    std::vector<uint32_t> fineOf;      ///< by coarse vertex: the fine one in its place
    std::vector<SeamFit::Edge> edges;  ///< ascending by triangle
};

/// Two surfaces as one, around some cells: the fine one in these and the coarse one beside them.
class JoinedSurface {
public:
    /// `coarse` holds the coarse triangles in the cells, and those that the seam changes or that may cross these.
    JoinedSurface(const SurfaceInCells& coarseCells, const SurfacePatch& coarse, const SurfaceInCells& fineCells,
                  const CellSet& cells, const Fits& fits)
        : coarse_(coarse.surface),
          fine_(fineCells.surface()),
          fits_(fitsIn(coarse, fits)),
          firstFine_(static_cast<uint32_t>(coarse_.positions.size())) {
        const size_t vertices = coarse_.positions.size() + fine_.positions.size();
        const size_t triangles = coarse_.triangles.size() + fine_.triangles.size();
        made_.positions.reserve(vertices), made_.normals.reserve(vertices);
        made_.triangles.reserve(triangles), made_.origins.reserve(triangles), made_.labels.reserve(triangles);
        for (const Chunk* surface : {&coarse_, &fine_}) {
            made_.positions.insert(made_.positions.end(), surface->positions.begin(), surface->positions.end());
            made_.normals.insert(made_.normals.end(), surface->normals.begin(), surface->normals.end());
        }
        made_.confined = coarse_.confined, made_.faceted = coarse_.faceted;
        for (const ConfinedVertex& v : fine_.confined) made_.confined.push_back({firstFine_ + v.vertex, v.place});
        for (const uint32_t v : fine_.faceted) made_.faceted.push_back(firstFine_ + v);
        addCoarse(coarseCells, coarse.triangles, cells);
        addFine(fineCells, cells);
    }

    /// The coarse triangles that changed, by their numbers in the patch, ascending by that in the joined one.
    struct Changed {
        uint32_t triangle, before;
    };
    const std::vector<Changed>& changed() const { return changed_; }
    const Chunk& surface() const { return made_; }
    ReplacedPatch release() { return {std::move(made_), std::move(triangleOf_)}; }

private:
    /// The numbers of triangles and vertices are those of the patch.
    static Fits fitsIn(const SurfacePatch& patch, const Fits& fits) {
        const auto placeIn = [](const std::vector<uint32_t>& numbers, uint32_t number) {
            return static_cast<uint32_t>(std::lower_bound(numbers.begin(), numbers.end(), number) - numbers.begin());
        };
        Fits own;
        for (const uint32_t v : patch.vertices) own.fineOf.push_back(fits.fineOf[v]);
        for (const SeamFit::Edge& e : fits.edges)
            own.edges.push_back({placeIn(patch.triangles, e.triangle), placeIn(patch.vertices, e.from),
                                 placeIn(patch.vertices, e.to), e.inner});
        return own;
    }

    /// Adds the coarse triangles in other cells; edges of the cut become those of the fine one.
    void addCoarse(const SurfaceInCells& surface, const std::vector<uint32_t>& triangles, const CellSet& cells) {
        auto next = fits_.edges.begin();
        visitTriangles(coarse_, [&](uint32_t t, std::span<const CornerNormal> normals) {
            if (cells.contains(surface.cellOf(triangles[t]))) return;
            const auto first = next;
            while (next != fits_.edges.end() && next->triangle == t) ++next;
            addTriangle(t, normals, {first, next});
        });
    }

    /// Adds the fine triangles in the cells.
    void addFine(const SurfaceInCells& surface, const CellSet& cells) {
        visitTriangles(fine_, [&](uint32_t t, std::span<const CornerNormal> normals) {
            if (!cells.contains(surface.cellOf(t))) return;
            const auto triangle = static_cast<uint32_t>(made_.triangles.size());
            const Triangle& c = fine_.triangles[t];
            made_.triangles.push_back({firstFine_ + c.x, firstFine_ + c.y, firstFine_ + c.z});
            made_.origins.push_back(fine_.origins[t]), made_.labels.push_back(fine_.labels[t]);
            for (const CornerNormal& n : normals)
                made_.cornerNormals.push_back({3 * triangle + n.corner % 3, n.normal});
        });
    }

    /// A vertex of the joined surface with the normal of the triangle that it belongs to.
    struct Corner {
        uint32_t vertex;
        Vec3f normal;
        bool hasOwn;  ///< the triangle says another normal than the vertex
    };

    uint32_t placeOf(uint32_t vertex) const {
        const uint32_t fine = fits_.fineOf[vertex];
        return fine == noFine ? vertex : firstFine_ + fine;
    }

    void addTriangle(uint32_t t, std::span<const CornerNormal> normals, std::span<const SeamFit::Edge> cut) {
        std::array<Corner, 3> corners;
        const Triangle& c = coarse_.triangles[t];
        bool moves = false;
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t v = c[static_cast<int>(k)];
            corners[k] = {placeOf(v), coarse_.normals[v], false};
            moves |= corners[k].vertex != v;
        }
        for (const CornerNormal& n : normals) corners[n.corner % 3].normal = n.normal;
        for (Corner& corner : corners) corner.hasOwn = dot(corner.normal, made_.normals[corner.vertex]) < sameNormal;
        for (const CornerNormal& n : normals) corners[n.corner % 3].hasOwn = true;
        const size_t first = made_.triangles.size();
        if (cut.empty()) {
            add(corners, t);
        } else {
            std::vector<std::array<Corner, 3>> parts{corners};
            for (const SeamFit::Edge& edge : cut) splitAlong(parts, edge);
            for (const std::array<Corner, 3>& part : parts) add(part, t);
        }
        if (!moves) return;
        for (size_t i = first; i < made_.triangles.size(); ++i) changed_.push_back({static_cast<uint32_t>(i), t});
    }

    /// Puts fine vertices into the edge of one of the parts, which becomes a fan.
    void splitAlong(std::vector<std::array<Corner, 3>>& parts, const SeamFit::Edge& edge) const {
        if (edge.inner.empty()) return;
        const uint32_t from = placeOf(edge.from), to = placeOf(edge.to);
        for (size_t p = 0; p < parts.size(); ++p)
            for (size_t k = 0; k < 3; ++k) {
                const std::array<Corner, 3> part = parts[p];
                const Corner &a = part[k], &b = part[(k + 1) % 3], &apex = part[(k + 2) % 3];
                if (a.vertex != from || b.vertex != to) continue;
                Corner before = a;
                for (size_t i = 0; i < edge.inner.size(); ++i) {
                    const Corner at = between(a, b, firstFine_ + edge.inner[i]);
                    if (i == 0)
                        parts[p] = {before, at, apex};
                    else
                        parts.push_back({before, at, apex});
                    before = at;
                }
                parts.push_back({before, b, apex});
                return;
            }
    }

    Corner between(const Corner& a, const Corner& b, uint32_t vertex) const {
        const Vec3f from = made_.positions[a.vertex], way = made_.positions[b.vertex] - from;
        const float share = std::clamp(dot(made_.positions[vertex] - from, way) / dot(way, way), 0.0f, 1.0f);
        const Vec3f normal = normalized(a.normal * (1 - share) + b.normal * share);
        return {vertex, normal, dot(normal, made_.normals[vertex]) < sameNormal};
    }

    void add(const std::array<Corner, 3>& part, uint32_t of) {
        const auto triangle = static_cast<uint32_t>(made_.triangles.size());
        made_.triangles.push_back({part[0].vertex, part[1].vertex, part[2].vertex});
        made_.origins.push_back(coarse_.origins[of]), made_.labels.push_back(coarse_.labels[of]);
        triangleOf_.push_back(of);
        for (uint32_t k = 0; k < 3; ++k)
            if (part[k].hasOwn) made_.cornerNormals.push_back({3 * triangle + k, part[k].normal});
    }

    const Chunk &coarse_, &fine_;
    const Fits fits_;
    const uint32_t firstFine_;
    Chunk made_;
    std::vector<uint32_t> triangleOf_;  ///< by coarse triangle of the joined surface: the one that it stands for
    std::vector<Changed> changed_;
};

/// The changed triangles that cross another one, as they are numbered in the patch.
std::vector<uint32_t> crossingTriangles(const JoinedSurface& joined, int threads, const Progress* progress) {
    const Chunk& surface = joined.surface();
    std::vector<uint32_t> changed;
    for (const JoinedSurface::Changed& c : joined.changed()) changed.push_back(c.triangle);
    std::vector<uint32_t> crossing;
    for (const auto& [t, other] : findWrongMeetings(surface.positions, surface.triangles, changed, threads, progress))
        crossing.push_back(joined
                               .changed()[static_cast<size_t>(std::lower_bound(changed.begin(), changed.end(), other) -
                                                              changed.begin())]
                               .before);
    std::sort(crossing.begin(), crossing.end());
    crossing.erase(std::unique(crossing.begin(), crossing.end()), crossing.end());
    return crossing;
}

class Refiner {
public:
    Refiner(const Chunk& coarse, const eval::Tape& field, const Grid& grid, const RefineOptions& options,
            Progress* progress)
        : grid_(grid),
          options_(options),
          progress_(progress),
          coarse_(coarse),
          coarseCells_(coarse_, grid),
          mesher_(field, grid, options.halvings, options.threads, progress),
          fineCells_(mesher_.surface(), grid) {
        coarseCells_.follow();
    }

    /// The surface and the cells that were meshed anew. Nothing where it can't be done. Error::Budget where the mesh
    /// would have too many triangles.
    Result<std::optional<RefinedMesh>> refine(CellSet cells) {
        const size_t mostCells = std::max(mostGrowth * cells.size(), leastGrowth);
        if (CellSet first = affordable(cells); first.size() < cells.size() && options_.halvings > 1)
            return Error{Error::Kind::Budget, "cells halved so often have too many triangles"};
        else
            isCut_ = first.size() < cells.size(), cells = std::move(first);
        if (Status s = meshFinely(cells.list()); !s) return s.error();
        cells = reachedOf(cells);
        for (int fitting = 0; fitting < mostFittings && !cells.empty(); ++fitting) {
            Result<CellSet> misfits = grow(cells, mostCells);
            if (!misfits.ok()) return misfits.error();
            Fits fits;
            if (misfits->empty()) misfits = join(cells, fits);
            if (misfits->empty()) {
                const SurfacePatch patch(coarse_, trianglesAround(cells));
                JoinedSurface joined(coarseCells_, patch, fineCells_, cells, fits);
                for (const uint32_t t : crossingTriangles(joined, options_.threads, progress_))
                    misfits->insert(coarseCells_.cellOf(patch.triangles[t]));
                if (misfits->empty() && !cancelled(progress_)) {
                    RefinedMesh made{{}, std::move(cells)};
                    made.mesh.chunks.push_back(withReplaced(coarse_, patch, joined.release()));
                    return std::optional(std::move(made));
                }
            }
            if (cancelled(progress_)) return cancelledError();
            if (fitting < mostWidenings && cells.size() + misfits->size() <= mostCells)
                for (const Vec3i cell : misfits->list()) cells.insert(cell);
            else
                cells = componentsWithout(cells, *misfits);
        }
        return std::optional<RefinedMesh>();
    }

    /// Whether refine() left cells out for their triangles.
    bool isCut() const { return isCut_; }

private:
    /// The first cells, as many as the mesh can have triangles for, where the fine surface is about as large as the
    /// coarse one.
    CellSet affordable(const CellSet& cells) {
        const size_t ofCell = size_t{2} << 2 * options_.halvings;
        CellSet first;
        size_t triangles = coarse_.triangles.size();
        for (const Vec3i cell : cells.list()) {
            if (!coarseCells_.isEmpty(cell)) triangles += ofCell;
            if (triangles > options_.mostTriangles) break;
            first.insert(cell);
        }
        return first;
    }

    Status meshFinely(std::span<const Vec3i> cells) {
        if (cancelled(progress_)) return cancelledError();
        if (Status s = mesher_.add(cells); !s) return s;
        fineCells_.follow();
        return Done{};
    }

    /// Cells, those next to them, and about so many more around that have surface: few times are to suffice.
    std::vector<Vec3i> withMargin(const std::vector<Vec3i>& cells, size_t margin) {
        CellSet all;
        for (const Vec3i cell : cells) all.insert(cell);
        const size_t asked = all.size();
        for (size_t next = 0; next < all.size() && (next < asked || all.size() < asked + margin); ++next)
            visitSides(Vec3i(all.list()[next]), [&](const CellSide& side) {  // a copy, for the list grows
                const Vec3i beyond = side.beyond();
                if (!isInGrid(grid_, beyond) || mesher_.has(beyond)) return;
                if (next < asked || !coarseCells_.isEmpty(beyond)) all.insert(beyond);
            });
        return all.list();
    }

    /// Those that some surface reaches.
    CellSet reachedOf(const CellSet& cells) {
        CellSet reached;
        for (const Vec3i cell : cells.list())
            if (!coarseCells_.isEmpty(cell) || !fineCells_.isEmpty(cell)) reached.insert(cell);
        return reached;
    }

    /// The coarse triangles in the cells and in those that their seam reaches, ascending.
    std::vector<uint32_t> trianglesAround(const CellSet& cells) {
        CellSet all;
        for (const Vec3i cell : cells.list()) all.insert(cell);
        size_t next = 0;
        for (int distance = 0; distance < reachOfSeam; ++distance)
            for (const size_t end = all.size(); next < end; ++next)
                visitAround(Vec3i(all.list()[next]), [&](Vec3i beside) {
                    if (isInGrid(grid_, beside)) all.insert(beside);
                });
        std::vector<uint32_t> triangles;
        for (const Vec3i cell : all.list()) coarseCells_.visit(cell, [&](uint32_t t) { triangles.push_back(t); });
        std::sort(triangles.begin(), triangles.end());
        return triangles;
    }

    /// Adds cells beyond sides on which the surfaces don't fit, until they do. Returns those that are too many.
    Result<CellSet> grow(CellSet& cells, size_t mostCells) {
        CellSet tooMany;
        std::vector<Vec3i> open = cells.list(), unmeshed;
        for (;;) {
            while (!open.empty()) {
                const Vec3i cell = open.back();
                open.pop_back();
                if (!mesher_.has(cell)) {
                    unmeshed.push_back(cell);
                    continue;
                }
                visitSides(cell, [&](const CellSide& side) {
                    const Vec3i beyond = side.beyond();
                    if (cells.contains(beyond) || !isInGrid(grid_, beyond)) return;
                    if (fitSeam(side, grid_, coarseCells_, fineCells_)) return;
                    if (cells.size() >= mostCells)
                        tooMany.insert(beyond);
                    else if (cells.insert(beyond))
                        open.push_back(beyond);
                });
            }
            if (unmeshed.empty()) return tooMany;
            if (Status s = meshFinely(withMargin(unmeshed, cells.size() / marginDivisor)); !s) return s.error();
            open.swap(unmeshed);
        }
    }

    /// Fits the surfaces on all sides of the cells. Returns the cells beyond those that say other than others.
    CellSet join(const CellSet& cells, Fits& fits) {
        CellSet misfits;
        fits.fineOf.assign(coarse_.positions.size(), noFine);
        std::vector<uint32_t> coarseOf(mesher_.surface().positions.size(), noFine);
        const auto joinVertex = [&](const SeamFit::Pair& pair) {
            uint32_t &fine = fits.fineOf[pair.coarse], &coarse = coarseOf[pair.fine];
            if (fine == noFine && coarse == noFine) fine = pair.fine, coarse = pair.coarse;
            return fine == pair.fine && coarse == pair.coarse;
        };
        for (const Vec3i cell : cells.list())
            visitSides(cell, [&](const CellSide& side) {
                if (cells.contains(side.beyond()) || !isInGrid(grid_, side.beyond())) return;
                auto fit = fitSeam(side, grid_, coarseCells_, fineCells_);
                if (!fit || !std::all_of(fit->vertices.begin(), fit->vertices.end(), joinVertex)) {
                    misfits.insert(side.beyond());
                    return;
                }
                std::move(fit->edges.begin(), fit->edges.end(), std::back_inserter(fits.edges));
            });
        std::sort(fits.edges.begin(), fits.edges.end(), [](const SeamFit::Edge& a, const SeamFit::Edge& b) {
            return std::pair(a.triangle, a.from) < std::pair(b.triangle, b.from);
        });
        return misfits;
    }

    const Grid& grid_;
    const RefineOptions options_;
    Progress* const progress_;
    const Chunk& coarse_;
    SurfaceInCells coarseCells_;
    FineCells mesher_;
    SurfaceInCells fineCells_;
    bool isCut_ = false;
};

}  // namespace

Result<Refinement> refineCells(const Mesh& mesh, const eval::Tape& field, const Grid& grid, const CellSet& cells,
                               const RefineOptions& options, Progress* progress) {
    Refinement refinement;
    if (cells.empty() || mesh.hasPositionsOnly()) return refinement;
    const bool isOneChunk = mesh.chunks.size() == 1;
    const Chunk joined = isOneChunk ? Chunk{} : joinChunks(mesh);
    for (RefineOptions now = options; now.halvings > 0; --now.halvings) {
        Refiner refiner(isOneChunk ? mesh.chunks[0] : joined, field, grid, now, progress);
        auto refined = refiner.refine(cells);
        refinement.isBounded |= refiner.isCut();
        if (refined.ok()) {
            refinement.made = std::move(*refined);
            break;
        }
        if (refined.error().kind == Error::Kind::Cancelled) return refined.error();
        if (refined.error().kind != Error::Kind::Budget) break;
        refinement.isBounded = true;
    }
    return refinement;
}

}  // namespace sgm::mesh
