#include "grammar/pipeline/section.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "grammar/pipeline/scene.h"
#include "modeler/field/section.h"

namespace sgm::pipeline {

double Section::offset_m(const Box3f& bounds) const {
    const double low = static_cast<double>(bounds.lo[axis]), high = static_cast<double>(bounds.hi[axis]);
    return isShare ? low + (high - low) * at : at;
}

bool Section::isBeside(const Box3f& bounds) const {
    const double place_m = offset_m(bounds);
    return place_m < static_cast<double>(bounds.lo[axis]) || place_m > static_cast<double>(bounds.hi[axis]);
}

Vec3d Section::normal() const {
    Vec3d normal{0, 0, 0};
    normal[axis] = leavesLow ? 1 : -1;
    return normal;
}

Result<Section> parseSection(const std::string& text) {
    Section section;
    size_t at = 0;
    if (!text.empty() && (text[0] == '-' || text[0] == '+')) section.leavesLow = text[at++] == '+';
    bool good = at + 2 < text.size() && text[at] >= 'x' && text[at] <= 'z' && text[at + 1] == '=';
    if (good) {
        section.axis = text[at] - 'x';
        const char* const end = text.data() + text.size();
        const auto [rest, error] = std::from_chars(text.data() + at + 2, end, section.at);
        const std::string_view unit(rest, static_cast<size_t>(end - rest));
        section.isShare = unit == "%";
        constexpr std::pair<std::string_view, double> units[] = {
            {"", 1}, {"m", 1}, {"cm", .01}, {"mm", .001}, {"%", .01}};
        const auto known = std::ranges::find(units, unit, [](const auto& of) { return of.first; });
        good = error == std::errc() && std::isfinite(section.at) && known != std::end(units);
        if (good) section.at *= known->second;
    }
    if (good) return section;
    return Error{Error::Kind::Usage,
                 fmt::format("--section {}: write AXIS=PLACE in metres or % of the model, as x=1.5 or y=50%; what lies "
                             "beyond is cut away, with --section=-x=1.5 what lies before",
                             text)};
}

Result<Model> makeModel(derive::Derivation derivation, const Section& section, Context& context) {
    if (const Status s = graftObjects(derivation, Objects::Grafted, {}, context); !s.ok()) return s.error();
    auto lowered = context.timed("lower", [&] { return lower::lower(derivation, context.progress, context.threads); });
    if (!lowered.ok()) return lowered.error();
    lower::Model& model = **lowered;
    const Box3f whole = model.field.bounds;
    const double offset_m = section.offset_m(whole);
    const Vec3d normal = section.normal();
    model.field = field::section(model.graph, model.field, normal, offset_m * normal[section.axis]);
    if (model.field.bounds.empty())
        return Error{
            Error::Kind::Usage,
            fmt::format("--section: nothing is left at {} = {:.4g} m: the model reaches from {:.4g} to {:.4g} m",
                        "xyz"[section.axis], offset_m, whole.lo[section.axis], whole.hi[section.axis])};
    eval::Tape tape =
        context.timed("compile", [&] { return eval::compile(model.graph, model.field, model.graph.constants()); });
    return Model{std::move(derivation), std::move(*lowered), std::move(tape), /*keepsAxes=*/true};
}

}  // namespace sgm::pipeline
