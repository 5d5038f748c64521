#include "grammar/derive/way.h"

#include <algorithm>
#include <utility>

namespace sgm::derive {

std::string wayText(const rules::Grammar& grammar, const std::string& name,
                    std::span<const rules::Derive::Step> steps) {
    constexpr size_t widest = 100;
    std::string text, line = "derive " + name + ":";
    for (size_t i = 0; i < steps.size(); ++i) {
        std::string step = i == 0 ? " " : " => ";
        step += grammar.rules[steps[i].rule].name;
        if (!steps[i].place.empty()) step += " at " + steps[i].place;
        if (i > 0 && line.size() + step.size() > widest) text += std::exchange(line, " ") + '\n';
        line += step;
    }
    return text + line + '\n';
}

std::string fileWithWay(const rules::Grammar& grammar, const std::string& name, const std::string& line) {
    const syntax::Source& file = *grammar.sources[0];
    const std::string_view text = file.text();
    size_t after = text.size();
    bool follows = false;
    for (const rules::Derive& d : grammar.derives) {
        if (d.span.source != &file) continue;
        if (d.name == name)
            return std::string(text.substr(0, d.span.begin)) + line.substr(0, line.size() - 1) +
                   std::string(text.substr(d.span.end));
        // What follows on the same line, a comment, stays there.
        after = std::min(text.find('\n', d.span.end), text.size() - 1) + 1;
        follows = true;
    }
    std::string result(text.substr(0, after));
    if (!result.empty() && result.back() != '\n') result += '\n';
    if (!follows) result += '\n';
    return result + line + std::string(text.substr(after));
}

}  // namespace sgm::derive
