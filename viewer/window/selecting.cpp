#include "viewer/window/selecting.h"

#include <fmt/format.h>

#include <algorithm>

namespace sgm::window {

void revealPlace(Workbench& bench, const document::Problem& problem) {
    const syntax::Source& source = *bench.document.ast()->source;
    if (problem.file != source.name() || !problem.line)
        return bench.say(fmt::format("{}:{}: {}", problem.file, problem.line, problem.message), true);
    const std::string_view line = source.line(problem.line);
    const auto start = static_cast<uint32_t>(line.data() - source.text().data());
    const uint32_t begin = start + std::min<uint32_t>(problem.column - 1, static_cast<uint32_t>(line.size()));
    const uint32_t end =
        problem.endLine == problem.line ? start + problem.endColumn - 1 : start + static_cast<uint32_t>(line.size());
    bench.panels.reveal = {begin, std::max(begin, end)};
    bench.panels.showText = true;
}

void selectText(Workbench& bench, uint32_t offset) {
    if (!bench.shown() || !isCurrent(bench.document, *bench.shown())) return;
    const std::vector<derive::ShapeId> made = document::shapesAt(bench.shown()->model.derivation, offset);
    if (made.empty()) return;
    const auto present = std::find(made.begin(), made.end(), bench.selected());
    bench.select(present == made.end() || present + 1 == made.end() ? made.front() : present[1], true);
    if (made.size() > 1)
        bench.say(fmt::format("One of {} shapes that this text made; click again for the next", made.size()));
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
