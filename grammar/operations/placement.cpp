// at, to, overlap, shift, on, by, blend, through: how a newcomer joins what stands (SG-M III-F, eq. 14 and 16).
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "grammar/derive/attribute_context.h"
#include "grammar/operations/operations.h"
#include "grammar/rules/make.h"
#include "grammar/rules/operation_checker.h"
#include "grammar/rules/words.h"

namespace sgm::operations {
namespace {

using derive::AttributeContext;
using rules::Attribute;
using rules::Element;
using rules::HostChoice;
using rules::JointChoice;
using rules::OperationChecker;
using rules::Want;
using syntax::ArgumentType;
using syntax::Operation;
using syntax::OperationArgument;
using syntax::Operator;
using Phase = Operation::Phase;
using Written = syntax::Expr;

constexpr double most_m = 1e6;

constexpr OperationArgument atArguments[] = {
    {"ours", ArgumentType::Joint,
     "our joint: a face, centre, a declared name, free(…) or the variable of 'for d in axes'; each(…): on every one of "
     "those faces of a block or roof: a word for edges (side, front, court, a tag), or corner, slope, eave, gable, "
     "apex, "
     "each(slope, front) those of such edges"}};
constexpr OperationArgument toArguments[] = {
    {"theirs", ArgumentType::Joint,
     "the newcomer's joint; the opposite face unless said; centre puts its centre on our joint"}};
constexpr OperationArgument overlapArguments[] = {
    {"share", ArgumentType::Number,
     "how far the newcomer moves inward along the joint: 0 touches, 1 puts its centre there"}};
constexpr OperationArgument shiftArguments[] = {
    {"shift", ArgumentType::Vector,
     "moves the mating point (S_J) along x, y, z of the matched scope: shares of the newcomer's half-size, or metres"}};
constexpr OperationArgument onArguments[] = {
    {"host", ArgumentType::Shape,
     "last: the shape that was placed last, of the same body too; any(d): one placed toward d in the "
     "step before; each(Name): all of that name; lot: behind 'place', the scope with its plan"}};
constexpr OperationArgument byArguments[] = {
    {"amount", ArgumentType::Number,
     "a of the morph (eq. 14): 0 keeps what stands, 1 gives the newcomer; .5 unless said"}};
constexpr OperationArgument throughArguments[] = {
    {"shape", ArgumentType::Symbol, "the nearest shape of that name above the matched one"}};
constexpr OperationArgument blendArguments[] = {
    {"radius", ArgumentType::Length, "metres over which the two surfaces blend; 0 keeps the edge sharp"}};

bool isCalled(const Written& e, std::string_view word) {
    return (e.kind == Written::Kind::Name || e.kind == Written::Kind::Call) && e.text == word;
}

/// The attribute alone, for `agree`: what it says stands in the element.
void note(OperationChecker& checker, const syntax::Attribute& written) {
    Attribute attribute;
    attribute.operation = written.operation;
    attribute.span = written.span;
    checker.add(std::move(attribute));
}

/// each(side), each(slope, front)
rules::FaceChoice readFaces(OperationChecker& checker, const Written& e) {
    rules::FaceChoice faces{rules::FaceChoice::Kind::Side, "side"};
    const bool words =
        std::all_of(e.args.begin(), e.args.end(), [](const Written& arg) { return arg.kind == Written::Kind::Name; });
    if (!words || e.args.empty() || e.args.size() > 2) {
        checker.error(e.span, "'each' takes the word of the faces to grow on, and maybe one for their edges",
                      "write 'each(side)', 'each(front)', 'each(corner)', 'each(slope)' or 'each(slope, front)'");
        return faces;
    }
    const auto end = std::end(rules::faceKinds);
    const auto kind =
        std::find_if(std::begin(rules::faceKinds), end, [&](const auto& k) { return k.first == e.args[0].text; });
    if (kind != end) faces.kind = kind->second;
    if (kind == end || e.args.size() == 2) faces.word = e.args.back().text;
    if (kind == end && e.args.size() == 2)
        checker.error(e.args[0].span, fmt::format("'{}' is no kind of face", e.args[0].text),
                      "before a word for edges stands side, corner, slope, eave, gable, apex, ridge, hip or valley");
    return faces;
}

JointChoice readJoints(OperationChecker& checker, const syntax::Attribute& written) {
    JointChoice choice;
    choice.span = written.span;
    checker.beginDraws(std::string(written.operation->name));
    const Written& e = written.args[0];
    choice.free = isCalled(e, "free");
    if (e.kind == Written::Kind::Call && e.text == "each")
        choice.each = readFaces(checker, e);
    else if (!choice.free)
        choice.joints.push_back(checker.joint(e));
    else
        for (const Written& candidate : e.args) choice.joints.push_back(checker.joint(candidate));
    return choice;
}

void checkAt(OperationChecker& checker, const syntax::Attribute& written) {
    note(checker, written);
    if (!written.args.empty()) checker.element().at = readJoints(checker, written);
}

void checkTo(OperationChecker& checker, const syntax::Attribute& written) {
    note(checker, written);
    if (written.args.empty()) return;
    JointChoice choice = readJoints(checker, written);
    if (choice.free || choice.each) {
        checker.error(written.args[0].span,
                      choice.free ? "the newcomer's joints are all free: name one"
                                  : "the newcomer comes with one of its joints: name it",
                      "write 'to centre' or 'to +y'");
        return;
    }
    checker.element().to = std::move(choice);
}

/// `each(Name)`: the symbol's index, or nothing after an error.
void readEach(OperationChecker& checker, const Written& e, HostChoice& host) {
    host.kind = HostChoice::Kind::Each;
    const bool named = e.args.size() == 1 && e.args[0].kind == Written::Kind::Name;
    const auto symbol = named ? checker.names().findSymbol(e.args[0].text) : std::nullopt;
    if (symbol)
        host.of = rules::makeConstant(e.span, rules::Value::number(*symbol));
    else if (named)
        checker.unknownName(e.args[0].span, e.args[0].text, fmt::format("no shape is called '{}'", e.args[0].text),
                            rules::nearestHint(e.args[0].text, checker.names().symbols()));
    else
        checker.error(e.span, "'each' takes the name of shapes", "write 'each(Cell)'");
}

void checkOn(OperationChecker& checker, const syntax::Attribute& written) {
    note(checker, written);
    if (written.args.empty()) return;
    checker.beginDraws("on");
    const Written& e = written.args[0];
    HostChoice host;
    host.span = written.span;
    if (isCalled(e, "lot")) {  // placeOf reads it from the attribute
        checker.find(on)->args.push_back(rules::makeConstant(e.span, rules::makeWord("lot")));
        return;
    }
    if (isCalled(e, "any")) {
        host.kind = HostChoice::Kind::Any;
        if (!checker.isInChain())
            checker.error(e.span, "'any(d)' draws among the shapes of a chain, and there is none here",
                          "give the rule a 'repeat'");
        if (e.args.size() == 1)
            host.of = checker.expression(e.args[0], Want::Axis, "'any'");
        else
            checker.error(e.span, "'any' takes one direction", "write 'any(+x)' or 'any(d)'");
    } else if (isCalled(e, "each")) {
        readEach(checker, e, host);
    } else if (!isCalled(e, "last") && e.kind != Written::Kind::Error) {
        checker.error(e.span,
                      fmt::format("'on' takes 'last', 'any(d)', 'each(Name)' or 'lot', not '{}'", e.span.text()));
    }
    checker.element().on = std::move(host);
}

void needOperator(OperationChecker& checker, const Element& element, const Attribute& attribute) {
    if (element.op != Operator::None) return;
    const std::string_view name = attribute.operation->name;
    std::string fix = "put '+', '-', '&' or 'morph' before it";
    if (checker.isInPart())
        fix += name == "at" ? "; the first shape of a part is placed by 'move', as in 'cylinder move (50%, 0, 0)'"
                            : fmt::format("; the first shape of a part joins nothing: leave '{}' out there", name);
    checker.error(attribute.span,
                  fmt::format("'{}' joins a newcomer to what stands, but no operator joins this shape", name), fix);
}

void agreeOn(OperationChecker& checker, const Element& element, const Attribute& attribute) {
    if (!attribute.args.empty()) {
        const rules::Parts* parts = element.content.parts();
        if (!parts || parts->operation != &place)
            checker.error(attribute.span, "'on lot' says where 'place' puts an object, and there is none here",
                          "write 'place House on lot'");
        return;
    }
    const bool isRefused = element.on && element.on->kind == HostChoice::Kind::Any && !checker.isInChain();
    if (!isRefused) needOperator(checker, element, attribute);
}

void needJoint(OperationChecker& checker, const Element& element, const Attribute& attribute) {
    needOperator(checker, element, attribute);
    if (element.op != Operator::None && !element.at)
        checker.error(attribute.span, fmt::format("'{}' needs the joint it speaks of", attribute.operation->name),
                      "add 'at +x', 'at free(…)' or another joint of ours");
}

/// `to NAME` where the newcomer is known: it must have that joint.
void agreeTo(OperationChecker& checker, const Element& element, const Attribute& attribute) {
    needJoint(checker, element, attribute);
    if (!element.to || element.to->joints.size() != 1 || element.to->joints[0].value.kind != rules::Value::Kind::Word)
        return;
    std::vector<std::string> known;
    const rules::Solid* solid = element.content.solid();
    if (const rules::SymbolId id = element.content.symbol(); id != rules::none) {
        const rules::Symbol& symbol = checker.grammar().symbols[id];
        if (!symbol.terminal) return;
        for (const rules::Joint& joint : symbol.joints) known.push_back(joint.name);
        if (symbol.solid) solid = &*symbol.solid;
    } else if (!solid) {
        return;
    }
    if (solid && solid->primitive)
        for (const auto& joint : solid->primitive->joints) known.emplace_back(joint.name);
    const rules::Expr& joint = element.to->joints[0];
    const std::string& wanted = joint.value.text;
    if (std::find(known.begin(), known.end(), wanted) == known.end() && checker.names().isJoint(wanted))
        checker.error(joint.span, fmt::format("'{}' has no joint '{}'", element.label, wanted),
                      rules::nearestHint(wanted, known));
}

void agreeBy(OperationChecker& checker, const Element& element, const Attribute& attribute) {
    if (element.op != Operator::Morph)
        checker.error(attribute.span, "'by' says how far a morph goes, but this shape isn't joined by 'morph'",
                      "write 'morph' before the shape");
}

void agreeBlend(OperationChecker& checker, const Element& element, const Attribute& attribute) {
    needOperator(checker, element, attribute);
    if (element.op == Operator::Intersection)
        checker.error(attribute.span, "what is shared keeps its edge",
                      "leave 'blend' out, or cut with '-' what lies outside");
    if (element.op == Operator::Morph)
        checker.error(attribute.span, "a morph has no edge that could be blended", "leave 'blend' out");
}

void checkThrough(OperationChecker& checker, const syntax::Attribute& written) {
    note(checker, written);
    if (written.args.empty() || written.args[0].kind != Written::Kind::Name) return;
    const Written& e = written.args[0];
    if (const auto symbol = checker.names().findSymbol(e.text))
        checker.element().through = *symbol;
    else
        checker.unknownName(e.span, e.text, fmt::format("no shape is called '{}'", e.text),
                            rules::nearestHint(e.text, checker.names().symbols()));
}

void agreeThrough(OperationChecker& checker, const Element& element, const Attribute& attribute) {
    if (element.op != Operator::Difference)
        checker.error(attribute.span, "'through' says what a difference cuts, but this shape isn't joined by '-'",
                      "write '-' before the shape");
    if (element.on && element.on->kind == HostChoice::Kind::Each)
        checker.error(attribute.span, "'on each(…)' cuts the shapes that it stands on", "leave one of both out");
    for (const Attribute& a : element.attributes)
        if (a.operation->traits.namesValue)
            checker.error(a.span, fmt::format("'{}' hands nothing to a shape that cuts elsewhere", a.operation->name),
                          "say it of the shape that the cutter stands in");
}

void applyOverlap(AttributeContext& context, const Attribute& attribute) {
    context.out.overlap = context.number(attribute.args[0]);
}

/// S_J, the paper's shift of the joint: bare numbers and shares are of the newcomer's half-size.
void applyShift(AttributeContext& context, const Attribute& attribute) {
    const derive::Vector v = context.vector(attribute.args[0], true);
    Vec3d m;
    for (int i = 0; i < 3; ++i) m[i] = v.unit[i] == rules::Unit::Metre ? v.n[i] : v.n[i] * context.out.scope.half()[i];
    context.out.moved_m += context.place.scope.axes * m;
}

void applyBy(AttributeContext& context, const Attribute& attribute) {
    context.out.amount = context.numberWithin(attribute.args[0], 0, 1, "'by'");
}

void applyBlend(AttributeContext& context, const Attribute& attribute) {
    context.out.blend_m =
        context.numberWithin(attribute.args[0], 0, std::numeric_limits<double>::infinity(), "'blend'");
}

}  // namespace

constinit const Operation at{
    .name = "at",
    .doc = "Names our joint at which the newcomer is mated; points meet, directions oppose (eq. 16).",
    .example = "+ sphere at +x",
    .arguments = atArguments,
    .phase = Phase::Placement,
    .check = checkAt,
    .agree = needOperator,
};

constinit const Operation to{
    .name = "to",
    .doc = "Names the newcomer's joint that is mated with ours.",
    .example = "+ sphere at +x to centre",
    .arguments = toArguments,
    .phase = Phase::Placement,
    .check = checkTo,
    .agree = agreeTo,
};

constinit const Operation overlap{
    .name = "overlap",
    .doc = "Lets the newcomer reach into its host.",
    .example = "+ cube at +y overlap .2",
    .arguments = overlapArguments,
    .phase = Phase::Placement,
    .range = {-most_m, 1, "at most 1"},
    .agree = needJoint,
    .apply = applyOverlap,
};

constinit const Operation shift{
    .name = "shift",
    .doc = "Moves the mating point, the paper's joint shift S_J.",
    .example = "+ sphere at +x to centre shift -.3..0.3",
    .arguments = shiftArguments,
    .phase = Phase::Placement,
    .range = {-most_m, most_m, "at most 1000 km"},
    .agree = needOperator,
    .apply = applyShift,
};

constinit const Operation on{
    .name = "on",
    .doc = "Chooses the host among the shapes of a chain.",
    .example = "+ sphere on last at +y",
    .arguments = onArguments,
    .phase = Phase::Placement,
    .check = checkOn,
    .agree = agreeOn,
};

constinit const Operation by{
    .name = "by",
    .doc = "Says how far a morph goes.",
    .example = "morph torus by .2",
    .arguments = byArguments,
    .phase = Phase::Placement,
    .range = {0, 1, "0 … 1"},
    .agree = agreeBy,
    .apply = applyBy,
};

constinit const Operation blend{
    .name = "blend",
    .doc = "Blends the newcomer into what stands, or rounds the edge of a cut.",
    .example = "+ sphere at +x blend .25m",
    .arguments = blendArguments,
    .phase = Phase::Placement,
    .range = {0, most_m, "no less than 0"},
    .agree = agreeBlend,
    .apply = applyBlend,
};

constinit const Operation through{
    .name = "through",
    .doc =
        "Lets a difference cut a shape further up, as a window in a part of a front cuts the wall behind it: the "
        "nearest of that name, and what it held before the part that cuts.",
    .example = "- cube size (1m, 1.5m, 200%) through Mass",
    .arguments = throughArguments,
    .phase = Phase::Placement,
    .check = checkThrough,
    .agree = agreeThrough,
};

}  // namespace sgm::operations
