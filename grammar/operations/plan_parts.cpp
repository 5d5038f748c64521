#include "grammar/operations/plan_parts.h"
#include "grammar/rules/words.h"

#include <fmt/format.h>

#include <algorithm>

namespace sgm::operations {

using Part = rules::Parts::Part;

std::vector<Part> checkWordParts(rules::OperationChecker& checker, const syntax::Attribute& written,
                                 std::span<const std::string_view> words) {
    std::vector<Part> parts;
    for (const syntax::Case& c : written.cases) {
        const bool isWord = c.label && c.label->kind == syntax::Expr::Kind::Name;
        if (c.repeated || !isWord || std::find(words.begin(), words.end(), c.label->text) == words.end()) {
            const std::vector<std::string> known(words.begin(), words.end());
            const std::string near = isWord ? rules::nearestHint(c.label->text, known) : std::string();
            checker.error(
                c.label ? c.label->span : c.span,
                fmt::format("a part of '{}' is called by one of {}", written.operation->name, fmt::join(words, ", ")),
                near);
            continue;
        }
        Part& part = parts.emplace_back();
        part.span = c.span;
        part.label = c.label->text;
        checker.beginDraws("part");
        part.body = c.body ? checker.partBody(*c.body) : std::make_shared<const rules::Body>();
        const auto twice =
            std::count_if(parts.begin(), parts.end(), [&](const Part& p) { return p.label == part.label; });
        if (twice > 1)
            checker.error(c.span, fmt::format("there is already a part '{}'", part.label), "leave one of them out");
    }
    return parts;
}

const Part* findPart(const rules::Parts& parts, std::string_view label) {
    const auto part =
        std::find_if(parts.parts.begin(), parts.parts.end(), [&](const Part& p) { return p.label == label; });
    return part == parts.parts.end() ? nullptr : &*part;
}

}  // namespace sgm::operations
