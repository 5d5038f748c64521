#include "grammar/pipeline/model.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "grammar/pipeline/scene.h"
#include "grammar/rules/check.h"
#include "grammar/rules/params.h"

namespace sgm::pipeline {

namespace {

template <class List, class NameOf>
Result<uint32_t> find(const List& list, const std::string& wanted, const char* what, NameOf nameOf) {
    std::vector<std::string> names;
    for (uint32_t i = 0; i < list.size(); ++i) {
        names.push_back(nameOf(list[i]));
        if (names.back() == wanted) return i;
    }
    const std::string near = syntax::didYouMean(wanted, names);
    constexpr size_t most = 20;
    const bool all = names.size() <= most;
    if (!all) names.resize(most);
    return Error{Error::Kind::Usage, fmt::format("no {} is called '{}'{}; {}{}", what, wanted,
                                                 near.empty() ? "" : fmt::format(" (did you mean '{}'?)", near),
                                                 names.empty() ? fmt::format("the grammar has no {}", what)
                                                               : fmt::format("there are {}", fmt::join(names, ", ")),
                                                 all ? "" : " …")};
}

void applySettings(const rules::Style& style, const ValueChange& change, derive::Options& options) {
    for (const rules::Setting& s : style.settings)
        options.params[s.param] = &s == change.setting ? change.value : s.value;
}

Status applyStyle(const rules::Grammar& grammar, const std::string& name, const ValueChange& change,
                  derive::Options& options) {
    const rules::Style* style = rules::findStyle(grammar, name, options.start);
    if (!style) {
        const auto other = find(grammar.styles, name, "style", [](const rules::Style& s) { return s.name; });
        if (!other.ok()) return other.error();
        style = &grammar.styles[*other];
    }
    applySettings(*style, change, options);
    return Done{};
}

Status applySetting(const rules::Grammar& grammar, const std::string& text, derive::Options& options) {
    const size_t equals = text.find('=');
    if (equals == std::string::npos)
        return Error{Error::Kind::Usage, fmt::format("write --set NAME=VALUE instead of '{}'", text)};
    const auto param =
        find(grammar.params, text.substr(0, equals), "parameter", [](const rules::Param& p) { return p.name; });
    if (!param.ok()) return param.error();
    Result<rules::Value> value = rules::parseValue(grammar.params[*param], text.substr(equals + 1));
    if (!value.ok()) return Error{Error::Kind::Input, fmt::format("--set {}: {}", text, value.error().message)};
    options.params[*param] = *value;
    return Done{};
}

}  // namespace

Result<derive::Options> optionsFor(const rules::Grammar& grammar, const ModelChoice& choice,
                                   const ValueChange& change) {
    derive::Options options;
    options.seed = choice.seed;
    options.derive = choice.derive;
    options.budget.shapes = choice.shapeBudget;
    options.budget.seconds = choice.secondsBudget;
    if (grammar.starts.empty())
        return Error{Error::Kind::Input,
                     fmt::format("{}: no `start`, so there is nothing to build", grammar.sources[0]->name())};
    if (!choice.start.empty()) {
        const auto start = find(grammar.starts, choice.start, "start",
                                [&](const rules::Start& s) { return grammar.symbols[s.symbol].name; });
        if (!start.ok()) return start.error();
        options.start = *start;
    }
    for (const rules::Param& p : grammar.params) options.params.push_back(p.value);
    if (change.param != rules::none && !change.setting) options.params[change.param] = change.value;
    if (const rules::Style* style = rules::findStyle(grammar, "default", options.start))
        applySettings(*style, change, options);
    if (!choice.derive.empty()) {
        const auto way =
            find(grammar.derives, choice.derive, "derive way", [](const rules::Derive& d) { return d.name; });
        if (!way.ok()) return way.error();
    }
    if (!choice.style.empty())
        if (const Status s = applyStyle(grammar, choice.style, change, options); !s.ok()) return s.error();
    for (const std::string& setting : choice.settings)
        if (const Status s = applySetting(grammar, setting, options); !s.ok()) return s.error();
    return options;
}

Result<Model> makeModel(std::shared_ptr<const rules::Grammar> grammar, const derive::Options& options, Context& context,
                        Objects objects) {
    auto derivation = context.timed("derive", [&] { return derive::derive(grammar, options, context.progress); });
    if (!derivation.ok()) return derivation.error();
    return makeModel(std::move(*derivation), context, objects, options.budget);
}

std::shared_ptr<const lower::Model> withoutGraph(const lower::Model& model) {
    auto copy = std::make_shared<lower::Model>();
    copy->field = model.field;
    copy->field.value = {};
    copy->provenance = model.provenance;
    copy->shapeOf = model.shapeOf;
    return copy;
}

std::string sketchNote(const derive::Derivation& derivation) {
    if (derivation.masses == 0) return {};
    return fmt::format(
        "the objects at {} places are drawn as boxes: as one field they would spend the budget of shapes "
        "(--max-shapes); meshes hold each of them once",
        derivation.masses);
}

Result<Model> makeModel(derive::Derivation derivation, Context& context, Objects objects, const derive::Budget& budget,
                        bool joinsBoxes) {
    if (objects != Objects::Apart)
        if (const Status s = graftObjects(derivation, objects, budget, context); !s.ok()) return s.error();
    auto lowered =
        context.timed("lower", [&] { return lower::lower(derivation, context.progress, context.threads, joinsBoxes); });
    if (!lowered.ok()) return lowered.error();
    const lower::Model& model = **lowered;
    eval::Tape tape =
        context.timed("compile", [&] { return eval::compile(model.graph, model.field, model.graph.constants()); });
    return Model{std::move(derivation), std::move(*lowered), std::move(tape)};
}

}  // namespace sgm::pipeline
