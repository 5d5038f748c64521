#include "viewer/window/benchmark.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "viewer/document/param_rows.h"

namespace sgm::viewer {
namespace {

constexpr size_t mostDrags = 20, mostStructures = 6;

/// The parameter that a hand would drag first.
const ParamRow* firstSlider(const std::vector<ParamRow>& rows) {
    for (const ParamRow& row : rows)
        if ((row.kind == ParamRow::Kind::Real || row.kind == ParamRow::Kind::Integer) && !row.lo.empty()) return &row;
    return nullptr;
}

}  // namespace

bool Benchmark::begin(Workbench& bench) {
    since_ = {};
    compiles_ = bench.field.times().compiles;
    waiting_ = true;
    if (phase_ == Phase::Drag) {
        const std::vector<ParamRow> rows = paramRows(*bench.shown()->grammar, bench.shown()->options, bench.document.choice());
        const ParamRow* slider = firstSlider(rows);
        if (slider && drags_.size() < mostDrags) {
            bench.edit(setParams(*bench.document.ast(), bench.document.choice(), {stepped(*slider, drags_.size() % 2 == 1)}), "Drag");
            return true;
        }
        phase_ = Phase::Structure;
    }
    const std::vector<syntax::RuleDecl>& rules = bench.document.ast()->rules;
    if (rules.empty() || structures_.size() >= mostStructures) return false;
    if (structures_.size() % 2 == 1) bench.undo();
    else bench.edit(edits::duplicateRule(*bench.document.ast(), rules.back()), "Duplicate");
    return true;
}

bool Benchmark::go(Workbench& bench, double turn, double drawing) {
    gap_ = std::max(gap_, turn - drawing);
    if (!bench.shown()) return bench.session.problems().empty() || bench.busy();
    const FieldTimes& times = bench.field.times();
    if (phase_ == Phase::Load) {
        if (!bench.field.finished()) return true;
        first_ = bench.shown()->stages;
        for (const auto& [name, seconds] : {std::pair{"cells", bench.cellSeconds}, {"upload", times.upload}, {"compile shaders", times.compile}, {"coarse frame", times.coarse}, {"full frame", times.full}})
            first_.emplace_back(name, seconds);
        phase_ = Phase::Drag;
        return begin(bench);
    }
    if (waiting_ && (bench.busy() || !bench.field.visible() || bench.shown()->revision != bench.document.revision())) return since_.seconds() < 60;
    (phase_ == Phase::Drag ? drags_ : structures_).push_back({since_.seconds(), times.compiles - compiles_});
    return begin(bench);
}

void Benchmark::print(const Workbench& bench, const std::string& driver) const {
    fmt::print("{}\n{}\n", bench.document.path().string(), driver);
    for (const auto& [stage, seconds] : first_) fmt::print("  {:<16} {:8.1f} ms\n", stage, seconds * 1000);
    for (const auto& [name, changes] : {std::pair{"slider to coarse frame", &drags_}, {"rule to coarse frame", &structures_}}) {
        if (changes->empty()) continue;
        std::vector<double> times;
        int compiles = 0;
        for (const Change& change : *changes) {
            times.push_back(change.coarse);
            compiles += change.compiles;
        }
        std::sort(times.begin(), times.end());
        fmt::print("  {:<22} median {:.1f} ms, longest {:.1f} ms, {} times, {} compiles\n", name, times[times.size() / 2] * 1000, times.back() * 1000, times.size(), compiles);
    }
    fmt::print("  longest gap between looks at the hands, drawing excluded: {:.1f} ms\n", gap_ * 1000);
}

}  // namespace sgm::viewer
