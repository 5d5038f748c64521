#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include "modeler/core/printable.h"
#include "modeler/plan/clipper_paths.h"
#include "modeler/plan/read_parts.h"
#include "modeler/plan/svg_path.h"

namespace sgm::plan {
namespace {

constexpr size_t deepest = 256, mostAttributes = 256;

/// One tag of XML.
struct Tag {
    std::string_view name;
    std::vector<std::pair<std::string_view, std::string_view>> attributes;
    bool closes = false, isWhole = false;  ///< </name>, <name/>
    size_t at = 0;                         ///< byte
    std::string_view attribute(std::string_view word) const {
        const auto found =
            std::find_if(attributes.begin(), attributes.end(), [&](const auto& a) { return a.first == word; });
        return found == attributes.end() ? std::string_view{} : found->second;
    }
};

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// The tags of a text, one after the other; comments, declarations and characters between are passed over.
class TagScanner {
public:
    explicit TagScanner(std::string_view text) : text_(text) {}

    /// The next tag; nothing at the end.
    Result<std::optional<Tag>> next() {
        for (;;) {
            at_ = text_.find('<', at_);
            if (at_ == text_.npos) return std::optional<Tag>{};
            if (starts("<!--")) {
                if (!skipBehind("-->")) return failed("a comment has no end");
            } else if (starts("<![CDATA[")) {
                if (!skipBehind("]]>")) return failed("characters have no end");
            } else if (starts("<!") || starts("<?")) {
                if (!skipBehind(">")) return failed("a declaration has no end");
            } else {
                return tag();
            }
        }
    }

private:
    bool starts(std::string_view with) const { return text_.substr(at_, with.size()) == with; }
    bool skipBehind(std::string_view end) {
        const size_t found = text_.find(end, at_);
        if (found == text_.npos) return false;
        at_ = found + end.size();
        return true;
    }
    void skipBlanks() {
        while (at_ < text_.size() && isBlank(text_[at_])) ++at_;
    }
    std::string_view word() {
        const size_t begin = at_;
        while (at_ < text_.size() && !isBlank(text_[at_]) && !std::strchr("=/>\"'<", text_[at_])) ++at_;
        return text_.substr(begin, at_ - begin);
    }
    static Error failed(std::string_view why) { return {Error::Kind::Input, std::string(why)}; }

    Result<std::optional<Tag>> tag() {
        Tag tag;
        tag.at = at_++;
        if (at_ < text_.size() && text_[at_] == '/') tag.closes = true, ++at_;
        tag.name = word();
        if (const size_t colon = tag.name.find(':'); colon != tag.name.npos) tag.name.remove_prefix(colon + 1);
        for (;;) {
            skipBlanks();
            if (at_ >= text_.size()) return failed("a tag has no end");
            if (text_[at_] == '>') return ++at_, std::optional<Tag>(std::move(tag));
            if (text_[at_] == '/') {
                tag.isWhole = true, ++at_;
                continue;
            }
            const std::string_view name = word();
            skipBlanks();
            if (name.empty() || at_ >= text_.size() || text_[at_] != '=')
                return failed("a tag has an attribute without value");
            ++at_;
            skipBlanks();
            if (at_ >= text_.size() || (text_[at_] != '"' && text_[at_] != '\''))
                return failed("an attribute's value is not in quotes");
            const size_t end = text_.find(text_[at_], at_ + 1);
            if (end == text_.npos) return failed("an attribute's value has no end");
            if (tag.attributes.size() == mostAttributes) return failed("a tag has too many attributes");
            tag.attributes.emplace_back(name, text_.substr(at_ + 1, end - at_ - 1));
            at_ = end + 1;
        }
    }

    std::string_view text_;
    size_t at_ = 0;
};

using Rings = std::vector<std::vector<Vec2>>;

double numberIn(const Tag& tag, std::string_view name) {
    std::string_view text = tag.attribute(name);
    while (!text.empty() && isBlank(text[0])) text.remove_prefix(1);
    return takeNumber(text).value_or(0);
}

/// The rings of path, polygon and rect, not yet transformed; none for other tags.
Result<Rings> ringsOf(const Tag& tag, size_t most) {
    if (tag.name == "path") return svgPath(tag.attribute("d"), most);
    if (tag.name == "polygon") {
        const auto numbers = svgNumbers(tag.attribute("points"), 2 * most);
        if (!numbers) return numbers.error();
        std::vector<Vec2> points;
        for (size_t i = 0; i + 1 < numbers->size(); i += 2) points.push_back({(*numbers)[i], (*numbers)[i + 1]});
        return points.size() < 3 ? Rings{} : Rings{points};
    }
    if (tag.name == "rect") {
        const double x = numberIn(tag, "x"), z = numberIn(tag, "y"), w = numberIn(tag, "width"),
                     h = numberIn(tag, "height");
        if (w > 0 && h > 0) return Rings{{{x, z}, {x + w, z}, {x + w, z + h}, {x, z + h}}};
    }
    return Rings{};
}

/// Rings as polygons with courts by turns; an outline alone keeps its points as they are.
Result<Footprint> footprintOf(const Rings& rings, const SvgMatrix& map, const Limits& limits) {
    LatticePaths paths;
    std::vector<Vec2> first;
    for (const auto& ring : rings) {
        LatticePath& path = paths.emplace_back();
        for (const Vec2 p : ring) {
            const Vec2 q = map(p);
            if (!(std::abs(q.x) <= limits.farthest_m && std::abs(q.z) <= limits.farthest_m))
                return Error{Error::Kind::Input, fmt::format("a point lies beyond {:.6g} m", limits.farthest_m)};
            path.push_back(latticePoint(q));
            if (paths.size() == 1) first.push_back(q);
        }
    }
    if (rings.size() == 1) return soundFootprint(plan::footprintOf(polygonOf(first)), limits);
    return soundFootprint(tidied(evenOddOf(paths)), limits);
}

/// What encloses a tag.
struct Level {
    std::string_view name;
    SvgMatrix map;
    bool isShown;
};

bool isHidden(std::string_view name) {
    for (const std::string_view hidden : {"defs", "clipPath", "mask", "symbol", "pattern", "marker"})
        if (name == hidden) return true;
    return false;
}

}  // namespace

Result<Features> readSvg(std::string_view bytes, const ReadLimits& limits, const Progress* progress) {
    if (bytes.size() > limits.mostBytes) return Error{Error::Kind::Budget, "it is too large"};
    TagScanner scanner(bytes);
    std::vector<Level> levels{{"", {}, true}};
    ReadBudget budget(limits);
    Features features;
    size_t counted = 0;
    uint64_t line = 1;
    for (;;) {
        if (cancelled(progress)) return cancelledError();
        auto next = scanner.next();
        if (!next) return damaged("behind line", line, next.error());
        if (!next.value()) break;
        const Tag& tag = **next;
        line += static_cast<uint64_t>(std::count(bytes.begin() + static_cast<ptrdiff_t>(counted),
                                                 bytes.begin() + static_cast<ptrdiff_t>(tag.at), '\n'));
        counted = tag.at;
        if (tag.closes) {
            if (levels.size() > 1 && levels.back().name == tag.name) levels.pop_back();
            continue;
        }
        const auto own = svgTransform(tag.attribute("transform"));
        if (!own) return damaged("line", line, own.error());
        const Level level{tag.name, levels.back().map * *own, levels.back().isShown && !isHidden(tag.name)};
        if (level.isShown) {
            const auto rings = ringsOf(tag, limits.mostPoints);
            if (!rings) return damaged("line", line, rings.error());
            if (!rings->empty()) {
                size_t points = 0;
                for (const auto& ring : *rings) points += ring.size();
                if (auto e = budget.addFeature()) return *e;
                if (auto e = budget.addPoints(points)) return *e;
                const auto sound = footprintOf(*rings, level.map, limits.footprint);
                if (!sound) return damaged("line", line, sound.error());
                Feature feature{shortened(printable(tag.attribute("id")), 256), *sound, {}, line};
                if (const auto word = tag.attribute("class"); !word.empty())
                    feature.properties.push_back({"class", shortened(printable(word), 4096)});
                features.list.push_back(std::move(feature));
            }
        }
        if (tag.isWhole) continue;
        if (levels.size() == deepest) return damaged("line", line, "groups nest too deep");
        levels.push_back(level);
    }
    if (features.list.empty()) return Error{Error::Kind::Input, "it has no outlines; path, polygon and rect are read"};
    return features;
}

}  // namespace sgm::plan
