#include "grammar/lower/thin_sections.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "grammar/derive/boxes.h"
#include "grammar/derive/lift.h"
#include "grammar/lower/scope_lines.h"
#include "modeler/eval/local_tapes.h"

namespace sgm::lower {
namespace {

constexpr int fewestAlong = 3, mostAlong = 18;  ///< lines along an axis of a face
constexpr size_t mostTiles = 2048;              ///< of a face that are looked at, besides the first ones
constexpr double leastTile = 3;                 ///< cells: as narrow as a part may show in an opening
constexpr size_t firstFollowed = 48;            ///< lines of a face, where none of them meets surface nearby
constexpr int stepHalvings = 8;                 ///< of a step around a crossing
constexpr double leastThickness = 0.0078125;    ///< cells: in seams of parts that touch the field is 0 again
constexpr double leastFaced = 0.125;            ///< cells: the extent of a part beside which gaps are looked for
constexpr std::array nearEnds{0.13, 0.3, 0.6};  ///< of a face, in cells
constexpr double nearEndShare = 0.125;          ///< of a face, at most
// In cells, from a face outwards:
constexpr double firstSample = -0.12, step = 0.25, farthest = 1.63;
constexpr int samples = static_cast<int>((farthest - firstSample) / step) + 1;

/// A part whose faces are looked at.
struct FacedPart {
    OriginId part = 0;
    derive::Scope scope;
    uint32_t faces = 0;  ///< as a mask
    bool cuts = false;   ///< from what stands, or is in what does

    Vec3d centre() const { return scope.centre; }
    OriginId number() const { return part; }
};

/// One worker's.
class SectionProber {
public:
    /// `bounds` hold the field's surface.
    SectionProber(const eval::Tape& tape, const Box3f& bounds, float cell_m)
        : tapes_(tape), bounds_(bounds), cell_m_(static_cast<double>(cell_m)) {}

    Box3f boxOf(const FacedPart& part) const {
        return derive::boxOf(part.scope).inflated(farthest * cell_m_).as<float>();
    }
    eval::LocalTapes& tapes() { return tapes_; }

    void probe(std::span<const FacedPart> parts, std::span<const Box3f> boxes, std::vector<ThinSection>& found) {
        tapes_.visit(boxes, [&](size_t i, const eval::Tape& tape) {
            for (int face = 0; face < 6; ++face)
                if (parts[i].faces >> face & 1) probeFace(parts[i], face, tape, found);
        });
    }

private:
    /// A line across a face.
    struct Line {
        Vec3d from;
        std::array<Vec3d, 2> half{};  ///< half extents of the tile that it is the middle of; none for further lines
        double next_m = 0;            ///< where the step begins that holds the next surface
    };

    /// Of lines along an axis of a face.
    struct Places {
        std::vector<double> at;
        size_t even = 0;       ///< the first so many, evenly spaced
        double spacing_m = 0;  ///< of these
    };

    void probeFace(const FacedPart& part, int face, const eval::Tape& tape, std::vector<ThinSection>& found) {
        const Vec3d out = part.scope.axes * alongAxis(face / 2) * (face % 2 ? 1.0 : -1.0);
        ThinSection section{!part.cuts, part.part, face, part.scope, 0, {}};
        section.spacing_m = listLines(part.scope, face);
        keepCrossing(out, tape, part.cuts);
        const std::vector<Line> crossing = lines_;
        lines_ = someOf(crossing);
        const bool areAll = lines_.size() == crossing.size();
        follow(out, tape, section);
        if (section.lines.empty()) return;
        if (!areAll) {
            lines_ = crossing;
            follow(out, tape, section);
        }
        found.push_back(std::move(section));
    }

    /// About so many of the grid's lines, and of those in smaller tiles, as are followed at first.
    std::vector<Line> someOf(std::span<const Line> lines) const {
        std::vector<Line> some;
        for (const std::span<const Line> group : {lines.first(gridLines_), lines.subspan(gridLines_)}) {
            const size_t stride = std::max<size_t>((group.size() + firstFollowed - 1) / firstFollowed, 1);
            for (size_t i = 0; i < group.size(); i += stride) some.push_back(group[i]);
        }
        return some;
    }

    /// Leaves in the section which of the lines meet surface nearby.
    void follow(Vec3d out, const eval::Tape& tape, ThinSection& section) {
        section.lines.clear();
        if (!lines_.empty()) findNext(out, tape, !section.isGap);
        if (!lines_.empty()) findCrossings(out, tape, section);
    }

    /// Lines through what of a face lies in the bounds. Returns how far apart they are at most.
    double listLines(const derive::Scope& scope, int face) {
        const int axis = face / 2, across[] = {(axis + 1) % 3, (axis + 2) % 3};
        const Vec3d middle = bounds_.centre().as<double>() - scope.centre, half = bounds_.size().as<double>() * 0.5;
        std::array<Vec3d, 2> d, halfTile;
        lines_.clear();
        for (size_t k = 0; k < 2; ++k) {
            d[k] = scope.axes * alongAxis(across[k]);
            const Vec3d a{std::abs(d[k].x), std::abs(d[k].y), std::abs(d[k].z)};
            const double reach = scope.size[across[k]] * 0.5;
            const double low = std::max(-reach, dot(d[k], middle) - dot(a, half));
            const double high = std::min(reach, dot(d[k], middle) + dot(a, half));
            if (!(low < high)) return 0;
            listPlaces(low, high, places_[k]);
            halfTile[k] = d[k] * (0.5 * places_[k].spacing_m);
        }
        const Vec3d corner = scope.centre + scope.axes * (alongAxis(axis) * scope.size[axis] * (face % 2 ? 0.5 : -0.5));
        const auto& [alongU, alongV] = places_;
        for (size_t v = 0; v < alongV.at.size(); ++v)
            for (size_t u = 0; u < alongU.at.size(); ++u) {
                lines_.push_back({corner + d[0] * alongU.at[u] + d[1] * alongV.at[v]});
                if (u < alongU.even && v < alongV.even) lines_.back().half = halfTile;
            }
        return std::max(alongU.spacing_m, alongV.spacing_m);
    }

    /// Places a cell apart where that is possible, for of a cut that is larger than what it cuts few meet it; and some
    /// near the ends, for a part may show these alone.
    void listPlaces(double low, double high, Places& places) const {
        const double size = high - low;
        const auto count =
            static_cast<int>(std::clamp(std::ceil(size / cell_m_), double{fewestAlong}, double{mostAlong}));
        places = {{}, static_cast<size_t>(count), size / count};
        for (int i = 0; i < count; ++i)  // off the middle, so that no line lies in a plane of symmetry
            places.at.push_back(low + size * (i + 0.535) / count);
        for (const double cells : nearEnds)
            if (cells * cell_m_ < nearEndShare * size)
                places.at.push_back(low + cells * cell_m_), places.at.push_back(high - cells * cell_m_);
    }

    double at(int sample) const { return (firstSample + step * sample) * cell_m_; }

    /// Keeps those lines that go into solid, or out of it, at the face, and adds some in tiles that a line misses but
    /// the surface may come into: a bar that runs through a house shows in an opening alone.
    void keepCrossing(Vec3d out, const eval::Tape& tape, bool intoSolid) {
        const float slope = eval::believedSlope(tape);
        std::vector<Line> crossing, open = lines_;
        for (size_t looked = 0; !open.empty() && looked < mostTiles; looked += open.size()) {
            points_.clear();
            for (const Line& line : open)
                for (const int sample : {0, 1}) points_.add((line.from + out * at(sample)).as<float>());
            evaluate(tape);
            std::vector<Line> tiles;
            for (size_t i = 0; i < open.size(); ++i) {
                const float before = values_[2 * i], behind = values_[2 * i + 1];
                if ((before < 0) != intoSolid && (behind < 0) == intoSolid)
                    crossing.push_back(open[i]);
                else if (std::min(std::abs(before), std::abs(behind)) < slope * reachOf(open[i]))
                    split(open[i], tiles);
            }
            if (looked == 0) gridLines_ = crossing.size();
            open = std::move(tiles);
        }
        lines_ = std::move(crossing);
    }

    /// From a line's samples to the corners of its tile, metres.
    float reachOf(const Line& line) const {
        return static_cast<float>(length(line.half[0] + line.half[1]) - firstSample * cell_m_);
    }

    /// Adds the parts of a line's tile, where it is larger than what is looked for.
    void split(const Line& line, std::vector<Line>& tiles) const {
        static constexpr std::array whole{0.0};
        static constexpr std::array parts{-1.0, 1.0};
        std::array<Vec3d, 2> half = line.half;
        std::array<std::span<const double>, 2> places{whole, whole};
        for (size_t k = 0; k < 2; ++k)
            if (2 * length(half[k]) > leastTile * cell_m_) half[k] = half[k] * 0.5, places[k] = parts;
        if (places[0].size() * places[1].size() == 1) return;
        for (const double v : places[1])
            for (const double u : places[0]) tiles.push_back({line.from + half[0] * u + half[1] * v, half});
    }

    /// Keeps those that do the contrary nearby, with the step where they do.
    void findNext(Vec3d out, const eval::Tape& tape, bool intoSolid) {
        points_.clear();
        for (const Line& line : lines_)
            for (int sample = 1; sample < samples; ++sample) points_.add((line.from + out * at(sample)).as<float>());
        evaluate(tape);
        size_t kept = 0;
        for (size_t i = 0; i < lines_.size(); ++i) {
            const float* const values = values_.data() + i * (samples - 1);
            for (int sample = 1; sample + 1 < samples; ++sample) {
                if ((values[sample] < 0) == intoSolid) continue;
                lines_[kept] = lines_[i];
                lines_[kept++].next_m = at(sample);
                break;
            }
        }
        lines_.resize(kept);
    }

    /// Halves the steps around both surfaces, and finds the owners of these.
    void findCrossings(Vec3d out, const eval::Tape& tape, ThinSection& section) {
        const auto point = [&](size_t i, double along) { return (lines_[i / 2].from + out * along).as<float>(); };
        std::vector<std::array<double, 2>> brackets;
        for (const Line& line : lines_)
            for (const double from : {at(0), line.next_m}) brackets.push_back({from, from + step * cell_m_});
        points_.clear();
        for (size_t i = 0; i < brackets.size(); ++i) points_.add(point(i, brackets[i][0]));
        evaluate(tape);
        const std::vector<float> atStart = values_;
        for (int halving = 0; halving < stepHalvings; ++halving) {
            points_.clear();
            for (size_t i = 0; i < brackets.size(); ++i) points_.add(point(i, (brackets[i][0] + brackets[i][1]) * 0.5));
            evaluate(tape);
            for (size_t i = 0; i < brackets.size(); ++i)
                brackets[i][(atStart[i] < 0) == (values_[i] < 0) ? 0 : 1] = (brackets[i][0] + brackets[i][1]) * 0.5;
        }
        const std::vector<OriginId>& owners = owners_.at(points_, tape, tapes_.workspace());
        const double thinnest_m = cell_m_ / turnOf(section.scope, section.face / 2);  // that cells hold for certain
        for (size_t i = 0; i + 1 < points_.size(); i += 2) {
            const double thickness_m = brackets[i + 1][0] - brackets[i][0];
            if (thickness_m < leastThickness * cell_m_ || thickness_m >= thinnest_m) continue;
            if (owners[i] != section.part) continue;
            section.lines.push_back(
                {{{{points_[i], owners[i]}, {points_[i + 1], owners_.first()[i + 1]}}}, thickness_m});
        }
    }

    void evaluate(const eval::Tape& tape) {
        values_.resize(points_.size());
        eval::evaluate(tape, points_.points(), values_.data(), tapes_.workspace());
    }

    eval::LocalTapes tapes_;
    Box3f bounds_;
    double cell_m_;
    std::array<Places, 2> places_;
    std::vector<Line> lines_;
    size_t gridLines_ = 0;  ///< of these the first, from the even places and near the ends
    eval::PointList points_;
    std::vector<float> values_;
    eval::SurfaceOwners owners_;
};

/// By shape: whether it, or one that holds it, is cut from what stands.
std::vector<bool> cutShapes(const derive::Shapes& shapes) {
    std::vector<bool> cuts(shapes.size());
    for (derive::ShapeId s = 0; s < shapes.size(); ++s)
        cuts[s] =
            shapes[s].op == rules::Operator::Difference || (shapes[s].parent != derive::none && cuts[shapes[s].parent]);
    return cuts;
}

std::vector<FacedPart> facedParts(const derive::Derivation& derivation, const Model& model, double cell_m,
                                  const std::vector<ThinPart>* among) {
    std::vector<uint32_t> faces(model.shapeOf.size(), among ? 0u : 63u);
    if (among)
        for (const ThinPart& thin : *among)
            if (thin.face >= 0) faces[thin.part] |= 1u << thin.face;
    const std::vector<bool> cuts = cutShapes(derivation.tree.shapes);
    std::vector<FacedPart> all;
    for (OriginId part = 1; part < model.shapeOf.size(); ++part) {
        const derive::ShapeId shape = model.shapeOf[part];
        if (faces[part] == 0 || shape == derive::none || derivation.tree.shapes[shape].solid == derive::none) continue;
        if (!model.provenance.parts[part].hasFlatFaces) continue;
        // What no halved cells hold is missing itself, whatever the gaps beside it are.
        if (!cuts[shape] && minComponent(derivation.tree.shapes[shape].scope.size) < leastFaced * cell_m) continue;
        all.push_back({part, derive::liftedScope(derivation, shape), faces[part], cuts[shape]});
    }
    eval::orderByPlace(std::span(all));
    return all;
}

}  // namespace

Result<std::vector<ThinSection>> findThinSections(const derive::Derivation& derivation, const Model& model,
                                                  const eval::Tape& tape, float cell_m, int threads, Progress* progress,
                                                  const std::vector<ThinPart>* among) {
    const std::vector<FacedPart> parts = facedParts(derivation, model, static_cast<double>(cell_m), among);
    std::vector<std::vector<ThinSection>> found((parts.size() + eval::LocalTapes::mostBoxes - 1) /
                                                eval::LocalTapes::mostBoxes);
    eval::probeInGroups(
        std::span(parts), threads, progress, "thin walls and gaps",
        [&] { return SectionProber(tape, model.field.bounds, cell_m); },
        [&](SectionProber& prober, std::span<const FacedPart> some, std::span<const Box3f> boxes, size_t group) {
            prober.probe(some, boxes, found[group]);
        });
    if (cancelled(progress)) return cancelledError();
    std::vector<ThinSection> all;
    for (std::vector<ThinSection>& some : found) std::move(some.begin(), some.end(), std::back_inserter(all));
    std::sort(all.begin(), all.end(), [](const ThinSection& a, const ThinSection& b) {
        return std::pair(a.part, a.face) < std::pair(b.part, b.face);
    });
    return all;
}

}  // namespace sgm::lower
