// Edits of the parts of a block: what stands between the bars of a split, of faces or of a choice.
#include <fmt/format.h>

#include <algorithm>

#include "viewer/document/nodes.h"

namespace sgm::document::edits {
namespace {

using Cases = std::vector<Case>;

/// The list that `part` is in, of `cases` and the groups in it.
const Cases* listOf(const Cases& cases, const Case& part) {
    for (const Case& c : cases) {
        if (&c == &part) return &cases;
        if (const Cases* found = listOf(c.cases, part)) return found;
    }
    return nullptr;
}

/// A part among the others of its block.
struct PartPlace {
    const Cases* block = nullptr;  ///< null: not in this tree
    size_t index = 0;

    bool first() const { return index == 0; }
    bool last() const { return index + 1 == block->size(); }
};

PartPlace placeOf(const Ast& ast, const Case& part) {
    PartPlace place;
    place.block = partsAround(ast, part);
    if (place.block) place.index = static_cast<size_t>(&part - place.block->data());
    return place;
}

Error partIsGone() { return refused("this part is not in the text any more"); }

/// The bar before a part that isn't the first, the one behind a part that isn't the last.
syntax::SourceSpan barBefore(const Ast& ast, const Case& part) {
    return {ast.source.get(), beginBefore(ast, part.span.begin), endBefore(ast, part.span.begin)};
}
syntax::SourceSpan barBehind(const Ast& ast, const Case& part) { return tokenFrom(ast, part.span.end); }

std::string indentAt(std::string_view text, uint32_t offset) {
    const uint32_t begin = lineBegin(text, offset);
    return std::string(text.substr(begin, offset - begin));
}

/// `text` behind a part, as the bars of the block stand: leading their lines, ending them, or all in one line.
Edit putBehind(const Ast& ast, const Case& part, std::string_view text) {
    const PartPlace place = placeOf(ast, part);
    if (!place.block) return partIsGone();
    const std::string_view all = ast.source->text();
    const uint32_t end = part.span.end;
    std::string head = " | ";
    uint32_t at = end;
    if (place.block->size() > 1) {
        const auto bar = place.first() ? barBehind(ast, part) : barBefore(ast, part);
        if (beginsLine(all, bar.begin)) {
            head = "\n" + indentAt(all, bar.begin) + "| ";
            if (endsLine(all, end)) at = lineEnd(all, end);
        } else if (beginsLine(all, part.span.begin) && lineBegin(all, bar.begin) != lineBegin(all, end)) {
            head = " |\n" + indentAt(all, part.span.begin);
        } else if (place.first() && beginsLine(all, (*place.block)[1].span.begin)) {
            head = " |\n" + indentAt(all, (*place.block)[1].span.begin);
        }
    }
    const auto node = static_cast<uint32_t>(head.size());
    return tried(ast, {at, at, head + std::string(text), node});
}

}  // namespace

const Cases* partsAround(const Ast& ast, const Case& part) {
    const Cases* found = nullptr;
    forBodies(ast, [&](const syntax::Body& body) {
        const auto look = [&](const Cases& cases) {
            if (!found) found = listOf(cases, part);
        };
        for (const auto& chain : body.siblings)
            for (const Element& element : chain) {
                look(element.cases);
                for (const auto* attributes : {&element.before, &element.after})
                    for (const syntax::Attribute& attribute : *attributes) look(attribute.cases);
            }
    });
    return found;
}

std::string samplePart(const syntax::Attribute* attribute) {
    const std::string_view label = attribute ? attribute->operation->block.label : "1";
    return fmt::format("{}: cube", label);
}

Edit addPart(const Ast& ast, const Case& after, std::string_view text) { return putBehind(ast, after, text); }

Edit removePart(const Ast& ast, const Case& part) {
    const PartPlace place = placeOf(ast, part);
    if (!place.block) return partIsGone();
    if (place.block->size() == 1) return refused("it is the only part: delete what it belongs to");
    const std::string_view text = ast.source->text();
    const TextEdit gone = removal(text, part.span.begin, part.span.end);
    const auto with = [&](const syntax::SourceSpan& bar) -> TextEdit {
        const uint32_t begin = std::min(bar.begin, part.span.begin), end = std::max(bar.end, part.span.end);
        const uint32_t from = std::min(bar.end, part.span.end), to = std::max(bar.begin, part.span.begin);
        if (text.substr(from, to - from).find_first_not_of(" \t") == std::string_view::npos)
            return removal(text, begin, end);
        return merged(text, {gone, removal(text, bar.begin, bar.end)});
    };
    // A bar that leads the part's line goes with it, else the one behind it.
    const bool before = place.last() || (!place.first() && beginsLine(text, barBefore(ast, part).begin));
    return tried(ast, with(before ? barBefore(ast, part) : barBehind(ast, part)));
}

Edit duplicatePart(const Ast& ast, const Case& part) { return putBehind(ast, part, part.span.text()); }

Edit movePart(const Ast& ast, const Case& part, int by) {
    const PartPlace place = placeOf(ast, part);
    if (!place.block) return partIsGone();
    if (by < 0 ? place.first() : place.last()) return refused("there is no part to change places with");
    const size_t at = by < 0 ? place.index - 1 : place.index;
    const Case &first = (*place.block)[at], &second = (*place.block)[at + 1];
    const std::string_view between = ast.source->text().substr(first.span.end, second.span.begin - first.span.end);
    TextEdit edit{first.span.begin, second.span.end, std::string(second.span.text())};
    edit.replacement += between;
    edit.node = by < 0 ? 0 : static_cast<uint32_t>(edit.replacement.size());
    edit.replacement += first.span.text();
    return tried(ast, std::move(edit));
}

Edit setPartLabel(const Ast& ast, const Case& part, std::string_view label) {
    if (part.repeated || !part.body) return refused("this part has no label");
    const uint32_t colon = beginBefore(ast, tokenFrom(ast, part.body->span.begin).begin);
    return tried(ast, {part.span.begin, endBefore(ast, colon), std::string(label)});
}

Edit setPartTimes(const Ast& ast, const Case& part, std::string_view times) {
    if (!part.repeated) return refused("only a part in braces repeats");
    const uint32_t brace =
        part.times ? endBefore(ast, part.times->span.begin) : endBefore(ast, beginBefore(ast, part.span.end));
    std::string written(times);
    if (written != "*" && written != "+") {
        const auto count = asArgument(times);
        if (!count.ok()) return count.error();
        written = *count;
    }
    return tried(ast, {brace, part.span.end, written});
}

std::span<const Division> divisions() {
    static constexpr Division all[] = {
        {"split", "split x { ~1: S | ~1: S }", "Cuts the scope along an axis into parts of given sizes"},
        {"split { }*", "split x { { ~1m: S }* }", "Cuts the scope into parts of one size, as many as fit"},
        {"faces", "faces .3m { side: S | rest: nil }",
         "Plates along the sides of a block, each with a body of its own"},
        {"row", "row 3 along x { S }", "Copies in a row"},
        {"around", "around 6 radius 2m { S }", "Copies around the middle"},
        {"mirror { }", "mirror x { S }", "It and its reflection"},
    };
    return all;
}

Edit divide(const Ast& ast, const Element& element, std::string_view name) {
    const auto all = divisions();
    const auto division = std::find_if(all.begin(), all.end(), [&](const Division& d) { return d.name == name; });
    if (division == all.end()) return refused(fmt::format("'{}' doesn't divide a shape", name));
    if (!element.solid) return refused("there is no shape that could be divided");
    if (!element.live.empty())
        return refused(fmt::format("'{}' goes on with it: divide it in its rule", element.live.text));
    std::string written;
    for (const char c : std::string_view(division->text))
        c == 'S' ? written += element.solid->span.text() : written += c;
    const syntax::SourceSpan solid = element.solid->span;
    if (element.after.empty()) return tried(ast, {solid.begin, solid.end, std::move(written), 0});
    // The attributes go before it: all of them then stand before no shape.
    const uint32_t next = tokenFrom(ast, solid.end).begin;
    return tried(ast, merged(ast.source->text(),
                             {{solid.begin, next, {}}, {element.span.end, element.span.end, " " + written, 1}}));
}

}  // namespace sgm::document::edits
