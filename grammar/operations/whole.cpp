// displace, report, with: what acts on all that a shape holds.
#include <fmt/format.h>

#include <cmath>

#include "grammar/derive/attribute_context.h"
#include "grammar/operations/operations.h"
#include "grammar/rules/make.h"
#include "grammar/rules/operation_checker.h"
#include "grammar/rules/words.h"

namespace sgm::operations {
namespace {

using derive::AttributeContext;
using rules::Attribute;
using rules::Expr;
using rules::OperationChecker;
using rules::Want;
using syntax::ArgumentType;
using syntax::Operation;
using syntax::OperationArgument;
using Phase = Operation::Phase;
using Written = syntax::Expr;

constexpr OperationArgument displaceArguments[] = {
    {"noise", ArgumentType::Noise, "billow(amplitude, frequency) or fbm(amplitude, frequency [, octaves])"}};
constexpr OperationArgument withArguments[] = {{"name", ArgumentType::Name, "the value's name, followed by '='"},
                                               {"value", ArgumentType::Number, "its value, of any type"}};

constexpr OperationArgument reportArguments[] = {{"name", ArgumentType::Name, "what is summed under this word"},
                                                 {"value", ArgumentType::Number, "the shape's number, of any unit"}};

/// Arguments of a checked `displace`.
enum : size_t { amplitudeAt, frequencyAt, octavesAt, fbmAt };

void checkDisplace(OperationChecker& checker, const syntax::Attribute& written) {
    if (written.args.empty()) return;
    const Written& e = written.args[0];
    const bool fbm = e.text == "fbm";
    if (e.kind != Written::Kind::Call || !(fbm || e.text == "billow")) {
        if (e.kind != Written::Kind::Error)
            checker.error(e.span,
                          fmt::format("'displace' takes billow(amplitude, frequency) or fbm(amplitude, frequency, "
                                      "octaves), not '{}'",
                                      e.span.text()));
        return;
    }
    if (e.args.size() < 2 || e.args.size() > 3) {
        checker.error(e.span,
                      fmt::format("'{}' takes an amplitude, a frequency and maybe octaves, but {} {} given", e.text,
                                  e.args.size(), e.args.size() == 1 ? "is" : "are"),
                      fmt::format("write '{}(.05m, 2.2/m)'", e.text));
        return;
    }
    Attribute out;
    out.operation = written.operation;
    out.span = written.span;
    checker.beginDraws("displace");
    out.args.push_back(checker.expression(e.args[0], Want::Length, fmt::format("the amplitude of '{}'", e.text)));
    out.args.push_back(checker.expression(e.args[1], Want::Frequency, fmt::format("the frequency of '{}'", e.text)));
    Expr octaves = rules::makeConstant(e.span, rules::makeWhole(fbm ? 3 : 2));
    if (e.args.size() == 3)
        octaves = checker.expression(e.args[2], Want::Count, fmt::format("the octaves of '{}'", e.text));
    if (const auto n = checker.atDefaults(octaves); n && (n->num() < 1 || n->num() > 8))
        checker.error(octaves.span, fmt::format("noise has 1 … 8 octaves, not {}", rules::toText(*n)));
    out.args.push_back(std::move(octaves));
    out.args.push_back(rules::makeConstant(e.span, rules::Value::boolean(fbm)));
    checker.add(std::move(out));
}

/// Refuses noise that is finer or higher than single precision tells places apart.
void applyDisplace(AttributeContext& context, const Attribute& attribute) {
    derive::Displacement noise;
    noise.fbm = attribute.args[fbmAt].value.truth();
    noise.amplitude_m = context.number(attribute.args[amplitudeAt]);
    noise.frequency = context.number(attribute.args[frequencyAt]);
    noise.octaves = static_cast<int>(context.numberWithin(attribute.args[octavesAt], 1, 8, "the number of octaves"));
    constexpr double finest_per_m = 1e5, highest_m = 1e6;
    if (!(std::abs(noise.amplitude_m) <= highest_m && std::abs(noise.frequency) <= finest_per_m))
        context.fail(
            fmt::format("noise is at most {:g} m high and has at most {:g} waves a metre", highest_m, finest_per_m),
            attribute.span);
    context.out.extras.displace.push_back(noise);
}

void checkWith(OperationChecker& checker, const syntax::Attribute& written) {
    if (written.args.size() != 2) return;
    Attribute out;
    out.operation = written.operation;
    out.span = written.span;
    Expr word = rules::makeConstant(written.args[0].span, rules::makeWord(written.args[0].text));
    const std::string& name = word.value.text;
    if (checker.names().isParameter(name))
        checker.error(word.span, fmt::format("'{}' is a parameter: a shape's own value needs another name", name));
    else if (rules::isTaken(name))
        checker.error(word.span, fmt::format("'{}' is a word of the language and can't name a value", name));
    checker.beginDraws("with " + name);
    out.args.push_back(std::move(word));
    out.args.push_back(checker.expression(written.args[1], Want::Anything, "'with'"));
    checker.add(std::move(out));
}

void applyWith(AttributeContext& context, const Attribute& attribute) {
    context.out.extras.values.emplace_back(attribute.args[0].value.text, context.evaluate(attribute.args[1]));
}

void checkReport(OperationChecker& checker, const syntax::Attribute& written) {
    if (written.args.size() != 2) return;
    Attribute out;
    out.operation = written.operation;
    out.span = written.span;
    checker.beginDraws("report " + written.args[0].text);
    rules::Typed value = checker.value(written.args[1]);
    const auto index = checker.report(written.args[0], value);
    if (!index) return;
    out.args.push_back(rules::makeConstant(written.args[0].span, rules::Value::number(*index)));
    out.args.push_back(std::move(value.expr));
    checker.add(std::move(out));
}

void applyReport(AttributeContext& context, const Attribute& attribute) {
    context.out.extras.reports.emplace_back(static_cast<uint32_t>(attribute.args[0].value.num()),
                                            context.number(attribute.args[1]));
}

}  // namespace

constinit const Operation displace{
    .name = "displace",
    .doc = "Moves the surface along itself by noise.",
    .example = "sphere displace billow(.05m, 2.2/m)",
    .arguments = displaceArguments,
    .phase = Phase::Whole,
    .traits = {.repeatable = true},
    .check = checkDisplace,
    .apply = applyDisplace,
};

constinit const Operation report{
    .name = "report",
    .doc =
        "Reports a number of the shape under a word. Sums are told by 'sgm check' and '--report', and a check may ask "
        "for "
        "them by that word.",
    .example = "Block report gfa (scope.area * 4)",
    .arguments = reportArguments,
    .phase = Phase::Whole,
    .traits = {.repeatable = true, .beforeShape = true},
    .check = checkReport,
    .apply = applyReport,
};

constinit const Operation with{
    .name = "with",
    .doc = "Sets a value that the shape's descendants inherit.",
    .example = "Level with storey = 3",
    .arguments = withArguments,
    .phase = Phase::Whole,
    .traits = {.repeatable = true, .beforeShape = true, .namesValue = true},
    .check = checkWith,
    .apply = applyWith,
};

}  // namespace sgm::operations
