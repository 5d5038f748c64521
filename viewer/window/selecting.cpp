#include "viewer/window/selecting.h"

#include <fmt/format.h>

#include <algorithm>

namespace sgm::window {

void revealPlace(Workbench& bench, const document::Problem& problem) {
    const syntax::Source& source = *bench.document.ast()->source;
    if (!problem.line) return;
    if (problem.file != source.name()) {
        std::error_code failed;
        if (!std::filesystem::is_regular_file(problem.file, failed))
            return bench.say(fmt::format("{}:{}: {}", problem.file, problem.line, problem.message), true);
        const std::string user = std::filesystem::path(source.name()).filename().string();
        return bench.drop(problem.file, [&bench, problem, user] {
            if (bench.document.ast()->source->name() != problem.file) return;
            revealPlace(bench, problem);
            bench.say(fmt::format("{} is open, which {} uses", bench.document.path().filename().string(), user));
        });
    }
    const std::string_view line = source.line(problem.line);
    const auto start = static_cast<uint32_t>(line.data() - source.text().data());
    const uint32_t begin = start + std::min<uint32_t>(problem.column - 1, static_cast<uint32_t>(line.size()));
    const uint32_t end =
        problem.endLine == problem.line ? start + problem.endColumn - 1 : start + static_cast<uint32_t>(line.size());
    bench.panels.reveal = {begin, std::max(begin, end)};
    bench.panels.showText = true;
}

void selectRow(Workbench& bench, const document::RuleRow& row) {
    bench.view.face.reset();
    bench.selection.selectRow(bench.document, bench.shown(), row);
    if (const std::string notice = bench.selection.takeNotice(); !notice.empty()) bench.say(notice);
}

void selectText(Workbench& bench, uint32_t offset) {
    const auto rows = document::ruleRows(*bench.document.ast());
    const size_t row = rowAt(rows, offset);
    if (row == rows.size()) return;
    selectRow(bench, rows[row]);
    bench.panels.revealRow = true;
}

std::optional<Hover> hoverOf(const Workbench& bench, const Pick& pick) {
    if (pick.kind != render::HitKind::Object || !bench.shown()) return std::nullopt;
    const auto picked = document::pick(*bench.shown(), pick.origin);
    if (!picked) return std::nullopt;
    Hover hover{pick.position, picked->shape,
                fmt::format("{}  ·  {}", picked->symbol, picked->rule.empty() ? "start" : "rule " + picked->rule),
                document::faceAt(*bench.shown(), picked->shape, pick.position.as<double>())};
    if (picked->element.source)
        hover.text +=
            fmt::format("  ·  {}:{}", std::filesystem::path(picked->element.source->name()).filename().string(),
                        picked->element.source->place(picked->element.begin).line);
    if (hover.face) hover.text += "  ·  " + document::labelOf(*hover.face);
    return hover;
}

void attach(Workbench& bench, derive::ShapeId moved, derive::ShapeId host, uint32_t joint) {
    bench.edit(document::attach(bench.document, *bench.shown(), moved, host, joint),
               fmt::format("Join at {}", bench.tree()->joint(host, joint).name));
}

}  // namespace sgm::window
