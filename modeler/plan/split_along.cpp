// Cutting a polygon across a chain of its edges.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "modeler/plan/clipper_paths.h"
#include "modeler/plan/cut.h"
#include "modeler/plan/edge_match.h"
#include "modeler/plan/edit.h"
#include "modeler/plan/validate.h"

namespace sgm::plan {
namespace {

/// Points of the chain nearer than this to a corner are the corner; likewise where cuts end.
constexpr double near_m = 2e-3;
/// (1 + cos) / 2 of the bend at a corner that a street takes as a curve: 30°.
constexpr double smoothBend = 0.933;
constexpr int noPart = -1;

/// A point of a piece's outline and the edge that begins there.
struct Node {
    Vec2 at;
    Edge edge;
    int part = noPart;  ///< of the chain's parts, the one that the edge belongs to
};
using Outline = std::vector<Node>;

struct Piece {
    Outline outline;  ///< counter-clockwise; may touch itself along a cut to a court
    std::vector<Outline> courts;
};

/// Where the chain is cut, and which way the cut goes.
struct CutPoint {
    Vec2 at, inward;
};

const Ring& ringOf(const Footprint& footprint, const Chain& chain) {
    const Polygon& polygon = footprint.polygons[chain.polygon];
    return chain.ring == 0 ? polygon.outer : polygon.courts[chain.ring - 1];
}

Outline outlineOf(const Ring& ring) {
    Outline outline;
    for (size_t i = 0; i < ring.size(); ++i) outline.push_back({ring.points[i], ring.edges[i], noPart});
    return outline;
}

Vec2 inwardOf(Vec2 from, Vec2 to) {
    const Vec2 d = to - from;
    const double l = length(d);
    return l > 0 ? Vec2{-d.z / l, d.x / l} : Vec2{};
}

/// The chain's ring with the cut points inserted and its edges numbered by part; the cut points in order, with one
/// where the chain begins if wanted.
std::pair<Outline, std::vector<CutPoint>> withCutPoints(const Ring& ring, const Chain& chain,
                                                        std::span<const double> at, bool cutsAtStart) {
    Outline outline;
    std::vector<CutPoint> cuts;
    const size_t n = ring.size();
    // Towards the middle of what a corner's edges face; along bends of a street it turns from corner to corner.
    const auto inwardAt = [&](size_t edge, double share) {
        const Vec2 own = inwardOf(ring.from(edge), ring.to(edge));
        const auto towards = [&](size_t other) {
            const Vec2 sum = own + inwardOf(ring.from(other), ring.to(other));
            return dot(own, sum) > 2 * smoothBend ? sum * (1 / length(sum)) : own;
        };
        const Vec2 begin = towards((edge + n - 1) % n), end = towards((edge + 1) % n);
        const Vec2 mean = begin * (1 - share) + end * share;
        return mean * (1 / length(mean));
    };
    const auto bisector = [&](size_t corner) {
        const Vec2 a = inwardOf(ring.from((corner + n - 1) % n), ring.to((corner + n - 1) % n)),
                   b = inwardOf(ring.from(corner), ring.to(corner));
        const Vec2 sum = a + b;
        return length(sum) > 1e-6 ? sum * (1 / length(sum)) : b;
    };
    if (cutsAtStart) cuts.push_back({ring.from(chain.first), bisector(chain.first)});
    double passed = 0;
    size_t next = 0;
    for (size_t k = 0; k < n; ++k) {
        const size_t i = (chain.first + k) % n;
        const bool inChain = k < chain.count;
        const double l = length(ring.to(i) - ring.from(i));
        outline.push_back({ring.from(i), ring.edges[i], inChain ? static_cast<int>(next) : noPart});
        if (!inChain) continue;
        for (; next < at.size() && at[next] < passed + l; ++next) {
            const double t = at[next] - passed;
            if (l - t < near_m && k + 1 < chain.count) break;  // at the next corner
            const Vec2 p = ring.from(i) + (ring.to(i) - ring.from(i)) * (t / l);
            cuts.push_back({p, inwardAt(i, t / l)});
            outline.push_back({p, ring.edges[i], static_cast<int>(next) + 1});
        }
        passed += l;
        if (next < at.size() && k + 1 < chain.count && at[next] <= passed + near_m) {
            const size_t corner = (i + 1) % n;
            cuts.push_back({ring.from(corner), bisector(corner)});
            ++next;
        }
    }
    return {outline, cuts};
}

/// Where a cut ends: on which outline of a piece (0 its own, 1 + k court k), behind which node.
struct Hit {
    double far = Box2::far;
    size_t outline = 0, node = 0;
    Vec2 at;
    bool atNode = false;
};

void lookForHit(const Outline& outline, size_t number, size_t own, const CutPoint& cut, Hit& hit) {
    const size_t n = outline.size();
    for (size_t i = 0; i < n; ++i) {
        const Vec2 a = outline[i].at, b = outline[(i + 1) % n].at;
        if (number == 0 && (i == own || (i + 1) % n == own)) continue;
        const Vec2 d = b - a;
        const double by = cross(cut.inward, d);
        if (by < 1e-12 * length(d)) continue;  // the solid is on the edge's left, where the cut comes from
        const double far = cross(a - cut.at, d) / by, t = cross(a - cut.at, cut.inward) / by;
        if (far < 1e-6 || t < -1e-9 || t > 1 + 1e-9 || far >= hit.far) continue;
        const double l = length(d);
        hit = {far, number, i, a + d * t, false};
        if (t * l < near_m) hit.at = a, hit.atNode = true;
        if ((1 - t) * l < near_m) hit.at = b, hit.atNode = true, hit.node = (i + 1) % n;
    }
}

/// Whether the direction goes into the outline at a node.
bool goesIn(const Outline& outline, size_t node, Vec2 way) {
    const size_t n = outline.size();
    const Vec2 at = outline[node].at, on = outline[(node + 1) % n].at - at, back = outline[(node + n - 1) % n].at - at;
    const bool convex = cross(on, back) > 0;
    const bool leftOfOn = cross(on, way) > 0, rightOfBack = cross(way, back) > 0;
    return convex ? leftOfOn && rightOfBack : leftOfOn || rightOfBack;
}

/// The nodes from one to another, both ends included.
Outline walk(const Outline& outline, size_t from, size_t to) {
    Outline nodes;
    for (size_t i = from;; i = (i + 1) % outline.size()) {
        nodes.push_back(outline[i]);
        if (i == to) return nodes;
    }
}

/// The number of the node at the hit, inserted where there is none; `own` moves along if it must.
size_t nodeAt(Outline& outline, const Hit& hit, size_t* own) {
    if (hit.atNode) return hit.node;
    Node node = outline[hit.node];
    node.at = hit.at;
    outline.insert(outline.begin() + static_cast<ptrdiff_t>(hit.node) + 1, node);
    if (own && *own > hit.node) ++*own;
    return hit.node + 1;
}

bool contains(const Outline& outline, Vec2 p) {
    Ring ring;
    for (const Node& node : outline) ring.points.push_back(node.at), ring.edges.push_back(node.edge);
    return contains(footprintOf({ring, {}}), p);
}

/// Cuts the piece that holds the cut point as a corner. A cut that ends on a court joins it to the outline; `toCourts`:
/// no other cut is made.
void cutPieces(std::vector<Piece>& pieces, const CutPoint& cut, bool toCourts) {
    constexpr Edge made{0, EdgeSource::Cut};
    for (size_t p = 0; p < pieces.size(); ++p) {
        Piece& piece = pieces[p];
        for (size_t own = 0; own < piece.outline.size(); ++own) {
            if (!(piece.outline[own].at == cut.at) || !goesIn(piece.outline, own, cut.inward)) continue;
            Hit hit;
            lookForHit(piece.outline, 0, own, cut, hit);
            for (size_t c = 0; c < piece.courts.size(); ++c) lookForHit(piece.courts[c], c + 1, own, cut, hit);
            if (hit.far == Box2::far || (toCourts && hit.outline == 0)) return;
            if (hit.outline > 0) {
                Outline court = piece.courts[hit.outline - 1];
                piece.courts.erase(piece.courts.begin() + static_cast<ptrdiff_t>(hit.outline) - 1);
                const size_t at = nodeAt(court, hit, nullptr);
                std::rotate(court.begin(), court.begin() + static_cast<ptrdiff_t>(at), court.end());
                court.push_back({court.front().at, made, noPart});
                court.insert(court.begin(), {cut.at, made, noPart});
                piece.outline.insert(piece.outline.begin() + static_cast<ptrdiff_t>(own), court.begin(), court.end());
                return;
            }
            const size_t end = nodeAt(piece.outline, hit, &own);
            if (end == own || piece.outline[end].at == cut.at) return;
            Outline after = walk(piece.outline, own, end), before = walk(piece.outline, end, own);
            after.back() = {after.back().at, made, noPart};
            before.back() = {before.back().at, made, noPart};
            Piece second{std::move(before), {}};
            std::vector<Outline> courts = std::move(piece.courts);
            piece = {std::move(after), {}};
            for (Outline& court : courts)
                (contains(piece.outline, court.front().at) ? piece : second).courts.push_back(std::move(court));
            pieces.push_back(std::move(second));
            return;
        }
    }
}

/// The part of the chain that most metres of the piece's outline belong to.
int partOf(const Piece& piece) {
    std::map<int, double> metres;
    for (size_t i = 0; i < piece.outline.size(); ++i)
        if (piece.outline[i].part != noPart)
            metres[piece.outline[i].part] +=
                length(piece.outline[(i + 1) % piece.outline.size()].at - piece.outline[i].at);
    int best = noPart;
    for (const auto& [part, l] : metres)
        if (best == noPart || l > metres[best]) best = part;
    return best;
}

Footprint footprintOf(const Piece& piece, const std::vector<std::string>& tags) {
    const auto ring = [](const Outline& outline) {
        Ring result;
        for (const Node& node : outline) result.points.push_back(node.at), result.edges.push_back(node.edge);
        return result;
    };
    Footprint result;
    result.tags = tags;
    Polygon polygon{ring(piece.outline), {}};
    for (const Outline& court : piece.courts) polygon.courts.push_back(ring(court));
    result.polygons.push_back(std::move(polygon));
    if (!firstFault(result)) return result;
    Footprint sound = booleanOf(PathBoolean::Union, pathsOf(result), {});
    sound.tags = tags;
    matchEdges(sound, sourcesOf(result));
    return tidied(std::move(sound));
}

}  // namespace

Chain longestChain(const Footprint& footprint, const std::vector<bool>& belongs) {
    Chain best;
    double most = 0;
    const std::vector<PlacedEdge> edges = edgesOf(footprint);
    for (size_t begin = 0, end; begin < edges.size(); begin = end) {
        for (end = begin + 1; end < edges.size() && edges[end].index != 0;) ++end;
        const size_t n = end - begin;
        const auto in = [&](size_t i) { return begin + i % n < belongs.size() && belongs[begin + i % n]; };
        size_t first = 0;  // an edge before which the run can't go on
        while (first < n && in(first)) ++first;
        const auto consider = [&](size_t from, size_t count) {
            double l = 0;
            for (size_t k = 0; k < count; ++k) l += edges[begin + (from + k) % n].length();
            if (l > most)
                most = l, best = {edges[begin].polygon, edges[begin].ring, static_cast<uint32_t>(from % n),
                                  static_cast<uint32_t>(count)};
        };
        if (first == n) {
            consider(0, n);
            continue;
        }
        for (size_t i = first; i < first + n;) {
            size_t count = 0;
            while (count < n && in(i + count)) ++count;
            if (count > 0) consider(i, count);
            i += count + 1;
        }
    }
    return best;
}

double length(const Footprint& footprint, const Chain& chain) {
    const Ring& ring = ringOf(footprint, chain);
    double sum = 0;
    for (uint32_t k = 0; k < chain.count; ++k) {
        const size_t i = (chain.first + k) % ring.size();
        sum += length(ring.to(i) - ring.from(i));
    }
    return sum;
}

Result<std::vector<AlongPart>> splitAlong(const Footprint& footprint, const Chain& chain,
                                          std::span<const double> at_m) {
    const auto refused = [](std::string why) { return Error{Error::Kind::Input, std::move(why)}; };
    if (chain.polygon >= footprint.polygons.size() || chain.ring > footprint.polygons[chain.polygon].courts.size() ||
        chain.count == 0 || chain.count > ringOf(footprint, chain).size())
        return refused("there is no such chain of edges to split along");
    const double whole = length(footprint, chain);
    for (size_t i = 0; i < at_m.size(); ++i)
        if (!(at_m[i] > near_m && at_m[i] < whole - near_m) || (i > 0 && at_m[i] < at_m[i - 1] + near_m))
            return refused(
                fmt::format("a cut at {:.6g} m of a chain of {:.6g} m must lie inside it and beyond the cut before",
                            at_m[i], whole));

    const Polygon& polygon = footprint.polygons[chain.polygon];
    // Around a court, or along all of a ring, it takes a cut more to part the first piece from the last.
    const bool isClosed = chain.count == ringOf(footprint, chain).size(),
               cutsAtStart = isClosed || !polygon.courts.empty();
    auto [outline, cuts] = withCutPoints(ringOf(footprint, chain), chain, at_m, cutsAtStart);
    std::vector<Piece> pieces(1);
    if (chain.ring == 0) {
        pieces[0].outline = outline;
        for (const Ring& court : polygon.courts) pieces[0].courts.push_back(outlineOf(court));
    } else {
        // The court takes the outline's part: what lies around it is then a "court" that cuts may end on.
        pieces[0].outline = outline;
        pieces[0].courts.push_back(outlineOf(polygon.outer));
        for (size_t c = 0; c < polygon.courts.size(); ++c)
            if (c + 1 != chain.ring) pieces[0].courts.push_back(outlineOf(polygon.courts[c]));
    }
    for (size_t i = 0; i < cuts.size(); ++i) cutPieces(pieces, cuts[i], i == 0 && cutsAtStart && !isClosed);

    std::vector<AlongPart> parts(at_m.size() + 1);
    for (AlongPart& part : parts) part.footprint.tags = footprint.tags;
    for (const Piece& piece : pieces) {
        const int number = partOf(piece);
        if (number == noPart || number >= static_cast<int>(parts.size())) continue;
        Footprint& into = parts[static_cast<size_t>(number)].footprint;
        into = into.empty() ? footprintOf(piece, footprint.tags)
                            : boolean(Boolean::Union, into, footprintOf(piece, footprint.tags));
    }
    const size_t shift = cutsAtStart ? 1 : 0;
    const Ring& ring = ringOf(footprint, chain);
    for (size_t i = 0; i < parts.size(); ++i) {
        parts[i].from = i == 0 ? ring.from(chain.first) : cuts[i - 1 + shift].at;
        parts[i].to =
            i + 1 == parts.size() ? ring.to((chain.first + chain.count - 1) % ring.size()) : cuts[i + shift].at;
    }
    return parts;
}

}  // namespace sgm::plan
