// `clad PATTERN thickness … tile … mirror …`: cladding of whatever a shape holds.
#include <fmt/format.h>

#include "grammar/rules/checker.h"
#include "grammar/rules/evaluate.h"
#include "modeler/field/facade.h"

namespace sgm::rules {
namespace {

using Id = Operation::Id;
using Parameter = field::FacadeParameter;

const field::Primitive& ornamentRow() { return *field::findPrimitive("ornament"); }

/// A kifs as an ornament: the same fractal, mapped by the defaults. Its last fold and bailout must keep it a distance.
bool becomeOrnament(Solid& solid, const std::vector<Value>& defaults) {
    constexpr auto shared = static_cast<size_t>(Parameter::Bay);
    for (size_t i = shared; i < solid.args.size(); ++i) {
        const auto value = fold(solid.args[i], defaults);
        if (!value || value->num() != 0) return false;
    }
    return true;
}

/// What an attribute beside `clad` sets.
struct Fitting {
    Parameter first;
    size_t count;  ///< parameters, one a component; 0: the whole vector is one parameter
    std::string_view wants, mend;
};
Fitting fittingOf(Id id) {
    if (id == Id::Thickness) return {Parameter::Wall, 2, "a length, or two: of walls and below the top", "write 'thickness .4m' or 'thickness (.4m, .1m)'"};
    if (id == Id::Tile) return {Parameter::Bay, 2, "two lengths: along and up", "write 'tile (6m, 3m)'"};
    return {Parameter::Mirror, 0, "three plain numbers", "write 'mirror (.25, .125, .4)'"};
}

Expr component(Expr vector, size_t i) {
    Expr e;
    e.kind = Expr::Kind::Element;
    e.span = vector.span;
    Expr at = makeConstant(vector.span, makeWhole(static_cast<double>(i)));
    e.args = {std::move(vector), std::move(at)};
    return e;
}

}  // namespace

void Checker::clad(Place& place, const syntax::Attribute& written, Attribute& out) {
    if (written.args.empty()) return;
    const syntax::Expr& e = written.args[0];
    const size_t before = diagnostics_.all().size();
    Solid given = solid(place, e);
    if (diagnostics_.all().size() != before || excused_.contains(e.text)) return;
    const auto named = symbols_.find(e.text);
    if (e.kind == syntax::Expr::Kind::Name && named != symbols_.end()) out.symbol = named->second;
    const bool fractal = given.primitive && given.primitive->name == "kifs";
    if (!fractal && given.primitive != &ornamentRow()) {
        diagnostics_.error(e.span, fmt::format("'clad' takes an ornament or a kifs, not '{}'", e.span.text()),
                           "write 'clad ornament(…)', or name a terminal that is one");
        return;
    }
    if (fractal && !becomeOrnament(given, defaults_)) {
        diagnostics_.error(e.span, "a kifs with a jump or a bailout has no distance to clad with",
                           "leave 'form' and 'bailout' out");
        return;
    }
    out.pattern = std::make_shared<Solid>(fractal ? solidOfRow(e.span, ornamentRow()) : given);
    if (fractal)
        std::copy_n(given.args.begin(), static_cast<size_t>(Parameter::Bay), out.pattern->args.begin());
}

void Checker::fit(Place& place, const syntax::Attribute& written, Attribute* clad) {
    if (!clad) {
        diagnostics_.error(written.span, fmt::format("'{}' says how a cladding lies, but there is none", written.name.text),
                           "put 'clad ornament(…)' before it");
        return;
    }
    if (written.args.empty()) return;
    place.enter(written.name.text);
    Typed value = expression(place, written.args[0]);
    const Fitting f = fittingOf(written.id);
    const Type& t = value.type;
    const bool one = t.like.kind == Value::Kind::Number;
    const size_t given = one ? 1 : t.like.count;
    bool good = !t.known || (t.numeric() && given == (f.count == 0 ? 3 : 2)) || (t.known && one && written.id == Id::Thickness);
    for (size_t i = 0; t.known && i < given; ++i)
        good = good && (t.like.units[i] == Unit::None || t.like.units[i] == (f.count == 0 ? Unit::Share : Unit::Metre));
    if (!good) {
        diagnostics_.error(written.args[0].span, fmt::format("'{}' takes {}, not {}", written.name.text, f.wants, describe(t)), std::string(f.mend));
        return;
    }
    if (!clad->pattern) return;
    const auto set = [&](size_t index, Expr e) {
        inRange(e, ornamentRow(), index);
        clad->pattern->args[index] = std::move(e);
    };
    const auto first = static_cast<size_t>(f.first);
    if (f.count == 0 || one) set(first, std::move(value.expr));
    else
        for (size_t i = 0; i < f.count; ++i) set(first + i, component(value.expr, i));
}

}  // namespace sgm::rules
