#include "grammar/derive/print.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

namespace sgm::derive {
namespace {

using nlohmann::json;
using rules::Operator;

std::string_view sign(Operator op) {
    switch (op) {
        case Operator::None:
            return "";
        case Operator::Sum:
            return "+ ";
        case Operator::Difference:
            return "- ";
        case Operator::Intersection:
            return "& ";
        case Operator::Morph:
            return "morph ";
    }
    return "";
}

std::string_view word(Operator op) {
    switch (op) {
        case Operator::None:
            return "content";
        case Operator::Sum:
            return "sum";
        case Operator::Difference:
            return "difference";
        case Operator::Intersection:
            return "intersection";
        case Operator::Morph:
            return "morph";
    }
    return "";
}

std::string solidName(const SolidValue& s) {
    switch (s.kind) {
        case rules::Solid::Kind::Morph:
            return fmt::format("morph({}, {}, {:.3g})", solidName(s.parts[0]), solidName(s.parts[1]), s.amount);
        case rules::Solid::Kind::Combination:
            return fmt::format("{} {} …", solidName(s.parts[0]), sign(s.op));
        case rules::Solid::Kind::Nil:
            return "nil";
        default:
            return s.primitive ? std::string(s.primitive->name) : "solid";
    }
}

std::string ruleOf(const Derivation& d, const Shape& s) {
    if (s.madeBy == none) return "start";
    const Step& step = d.steps[s.madeBy];
    std::string text = d.grammar->rules[step.rule].name;
    if (step.chainIndex) text += fmt::format(" step {}", step.chainIndex);
    if (step.closing) text += " finally";
    return text;
}

uint32_t lineOf(syntax::SourceSpan span) { return span.source ? span.source->place(span.begin).line : 0; }

/// Bonds that put a shape where it is: those in which it is the newcomer.
std::vector<uint32_t> bondsOfNewcomers(const ShapeTree& tree) {
    std::vector<uint32_t> first(tree.shapes.size(), none);
    const std::vector<Bond>& bonds = tree.bonds().all;
    for (uint32_t i = 0; i < bonds.size(); ++i)
        if (uint32_t& at = first[bonds[i].shape[1]]; at == none) at = i;
    return first;
}

void printSteps(const Derivation& d, std::back_insert_iterator<std::string> out) {
    for (size_t i = 0; i < d.steps.size(); ++i) {
        const Step& s = d.steps[i];
        const std::string at = s.shape == none ? "what was replaced later" : d.tree.path(s.shape);
        fmt::format_to(out, "{:>5}  generation {}  {} {}{}{}  at {}  → {} shape{}\n", i + 1, s.generation,
                       s.morphic ? "R_M" : "R_C", d.grammar->rules[s.rule].name,
                       s.chainIndex ? fmt::format(" step {}", s.chainIndex) : "", s.closing ? " finally" : "", at,
                       s.madeCount, s.madeCount == 1 ? "" : "s");
    }
}

/// Where a grammar asked for a joint that a bond had closed.
void printClosed(const Derivation& d, std::back_insert_iterator<std::string> out) {
    for (const Closed& c : d.closed) {
        const std::string closer = closedBy(d, c);
        fmt::format_to(out, "{}its joint was closed {}, so nothing grew there{}\n", syntax::placeText(c.span),
                       c.count == 1 ? "once" : fmt::format("{} times", c.count),
                       closer.empty() ? "" : fmt::format("{} {}", c.count == 1 ? ":" : ": first", closer));
    }
}

void printShape(const Derivation& d, ShapeId id, uint32_t bond, std::back_insert_iterator<std::string> out) {
    constexpr uint32_t deepest = 40;
    const Shape& s = d.tree.shapes[id];
    fmt::format_to(out, "{:{}}", "", 2 * std::min(s.depth, deepest));
    if (s.depth > deepest) fmt::format_to(out, "({}) ", s.depth);
    fmt::format_to(out, "{}{}", sign(s.op), d.tree.labels[s.label]);
    if (s.occurrence > 1) fmt::format_to(out, "[{}]", s.occurrence);
    if (const SolidValue* solid = d.tree.solidOf(id); solid && solidName(*solid) != d.tree.labels[s.label])
        fmt::format_to(out, " = {}", solidName(*solid));
    if (const Extras* x = d.tree.extrasOf(id); x && x->object != none) {
        const auto& start = d.grammar->starts[d.objects[x->object].start];
        fmt::format_to(out, " = {} (object {})", d.grammar->symbols[start.symbol].name, x->object + 1);
    }
    if (s.live) fmt::format_to(out, " (live)");
    const auto settled = [](double v) { return std::abs(v) < 1e-12 ? 0.0 : v; };  // what turns leave of 0
    const Vec3d &z = s.scope.size, c{settled(s.scope.centre.x), settled(s.scope.centre.y), settled(s.scope.centre.z)};
    fmt::format_to(out, "  size ({:.4g}, {:.4g}, {:.4g}) at ({:.4g}, {:.4g}, {:.4g})", z.x, z.y, z.z, c.x, c.y, c.z);
    if (bond != none) {
        const Bond& b = d.tree.bonds().all[bond];
        fmt::format_to(out, "  bond {} of {} to {}", d.tree.joint(b.shape[0], b.joint[0]).name, d.tree.path(b.shape[0]),
                       d.tree.joint(id, b.joint[1]).name);
    }
    fmt::format_to(out, "  by {}  key {:016x}\n", ruleOf(d, s), s.key);
}

json vectorOf(Vec3d v) { return json::array({v.x, v.y, v.z}); }

json shapeJson(const Derivation& d, ShapeId id) {
    const Shape& s = d.tree.shapes[id];
    json j{{"path", d.tree.path(id)},
           {"symbol", d.tree.labels[s.label]},
           {"operator", word(s.op)},
           {"live", s.live},
           {"key", fmt::format("{:016x}", s.key)},
           {"centre", vectorOf(s.scope.centre)},
           {"size", vectorOf(s.scope.size)},
           {"axes", json::array({vectorOf(s.scope.axes.x), vectorOf(s.scope.axes.y), vectorOf(s.scope.axes.z)})},
           {"line", lineOf(s.span)}};
    j["parent"] = s.parent == none ? json() : json(s.parent);
    j["step"] = s.madeBy == none ? json() : json(s.madeBy);
    if (const SolidValue* solid = d.tree.solidOf(id)) j["solid"] = solidName(*solid);
    if (s.op == Operator::Morph) j["amount"] = s.amount;
    if (s.blend_m > 0) j["blend_m"] = s.blend_m;
    if (const Extras* x = d.tree.extrasOf(id)) {
        if (!x->tags.empty()) j["tags"] = x->tags;
        if (x->object != none) j["object"] = x->object;
        for (const auto& [name, value] : x->values) j["values"][name] = rules::toText(value);
    }
    return j;
}

}  // namespace

std::string toText(const Derivation& d, bool steps) {
    std::string text;
    const auto out = std::back_inserter(text);
    fmt::format_to(out, "{} shapes, {} bonds, {} classic and {} morphic rules, seed {}\n", d.tree.shapes.size(),
                   d.tree.bonds().all.size(), d.classic, d.morphic, d.seed);
    if (steps) printSteps(d, out);
    if (steps) printClosed(d, out);
    const auto bonds = bondsOfNewcomers(d.tree);
    for (ShapeId s = 0; s != none; s = d.tree.next(s)) printShape(d, s, bonds[s], out);
    return text;
}

std::string toJson(const Derivation& d) {
    json root{{"seed", d.seed},
              {"start", d.grammar->symbols[d.grammar->starts[d.start].symbol].name},
              {"classic", d.classic},
              {"morphic", d.morphic},
              {"terminals", d.terminals()},
              {"shapes", json::array()},
              {"bonds", json::array()},
              {"steps", json::array()},
              {"closed", json::array()}};
    for (ShapeId s = 0; s < d.tree.shapes.size(); ++s) root["shapes"].push_back(shapeJson(d, s));
    for (const Bond& b : d.tree.bonds().all)
        root["bonds"].push_back(
            {{"shapes", {b.shape[0], b.shape[1]}},
             {"joints", {d.tree.joint(b.shape[0], b.joint[0]).name, d.tree.joint(b.shape[1], b.joint[1]).name}},
             {"shift_m", vectorOf(b.shift)},
             {"directed", b.directed}});
    for (const Closed& c : d.closed)
        root["closed"].push_back({{"file", c.span.source->name()},
                                  {"line", lineOf(c.span)},
                                  {"times", c.count},
                                  {"shape", c.host == none ? json() : json(c.host)},
                                  {"by", closedBy(d, c)}});
    for (const Step& s : d.steps)
        root["steps"].push_back({{"rule", d.grammar->rules[s.rule].name},
                                 {"shape", s.shape == none ? json() : json(s.shape)},
                                 {"generation", s.generation},
                                 {"chain_index", s.chainIndex},
                                 {"morphic", s.morphic},
                                 {"finally", s.closing},
                                 {"first_made", s.firstMade},
                                 {"made", s.madeCount}});
    return root.dump(2) + "\n";
}

}  // namespace sgm::derive
