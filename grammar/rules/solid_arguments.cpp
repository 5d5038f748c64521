#include "grammar/rules/solid_arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sgm::rules {
namespace {

using field::ParameterKind;
using Written = syntax::Expr;

bool hasName(const Written& e, size_t i) { return i < e.argNames.size() && !e.argNames[i].empty(); }

}  // namespace

bool refuseExchanged(CheckContext& ctx, const Written& e, const field::Primitive& row) {
    const size_t count = std::min(e.args.size(), row.parameters.size());
    const auto stands = [&](size_t i, ParameterKind kind, bool isAngle) {
        const Written& arg = e.args[i];
        return row.parameters[i].kind == kind && !hasName(e, i) && arg.kind == Written::Kind::Number &&
               !arg.unit.empty() && arg.unit != "%" && (arg.unit == "deg") == isAngle;
    };
    for (size_t angle = 0; angle < count; ++angle)
        for (size_t length = 0; length < count; ++length) {
            if (!stands(angle, ParameterKind::Angle, false) || !stands(length, ParameterKind::Length, true)) continue;
            std::vector<std::string_view> texts;
            for (const Written& arg : e.args) texts.push_back(arg.span.text());
            std::swap(texts[angle], texts[length]);
            ctx.diagnostics.error(
                e.span,
                fmt::format("'{}' and '{}' of '{}' are exchanged", row.parameters[std::min(angle, length)].name,
                            row.parameters[std::max(angle, length)].name, row.name),
                fmt::format("write '{}({})'", row.name, fmt::join(texts, ", ")));
            return true;
        }
    return false;
}

bool refuseUnnamedBehindNamed(CheckContext& ctx, const Written& e, const field::Primitive& row) {
    bool isBehind = false;
    for (size_t i = 0; i < std::min(e.args.size(), row.parameters.size()); ++i) {
        isBehind |= hasName(e, i);
        if (!isBehind || hasName(e, i)) continue;
        const Written& arg = e.args[i];
        const ParameterKind kind = row.parameters[i].kind;
        const bool isTaken = std::ranges::count(e.argNames, row.parameters[i].name) > 0;
        const bool hasUnit = arg.kind == Written::Kind::Number && !arg.unit.empty() && arg.unit != "%";
        const bool isOther = hasUnit && ((kind == ParameterKind::Length && arg.unit == "deg") ||
                                         (kind == ParameterKind::Angle && arg.unit != "deg"));
        if (!isTaken && !isOther) continue;
        std::vector<std::string> first, then;
        for (size_t k = 0; k < e.args.size(); ++k)
            if (hasName(e, k))
                then.push_back(fmt::format("{}: {}", e.argNames[k], e.args[k].span.text()));
            else
                first.emplace_back(e.args[k].span.text());
        first.insert(first.end(), then.begin(), then.end());
        ctx.diagnostics.error(arg.span, "arguments without names come first",
                              fmt::format("write '{}({})'", row.name, fmt::join(first, ", ")));
        return true;
    }
    return false;
}

}  // namespace sgm::rules
