// Attributes: uses of the operation table, arguments checked as its rows ask.
#include <fmt/format.h>

#include <algorithm>

#include "grammar/rules/checker.h"
#include "grammar/rules/evaluate.h"
#include "grammar/rules/make.h"
#include "grammar/rules/words.h"

namespace sgm::rules {
namespace {

using Written = syntax::Expr;
using Id = Operation::Id;
using syntax::ArgumentType;

Want wantOf(const Operation& row, ArgumentType type) {
    switch (type) {
        case ArgumentType::Number:
            return Want::Number;
        case ArgumentType::Length:
            return Want::Length;
        case ArgumentType::Angle:
            return row.id == Id::Turn ? Want::Angles : Want::Angle;
        case ArgumentType::Size:
            return Want::Size;
        case ArgumentType::Vector:
            return Want::Offset;
        case ArgumentType::Color:
            return Want::Color;
        default:
            return Want::Anything;
    }
}

/// Legal numbers of operations, per component; bounds included.
struct Bounds {
    double lo, hi;
    std::string_view text;
};
std::optional<Bounds> boundsOf(Id id) {
    constexpr double big = 1e6;
    switch (id) {
        case Id::Size:
            return Bounds{1e-6, big, "at least 0.000001m, and at most 1000 km"};
        case Id::Move:
        case Id::Shift:
            return Bounds{-big, big, "at most 1000 km"};
        case Id::By:
        case Id::Rough:
        case Id::Metal:
            return Bounds{0, 1, "0 … 1"};
        case Id::Overlap:
            return Bounds{-big, 1, "at most 1"};
        case Id::Blend:
            return Bounds{0, big, "no less than 0"};
        default:
            return std::nullopt;
    }
}

/// Every constant part of an expression: both ends of a range or ramp, each component, each value to choose from.
template <class Visit>
void eachConstant(const Expr& e, const std::vector<Value>& params, Visit visit) {
    if (const auto value = fold(e, params)) return visit(e, *value);
    if (e.kind == Expr::Kind::Range || e.kind == Expr::Kind::Ramp || e.kind == Expr::Kind::Tuple)
        for (const Expr& arg : e.args) eachConstant(arg, params, visit);
    if (e.kind == Expr::Kind::Choose)
        for (size_t i = 1; i < e.args.size(); i += 2) eachConstant(e.args[i], params, visit);
}

bool isCalled(const Written& e, std::string_view word) {
    return (e.kind == Written::Kind::Name || e.kind == Written::Kind::Call) && e.text == word;
}

}  // namespace

/// A joint by name, or a value that is a direction: a local, or one that `with` sets.
Expr Checker::joint(Place& place, const Written& e) {
    const bool local =
        std::any_of(place.locals.begin(), place.locals.end(), [&](const auto& l) { return l.name == e.text; });
    const bool inherited = withNames_.contains(e.text) && !jointNames_.contains(e.text);
    if (e.kind == Written::Kind::Name && axisNumber(e.text) < 0 && !local && !inherited) {
        Expr word = makeConstant(e.span, makeWord(e.text));
        if (jointNames_.contains(e.text)) return word;
        std::vector<std::string> known(jointNames_.begin(), jointNames_.end());
        for (const auto& l : place.locals) known.push_back(l.name);
        std::string mend = nearest(e.text, known);
        if (mend.empty() && (e.text == "x" || e.text == "y" || e.text == "z"))
            mend = fmt::format("write '+{0}' or '-{0}'", e.text);
        unknown(e.span, e.text, fmt::format("unknown joint '{}'", e.text), std::move(mend));
        return word;
    }
    if (e.kind != Written::Kind::Choose) return expression(place, e, Want::Axis, "a joint");
    Expr chosen = chance(place, e);
    for (size_t i = 0; i + 1 < e.args.size(); i += 2) {
        chosen.args.push_back(weight(place, e.args[i]));
        chosen.args.push_back(joint(place, e.args[i + 1]));
    }
    return chosen;
}

void Checker::jointArgument(Place& place, const Written& e, Attribute& out) {
    if (!isCalled(e, "free")) {
        out.joints.push_back(joint(place, e));
        return;
    }
    out.free = true;
    if (out.id == Id::To)
        diagnostics_.error(e.span, "the newcomer's joints are all free: name one", "write 'to centre' or 'to +y'");
    for (const Written& candidate : e.args) out.joints.push_back(joint(place, candidate));
}

void Checker::hostArgument(Place& place, const Written& e, Attribute& out) {
    const bool chain = place.where == Place::Where::Chain;
    if (isCalled(e, "last")) {
        out.host = Attribute::Host::Last;
        if (!chain && place.where != Place::Where::Finally)
            diagnostics_.error(e.span, "'last' is the newest shape of a chain, and there is none here",
                               "give the rule a 'repeat'");
        return;
    }
    if (isCalled(e, "any")) {
        out.host = Attribute::Host::Any;
        if (!chain)
            diagnostics_.error(e.span, "'any(d)' draws among the shapes of a chain, and there is none here",
                               "give the rule a 'repeat'");
        if (e.args.size() == 1) {
            out.args.push_back(expression(place, e.args[0], Want::Axis, "'any'"));
            return;
        }
        diagnostics_.error(e.span, "'any' takes one direction", "write 'any(+x)' or 'any(d)'");
        return;
    }
    if (isCalled(e, "each")) {
        out.host = Attribute::Host::Each;
        const bool named = e.args.size() == 1 && e.args[0].kind == Written::Kind::Name;
        const auto symbol = named ? symbols_.find(e.args[0].text) : symbols_.end();
        if (symbol != symbols_.end()) out.args.push_back(makeConstant(e.span, Value::number(symbol->second)));
        else if (named) unknown(e.args[0].span, e.args[0].text, fmt::format("no shape is called '{}'", e.args[0].text), nearest(e.args[0].text, symbolNames(false)));
        else diagnostics_.error(e.span, "'each' takes the name of shapes", "write 'each(Cell)'");
        return;
    }
    if (e.kind != Written::Kind::Error)
        diagnostics_.error(e.span, fmt::format("'on' takes 'last', 'any(d)' or 'each(Name)', not '{}'", e.span.text()));
}

void Checker::noiseArgument(Place& place, const Written& e, Attribute& out) {
    const bool billow = isCalled(e, "billow");
    out.fbm = isCalled(e, "fbm");
    if (e.kind != Written::Kind::Call || !(billow || out.fbm)) {
        if (e.kind != Written::Kind::Error)
            diagnostics_.error(
                e.span,
                fmt::format(
                    "'displace' takes billow(amplitude, frequency) or fbm(amplitude, frequency, octaves), not '{}'",
                    e.span.text()));
        return;
    }
    if (e.args.size() < 2 || e.args.size() > 3) {
        diagnostics_.error(e.span,
                           fmt::format("'{}' takes an amplitude, a frequency and maybe octaves, but {} {} given",
                                       e.text, e.args.size(), e.args.size() == 1 ? "is" : "are"),
                           fmt::format("write '{}(.05m, 2.2/m)'", e.text));
        return;
    }
    out.args.push_back(expression(place, e.args[0], Want::Length, fmt::format("the amplitude of '{}'", e.text)));
    out.args.push_back(expression(place, e.args[1], Want::Frequency, fmt::format("the frequency of '{}'", e.text)));
    Expr octaves = makeConstant(e.span, makeWhole(out.fbm ? 3 : 2));
    if (e.args.size() == 3)
        octaves = expression(place, e.args[2], Want::Count, fmt::format("the octaves of '{}'", e.text));
    if (const auto n = fold(octaves, defaults_); n && (n->num() < 1 || n->num() > 8))
        diagnostics_.error(octaves.span, fmt::format("noise has 1 … 8 octaves, not {}", toText(*n)));
    out.args.push_back(std::move(octaves));
}

void Checker::withArguments(Place& place, const syntax::Attribute& written, Attribute& out) {
    if (written.args.size() != 2) return;
    Expr word = makeConstant(written.args[0].span, makeWord(written.args[0].text));
    if (params_.contains(word.value.text))
        diagnostics_.error(word.span,
                           fmt::format("'{}' is a parameter: a shape's own value needs another name", word.value.text));
    else if (isTaken(word.value.text))
        diagnostics_.error(word.span,
                           fmt::format("'{}' is a word of the language and can't name a value", word.value.text));
    place.enter("with " + word.value.text);
    out.args.push_back(std::move(word));
    out.args.push_back(expression(place, written.args[1], Want::Anything, "'with'"));
}

/// Numbers that no derivation could use, found among the constant parts.
void Checker::sensible(const Attribute& attribute) {
    const auto bounds = boundsOf(attribute.id);
    if (!bounds) return;
    const std::string_view name = syntax::operations()[static_cast<size_t>(attribute.id)].name;
    for (const Expr& arg : attribute.args) {
        bool said = false;
        eachConstant(arg, defaults_, [&](const Expr& e, const Value& v) {
            for (size_t i = 0; i < v.count && !said && (v.kind == Value::Kind::Number || v.kind == Value::Kind::Vector);
                 ++i)
                if (!(v.n[i] >= bounds->lo && v.n[i] <= bounds->hi)) {
                    said = true;
                    diagnostics_.error(e.span,
                                       fmt::format("'{}' is {}, but must be {}", name, toText(v), bounds->text));
                }
        });
    }
}

Attribute Checker::attribute(Place& place, const syntax::Attribute& written) {
    const Operation& row = syntax::operations()[static_cast<size_t>(written.id)];
    Attribute out;
    out.id = written.id;
    out.span = written.span;
    place.enter(std::string(row.name));
    if (row.id == Id::With) {
        withArguments(place, written, out);
        return out;
    }
    if (row.id == Id::Clad) {
        clad(place, written, out);
        return out;
    }
    for (size_t i = 0; i < written.args.size() && i < row.arguments.size(); ++i) {
        const Written& arg = written.args[i];
        switch (row.arguments[i].type) {
            case ArgumentType::Joint:
                jointArgument(place, arg, out);
                break;
            case ArgumentType::Shape:
                hostArgument(place, arg, out);
                break;
            case ArgumentType::Noise:
                noiseArgument(place, arg, out);
                break;
            case ArgumentType::Name:
            case ArgumentType::Axis:
            case ArgumentType::Solid:
                out.args.push_back(makeConstant(arg.span, makeWord(arg.text)));
                break;
            default:
                out.args.push_back(
                    expression(place, arg, wantOf(row, row.arguments[i].type), fmt::format("'{}'", row.name)));
        }
    }
    sensible(out);
    return out;
}

std::vector<Attribute> Checker::attributes(Place& place, const std::vector<syntax::Attribute>& written) {
    std::vector<Attribute> result;
    std::vector<Id> seen;
    std::vector<const syntax::Attribute*> fittings;  // of a cladding, which may stand after them
    bool refused = false;
    for (const syntax::Attribute& a : written) {
        if (!syntax::operations()[static_cast<size_t>(a.id)].supported) {
            if (!refused) diagnostics_.error(a.name.span, fmt::format("'{}' is not supported yet", a.name.text));
            refused = true;  // what follows it is mostly its own
            continue;
        }
        const bool many = a.id == Id::Tag || a.id == Id::With || a.id == Id::Displace;
        if (!many && std::find(seen.begin(), seen.end(), a.id) != seen.end())
            diagnostics_.error(a.span, fmt::format("'{}' is given twice", a.name.text), "say it once");
        seen.push_back(a.id);
        if (a.id == Id::Thickness || a.id == Id::Tile || a.id == Id::Mirror) fittings.push_back(&a);
        else result.push_back(attribute(place, a));
    }
    const auto clad = std::find_if(result.begin(), result.end(), [](const Attribute& a) { return a.id == Id::Clad; });
    for (const syntax::Attribute* a : fittings) fit(place, *a, clad == result.end() ? nullptr : &*clad);
    return result;
}

}  // namespace sgm::rules
