// `split x { sizes: bodies }`: the parts of a scope cut along an axis.
#include <fmt/format.h>

#include <algorithm>

#include "grammar/rules/checker.h"
#include "grammar/rules/evaluate.h"

namespace sgm::rules {
namespace {

using Written = syntax::Expr;

bool isNegative(const Expr& size, const std::vector<Value>& defaults) {
    const auto value = fold(size, defaults);
    return value && value->num() < 0;
}

}  // namespace

/// One part, its body checked against the part's own scope.
Split::Part Checker::part(Place& place, const syntax::Case& written) {
    Split::Part out;
    out.span = written.span;
    place.enter("part");
    if (written.label) {
        out.floating = written.label->kind == Written::Kind::Floating;
        const Written& size = out.floating && !written.label->args.empty() ? written.label->args[0] : *written.label;
        out.size = expression(place, size, out.floating ? Want::Length : Want::Extent,
                              out.floating ? "what follows '~'" : "the size of a part");
        if (isNegative(out.size, defaults_)) diagnostics_.error(size.span, "the size of a part is no less than 0");
    } else if (!written.tag.empty()) {
        diagnostics_.error(written.tag.span, "tags belong to 'faces': a part of a split has a size",
                           "write '4m: …', '30%: …' or '~1: …'");
    }
    out.body = std::make_shared<Body>(written.body ? body(place, *written.body) : Body{});
    if (out.body->grows)
        diagnostics_.error(out.body->span, "a part begins with a shape: nothing stands in it yet that could grow",
                           "leave the operator out");
    return out;
}

/// `{ … }*`: `i` is the number of the repetition, from 1.
Split::Part Checker::repeatedParts(Place& place, const syntax::Case& written) {
    Split::Part out;
    out.span = written.span;
    const size_t outside = place.locals.size();
    out.local = place.frame++;
    place.locals.push_back({"i", out.local, Type::number(Unit::None, true)});
    for (const syntax::Case& c : written.cases) {
        if (c.repeated)
            diagnostics_.error(c.span, "what repeats can't hold another '{ … }*'", "split the part again instead");
        else
            out.repeated.push_back(part(place, c));
    }
    place.locals.resize(outside, Place::Local{{}, 0, Type::unknown()});
    return out;
}

/// The `split` that an element consists of; null where there is none or, with a message, where it stands beside a shape.
const syntax::Attribute* Checker::splitOf(const syntax::Element& written) {
    const bool alone = written.kind == syntax::Element::Kind::Shape && !written.solid;
    const syntax::Attribute* found = nullptr;
    for (const auto* list : {&written.before, &written.after})
        for (const syntax::Attribute& a : *list) {
            if (a.id != Operation::Id::Split) continue;
            found = &a;
            if (alone) continue;
            diagnostics_.error(a.name.span, "'split' cuts the scope itself: no shape stands beside it",
                               "write the shapes into its parts");
        }
    return alone ? found : nullptr;
}

std::shared_ptr<Split> Checker::parts(Place& place, const syntax::Attribute& written) {
    auto out = std::make_shared<Split>();
    out->span = written.span;
    const std::string& axis = written.args.empty() ? std::string("x") : written.args[0].text;
    out->axis = axis == "x" ? 0 : axis == "y" ? 1 : 2;
    for (const syntax::Case& c : written.cases)
        out->parts.push_back(c.repeated ? repeatedParts(place, c) : part(place, c));
    return out;
}

}  // namespace sgm::rules
