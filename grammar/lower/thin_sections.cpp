#include "grammar/lower/thin_sections.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "grammar/derive/boxes.h"
#include "grammar/derive/lift.h"
#include "grammar/lower/local_tapes.h"
#include "modeler/core/parallel.h"

namespace sgm::lower {
namespace {

constexpr int fewestAlong = 5, mostAlong = 24;  ///< lines along an axis of a face
constexpr size_t mostFollowed = 64;             ///< lines of a face that go into solid
constexpr int stepHalvings = 8;                 ///< of a step around a crossing
// In cells, from a face outwards:
constexpr double firstSample = -0.12, step = 0.25, farthest = 1.63;
constexpr int samples = static_cast<int>((farthest - firstSample) / step) + 1;

/// A part whose faces are looked at.
struct FacedPart {
    OriginId part = 0;
    derive::Scope scope;
    uint32_t faces = 0;  ///< as a mask
};

Vec3d unit(int axis) { return {axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0}; }

/// One worker's.
class SectionProber {
public:
    SectionProber(const eval::Tape& tape, float cell_m) : tapes_(tape), cell_m_(static_cast<double>(cell_m)) {}

    void probe(std::span<const FacedPart> parts, std::vector<ThinSection>& found) {
        std::vector<Box3f> boxes;
        for (const FacedPart& c : parts)
            boxes.push_back(derive::boxOf(c.scope).inflated(farthest * cell_m_).template as<float>());
        tapes_.visit(boxes, [&](size_t i, const eval::Tape& tape) {
            for (int face = 0; face < 6; ++face)
                if (parts[i].faces >> face & 1) probeFace(parts[i], face, tape, found);
        });
    }

private:
    /// A line across a face.
    struct Line {
        Vec3d from;
        double first_m = 0, next_m = 0;  ///< where the steps begin that hold the face's surface, and the next one
    };

    void probeFace(const FacedPart& part, int face, const eval::Tape& tape, std::vector<ThinSection>& found) {
        const int axis = face / 2;
        const Vec3d out = part.scope.axes * unit(axis) * (face % 2 ? 1.0 : -1.0);
        listLines(part.scope, face);
        keepCrossing(out, tape);
        if (lines_.empty()) return;
        findNext(out, tape);
        if (lines_.empty()) return;
        ThinSection section{part.part, face, INFINITY, part.scope, {}};
        findCrossings(out, tape, section);
        if (section.lines.empty()) return;
        section.scope.footprint = derive::none;
        section.scope.centre += out * (part.scope.size[axis] + section.thickness_m) * 0.5;
        section.scope.size[axis] = section.thickness_m;
        found.push_back(std::move(section));
    }

    /// Lines through a face, a cell apart where that is possible: of a cut that is larger than what it cuts, few meet
    /// it.
    void listLines(const derive::Scope& scope, int face) {
        const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        const auto along = [&](int across) {
            return std::clamp(static_cast<int>(std::ceil(scope.size[across] / cell_m_)), fewestAlong, mostAlong);
        };
        lines_.clear();
        for (int j = 0; j < along(v); ++j)
            for (int i = 0; i < along(u); ++i) {
                Vec3d share{};
                share[axis] = face % 2 ? 1 : -1;
                share[u] = evenShare(i, along(u)), share[v] = evenShare(j, along(v));
                lines_.push_back({scope.point(share)});
            }
    }

    /// Off the middle, so that no line lies in a plane of symmetry.
    static double evenShare(int i, int n) { return 2 * (i + 0.535) / n - 1; }

    double at(int sample) const { return (firstSample + step * sample) * cell_m_; }

    /// Keeps those lines that go into solid at the face.
    void keepCrossing(Vec3d out, const eval::Tape& tape) {
        points_.clear();
        for (const Line& line : lines_)
            for (const int sample : {0, 1}) points_.add((line.from + out * at(sample)).as<float>());
        evaluate(tape);
        size_t kept = 0;
        for (size_t i = 0; i < lines_.size(); ++i)
            if (values_[2 * i] >= 0 && values_[2 * i + 1] < 0) lines_[kept++] = lines_[i];
        const size_t stride = (kept + mostFollowed - 1) / mostFollowed;
        for (size_t i = 0; stride > 1 && i * stride < kept; ++i) lines_[i] = lines_[i * stride];
        lines_.resize(stride > 1 ? (kept + stride - 1) / stride : kept);
    }

    /// Keeps those that leave it nearby, with the step where they do.
    void findNext(Vec3d out, const eval::Tape& tape) {
        points_.clear();
        for (const Line& line : lines_)
            for (int sample = 1; sample < samples; ++sample) points_.add((line.from + out * at(sample)).as<float>());
        evaluate(tape);
        size_t kept = 0;
        for (size_t i = 0; i < lines_.size(); ++i) {
            const float* const values = values_.data() + i * (samples - 1);
            for (int sample = 1; sample + 1 < samples; ++sample) {
                if (values[sample] < 0) continue;
                lines_[kept] = lines_[i];
                lines_[kept].first_m = at(0), lines_[kept].next_m = at(sample);
                ++kept;
                break;
            }
        }
        lines_.resize(kept);
    }

    /// Halves the steps until both surfaces are known, and asks whose they are.
    void findCrossings(Vec3d out, const eval::Tape& tape, ThinSection& section) {
        const auto point = [&](size_t i, double along) { return (lines_[i / 2].from + out * along).as<float>(); };
        std::vector<std::array<double, 2>> brackets;
        for (const Line& line : lines_)
            for (const double from : {line.first_m, line.next_m}) brackets.push_back({from, from + step * cell_m_});
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
        // Where another part's surface is the same, a mesh may have it as that part's.
        owners_.resize(points_.size()), tied_.resize(points_.size()), labels_.resize(points_.size());
        eval::evaluateOrigin(tape, points_.points(), owners_.data(), tapes_.workspace());
        eval::evaluateLabels(tape, points_.points(), labels_.data(), tied_.data(), tapes_.workspace());
        for (size_t i = 0; i + 1 < points_.size(); i += 2) {
            if (owners_[i] != section.part || tied_[i] != owners_[i] || tied_[i + 1] != owners_[i + 1]) continue;
            section.thickness_m = std::min(section.thickness_m, brackets[i + 1][0] - brackets[i][0]);
            section.lines.push_back({{{points_[i], owners_[i]}, {points_[i + 1], owners_[i + 1]}}});
        }
    }

    void evaluate(const eval::Tape& tape) {
        values_.resize(points_.size());
        eval::evaluate(tape, points_.points(), values_.data(), tapes_.workspace());
    }

    LocalTapes tapes_;
    const double cell_m_;
    std::vector<Line> lines_;
    PointList points_;
    std::vector<float> values_;
    std::vector<OriginId> owners_, tied_;  ///< where several tie, the first of them in `tied_`
    std::vector<uint32_t> labels_;
};

/// Whether a shape, or one that holds it, is cut from what stands.
bool isCut(const derive::Shapes& shapes, derive::ShapeId shape) {
    for (; shape != derive::none; shape = shapes[shape].parent)
        if (shapes[shape].op == rules::Operator::Difference) return true;
    return false;
}

std::vector<FacedPart> facedParts(const derive::Derivation& derivation, const Model& model,
                                  const std::vector<PartFace>* among) {
    std::vector<uint32_t> faces(model.shapeOf.size(), among ? 0u : 63u);
    if (among)
        for (const PartFace& face : *among) faces[face.part] |= 1u << face.face;
    std::vector<FacedPart> all;
    for (OriginId part = 1; part < model.shapeOf.size(); ++part) {
        const derive::ShapeId shape = model.shapeOf[part];
        if (faces[part] == 0 || shape == derive::none || derivation.tree.shapes[shape].solid == derive::none) continue;
        if (!isCut(derivation.tree.shapes, shape)) continue;
        all.push_back({part, derive::liftedScope(derivation, shape), faces[part]});
    }
    orderByPlace(
        std::span(all), [](const FacedPart& c) { return c.scope.centre; }, [](const FacedPart& c) { return c.part; });
    return all;
}

}  // namespace

Result<std::vector<ThinSection>> findThinSections(const derive::Derivation& derivation, const Model& model,
                                                  const eval::Tape& tape, float cell_m, int threads, Progress* progress,
                                                  const std::vector<PartFace>* among) {
    const std::vector<FacedPart> parts = facedParts(derivation, model, among);
    std::vector<SectionProber> probers;
    probers.reserve(static_cast<size_t>(threadCount(threads)));
    for (int w = 0; w < threadCount(threads); ++w) probers.emplace_back(tape, cell_m);
    if (progress) progress->begin("thin walls", parts.size());
    const size_t groups = (parts.size() + LocalTapes::most - 1) / LocalTapes::most;
    std::vector<std::vector<ThinSection>> found(groups);
    parallelFor(groups, threads, progress, [&](size_t group, int worker) {
        const size_t first = group * LocalTapes::most, count = std::min(LocalTapes::most, parts.size() - first);
        probers[static_cast<size_t>(worker)].probe(std::span(parts).subspan(first, count), found[group]);
        for (size_t i = 0; i < count; ++i) tick(progress);
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
