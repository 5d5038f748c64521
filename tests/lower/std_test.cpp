// Every parameter of the standard library does something: set to two values in its range, it changes the model.
#include <cmath>
#include <set>

#include "grammar/lower/lower.h"
#include "modeler/core/random.h"
#include "modeler/eval/evaluate.h"
#include "tests/derive/grammars.h"

namespace sgm {
namespace {

using namespace testing_;
using rules::Param;
using rules::Value;

/// What can be told of a model: its field at points of a box that doesn't depend on the parameters, and its colours.
struct Seen {
    std::vector<float> field;
    std::vector<Vec3f> colors;
    bool operator==(const Seen& o) const { return field == o.field && colors == o.colors; }
};

std::optional<Seen> see(const std::shared_ptr<const rules::Grammar>& grammar, const std::vector<Value>& params,
                        const Box3f& box) {
    derive::Options options;
    options.params = params;
    const auto derivation = derive::derive(grammar, options, nullptr);
    if (!derivation.ok()) return std::nullopt;
    const auto model = lower::lower(*derivation, nullptr);
    if (!model.ok()) return std::nullopt;
    const eval::Tape tape = eval::compile((*model)->graph, (*model)->field, (*model)->graph.constants());
    constexpr size_t count = 2500;
    const Box3f region = box.empty() ? (*model)->field.bounds : box;
    std::vector<float> at[3];
    for (size_t i = 0; i < count; ++i)
        for (int axis = 0; axis < 3; ++axis)
            at[axis].push_back(static_cast<float>(uniform(combine(i, static_cast<uint64_t>(axis)),
                                                          static_cast<double>(region.lo[axis]),
                                                          static_cast<double>(region.hi[axis]))));
    Seen seen;
    seen.field.resize(count);
    eval::Workspace workspace;
    eval::evaluate(tape, {at[0].data(), at[1].data(), at[2].data(), count}, seen.field.data(), workspace);
    for (const Part& part : (*model)->provenance.parts)
        seen.colors.push_back((*model)->provenance.materials[part.material].color);
    return seen;
}

/// Values to try: a quarter and three quarters of the range, each component of a vector by itself, or every choice.
std::vector<Value> valuesOf(const Param& p) {
    std::vector<Value> values;
    if (p.value.kind == Value::Kind::Word)
        for (const std::string& choice : p.choices) values.push_back(p.value), values.back().text = choice;
    else if (p.value.kind == Value::Kind::Bool)
        for (const double b : {0.0, 1.0}) values.push_back(p.value), values.back().n[0] = b;
    else if (p.value.kind == Value::Kind::Color)
        for (const double c : {0.1, 0.9}) values.push_back(p.value), values.back().n[0] = c;
    else if (p.lo && p.hi)
        for (size_t i = 0; i < p.value.count; ++i)
            for (const double share : {0.25, 0.75}) {
                const double lo = p.lo->n[i], hi = p.hi->n[i], v = lo + share * (hi - lo);
                values.push_back(p.value);
                values.back().n[i] = p.value.integer ? std::round(v) : v;
            }
    return values;
}

bool matters(const std::shared_ptr<const rules::Grammar>& grammar, size_t param, const std::vector<Value>& base,
             const Box3f& box) {
    std::optional<Seen> first;
    for (const Value& value : valuesOf(grammar->params[param])) {
        std::vector<Value> params = base;
        params[param] = value;
        auto seen = see(grammar, params, box);
        if (!seen) continue;
        if (first && !(*first == *seen)) return true;
        if (!first) first = std::move(seen);
    }
    return false;
}

/// As they stand, or where they have no part in the model then, with one other parameter changed.
void expectAllMatter(const std::string& file, const std::string& start,
                     const std::vector<std::pair<std::string, std::string>>& settings) {
    const auto grammar = grammarOf("grammar 1\nuse \"std/" + file + "\"\nstart Model -> " + start + "\n");
    ASSERT_TRUE(grammar);
    std::vector<Value> base;
    for (const Param& p : grammar->params) {
        base.push_back(p.value);
        for (const auto& [name, text] : settings)
            if (name == p.name) base.back() = *rules::parseValue(p, text);
    }
    derive::Options options;
    options.params = base;
    const auto derivation = derive::derive(grammar, options, nullptr);
    ASSERT_TRUE(derivation.ok()) << derivation.error().message;
    const auto model = lower::lower(*derivation, nullptr);
    ASSERT_TRUE(model.ok());
    const Box3f box = (*model)->field.bounds.inflated(1);
    ASSERT_GT(grammar->params.size(), 10u);
    for (size_t i = 0; i < grammar->params.size(); ++i) {
        bool found = matters(grammar, i, base, box);
        for (size_t k = 0; k < grammar->params.size() && !found; ++k) {
            if (k == i) continue;
            for (const Value& value : valuesOf(grammar->params[k])) {
                std::vector<Value> changed = base;
                changed[k] = value;
                if ((found = matters(grammar, i, changed, box))) break;
            }
        }
        EXPECT_TRUE(found) << file << ": '" << grammar->params[i].name << "' changes nothing";
    }
}

TEST(StandardLibrary, EveryParameterOfCavesMatters) {
    expectAllMatter(
        "cave.sgm", "Rock",
        {{"cells", "4"}, {"open", "none"}, {"drips", "2"}, {"block", "(40, 14, 30)"}, {"place", "(-8, 0, -3)"}});
}
TEST(StandardLibrary, EveryParameterOfCloudsMatters) {
    expectAllMatter("cloud.sgm", "Cloud", {{"reach", "(2, 2, 2, 1, 2, 2)"}});
}
TEST(StandardLibrary, EveryParameterOfHousesMatters) { expectAllMatter("house.sgm", "House", {{"floors", "3"}}); }

}  // namespace
}  // namespace sgm
