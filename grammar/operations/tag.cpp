// tag: names edges of a plan.
#include <fmt/format.h>

#include "grammar/derive/attribute_context.h"
#include "grammar/derive/builder.h"
#include "grammar/derive/selections.h"
#include "grammar/operations/operations.h"
#include "grammar/rules/operation_checker.h"
#include "modeler/plan/edge_words.h"

namespace sgm::operations {
namespace {

using derive::AttributeContext;
using rules::Attribute;
using syntax::ArgumentType;

constexpr syntax::OperationArgument tagArguments[] = {
    {"name", ArgumentType::Name, "a word that edges are called by from here on"},
    {"edges", ArgumentType::Name, "which of them: front, a tag that they have …; all where it isn't said", true,
     "along"}};

void checkTag(rules::OperationChecker& checker, const syntax::Attribute& written) {
    for (const std::string_view word : {"top", "bottom", "shared"})
        if (!written.args.empty() && written.args[0].text == word)
            checker.error(written.args[0].span, fmt::format("'{}' is a word for other faces than those of edges", word),
                          "give the edges a word of their own, as 'street'");
    if (!written.args.empty() && plan::isCommonEdgeWord(written.args[0].text))
        checker.error(written.args[0].span,
                      fmt::format("edges are called '{}' by where they look or what made them", written.args[0].text),
                      "give them a word of their own, as 'street'");
    checker.checkArguments(written);
}

/// Calls `visit` for every edge of the footprint, in the order of edgesOf().
template <class Visit>
void eachEdge(plan::Footprint& footprint, Visit visit) {
    for (plan::Polygon& polygon : footprint.polygons) {
        for (plan::Edge& edge : polygon.outer.edges) visit(edge);
        for (plan::Ring& court : polygon.courts)
            for (plan::Edge& edge : court.edges) visit(edge);
    }
}

void applyTag(AttributeContext& context, const Attribute& attribute) {
    const std::string& word = attribute.args[0].value.text;
    context.out.extras.tags.push_back(word);
    plan::Footprint footprint = context.footprint();
    const std::string along = attribute.args.size() > 1 ? attribute.args[1].value.text : "side";
    const std::vector<plan::PlacedEdge> edges = plan::edgesOf(footprint);
    size_t i = 0;
    bool any = false;
    eachEdge(footprint, [&](plan::Edge& edge) {
        const plan::PlacedEdge& placed = edges[i++];
        if (!plan::isEdgeCalled(footprint, placed, along)) return;
        any = true;
        if (plan::isEdgeCalled(footprint, placed, word)) return;
        const std::string before = footprint.tags[edge.tag];
        edge.tag = footprint.tag(before.empty() ? word : before + " " + word);
    });
    derive::select(*context.place.builder, attribute.span, any,
                   [&] { return derive::noEdgeCalled(along, footprint, fmt::format("so none is called '{}'", word)); });
    if (any) context.setFootprint(std::move(footprint), attribute.span);
}

}  // namespace

constinit const syntax::Operation tag{
    .name = "tag",
    .doc =
        "Names the edges of the footprint, all or those called by a word: faces, setback, lots, split along and each "
        "ask "
        "for it, beside the words that edges have already. A scope without a footprint has the edges of its rectangle.",
    .example = "footprint rect(30, 20) tag street along front setback edges(street: 5m, rest: 2m) block",
    .arguments = tagArguments,
    .traits = {.repeatable = true, .beforeShape = true},
    .check = checkTag,
    .apply = applyTag,
};

}  // namespace sgm::operations
