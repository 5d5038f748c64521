#include "viewer/window/benchmark.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "viewer/document/param_rows.h"

namespace sgm::window {
namespace {

constexpr size_t mostDrags = 20, mostStructures = 6;

/// The parameter that a user would drag first.
const document::ParamRow* firstSlider(const std::vector<document::ParamRow>& rows) {
    for (const document::ParamRow& row : rows)
        if ((row.kind == document::ParamRow::Kind::Real || row.kind == document::ParamRow::Kind::Integer) &&
            !row.lo.empty())
            return &row;
    return nullptr;
}

/// The first shape that a start places.
const syntax::Element* firstElement(const syntax::Ast& ast) {
    for (const syntax::StartDecl& start : ast.starts)
        for (const auto& chain : start.body.siblings)
            for (const syntax::Element& element : chain) return &element;
    return nullptr;
}

}  // namespace

bool Benchmark::begin(Workbench& bench) {
    since_ = {};
    compiles_ = bench.status.compiles;
    waiting_ = true;
    if (phase_ == Phase::Drag) {
        const std::vector<document::ParamRow> rows =
            paramRows(*bench.shown()->grammar, bench.shown()->options, bench.document.choice());
        const document::ParamRow* slider = firstSlider(rows);
        if (slider && drags_.size() < mostDrags) {
            if (drags_.empty()) bench.document.beginDrag();
            bench.edit(
                setParams(*bench.document.ast(), bench.document.choice(), {stepped(*slider, drags_.size() % 2 == 1)}),
                "Drag");
            return true;
        }
        bench.document.endDrag();
        phase_ = Phase::Structure;
    }
    if (structures_.size() >= mostStructures) return false;
    if (structures_.size() % 2 == 1) {
        bench.undo();
        return true;
    }
    const syntax::Element* first = firstElement(*bench.document.ast());
    if (!first) return false;
    const uint64_t before = bench.document.revision();
    bench.edit(document::edits::addElement(*bench.document.ast(), *first, "+ cylinder at +y"), "Add a shape");
    return bench.document.revision() != before;
}

bool Benchmark::go(Workbench& bench, const FrameTimeline& turn) {
    const ElapsedTimes spent = turn.spent();
    if (spent.wall > gap_.wall) longest_ = turn.parts();
    gap_ = {std::max(gap_.wall, spent.wall), std::max(gap_.processor, spent.processor)};
    if (!bench.shown()) return bench.session.problems().empty() || bench.busy();
    const FieldTimes& times = bench.view.field.times();
    if (phase_ == Phase::Load) {
        if (!bench.view.field.finished()) return true;
        first_ = bench.shown()->stages;
        for (const auto& [name, seconds] : {std::pair{"cells", bench.status.fieldTimes.prepare},
                                            {"upload", bench.status.fieldTimes.upload},
                                            {"compile shaders", bench.status.fieldTimes.compile},
                                            {"coarse frame", times.coarse},
                                            {"full frame", times.full}})
            first_.emplace_back(name, seconds);
        phase_ = Phase::Drag;
        return begin(bench);
    }
    if (waiting_ &&
        (bench.busy() || !bench.view.field.visible() || bench.shown()->revision != bench.document.revision()))
        return since_.seconds() < 60;
    (phase_ == Phase::Drag ? drags_ : structures_)
        .push_back({since_.seconds(), bench.status.compiles - compiles_, bench.shown()->stages});
    return begin(bench);
}

/// The stages of a drag's models, as the pipeline reports them, beside those of the first model.
void Benchmark::printDragStages() const {
    if (drags_.size() < 2) return;
    double whole = 0, dragged = 0;
    for (const char* stage : {"derive", "lower", "compile"}) {
        std::vector<double> times;
        const auto secondsOf = [&](const pipeline::Stages& stages) {
            double seconds = 0;
            for (const auto& [name, s] : stages) seconds += name == stage ? s : 0;
            return seconds;
        };
        // The first drag makes what the next ones keep.
        for (size_t i = 1; i < drags_.size(); ++i) times.push_back(secondsOf(drags_[i].stages));
        std::sort(times.begin(), times.end());
        const double first = secondsOf(first_), median = times[times.size() / 2];
        fmt::print("  {:<8} of the slider    {:8.2f} ms, of the whole model {:8.2f} ms\n", stage, median * 1000,
                   first * 1000);
        whole += first, dragged += median;
    }
    fmt::print("  a slider's model takes 1/{:.0f} of the whole one's\n", whole / std::max(dragged, 1e-9));
}

void Benchmark::print(const Workbench& bench, const std::string& driver) const {
    fmt::print("{}\n{}\n", bench.document.path().string(), driver);
    for (const auto& [stage, seconds] : first_) fmt::print("  {:<16} {:8.1f} ms\n", stage, seconds * 1000);
    for (const auto& [name, changes] :
         {std::pair{"slider to coarse frame", &drags_}, {"shape to coarse frame", &structures_}}) {
        if (changes->empty()) continue;
        std::vector<double> times;
        int compiles = 0;
        for (const Change& change : *changes) {
            times.push_back(change.coarse);
            compiles += change.compiles;
        }
        std::sort(times.begin(), times.end());
        fmt::print("  {:<22} median {:.1f} ms, longest {:.1f} ms, {} times, {} compiles\n", name,
                   times[times.size() / 2] * 1000, times.back() * 1000, times.size(), compiles);
    }
    printDragStages();
    fmt::print(
        "  longest gap between polls of the input, drawing excluded: {:.1f} ms; by the processor's clock, without what "
        "other programs took: {:.1f} ms\n",
        gap_.wall * 1000, gap_.processor * 1000);
    for (const auto& [name, spent] : longest_)
        if (spent.wall >= 5e-5)
            fmt::print("    {:<30} {:6.1f} ms, of the processor's {:.1f} ms\n", name, spent.wall * 1000,
                       spent.processor * 1000);
}

}  // namespace sgm::window
