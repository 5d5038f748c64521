#include "viewer/document/plan_handles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "grammar/derive/scope_footprint.h"
#include "grammar/rules/plans.h"
#include "viewer/document/nodes.h"
#include "viewer/document/picking.h"

namespace sgm::document {

using derive::Scope;
using plan::Vec2;
using syntax::Expr;

/// Handles of one piece of text.
class PlanHandles::Source {
public:
    virtual ~Source() = default;
    virtual std::vector<PlanHandle> handles() const = 0;
    /// What is written in place of which numbers.
    virtual Result<std::vector<TextEdit>> move(size_t index, Vec3d to, double step_m) const = 0;
};

namespace {

constexpr double alike_m = 1e-6;

/// A length or a share that stands in the text as a number, maybe with a sign.
struct Literal {
    syntax::SourceSpan span;
    double value = 0;   ///< in metres, or a share of 1
    double factor = 1;  ///< of the unit it is written in
    std::string unit;
    bool isShare = false;
};

std::optional<Literal> literalOf(const Expr& e) {
    const bool negative = e.kind == Expr::Kind::Unary && e.text == "-";
    const Expr& number = negative ? e.args[0] : e;
    if (number.kind != Expr::Kind::Number) return std::nullopt;
    constexpr std::pair<std::string_view, double> units[] = {{"", 1},     {"m", 1},     {"km", 1000},
                                                             {"cm", .01}, {"mm", .001}, {"%", .01}};
    for (const auto& [unit, factor] : units)
        if (number.unit == unit)
            return Literal{e.span, (negative ? -1 : 1) * number.number * factor, factor, number.unit, unit == "%"};
    return std::nullopt;
}

/// The literal with another value, rounded to a step.
TextEdit written(const Literal& literal, double value, double step) {
    const double rounded = std::round(value / step) * step / literal.factor;
    return {literal.span.begin, literal.span.end, fmt::format("{:.9g}{}", rounded == 0 ? 0.0 : rounded, literal.unit)};
}

/// The next lower of 1, 2 and 5 times a power of ten.
double roundStep(double step) {
    const double ten = std::pow(10, std::floor(std::log10(std::max(step, 1e-9))));
    return step >= 5 * ten ? 5 * ten : step >= 2 * ten ? 2 * ten : ten;
}

struct LiteralPoint {
    Literal x, z;
    Vec2 value() const { return {x.value, z.value}; }
};
std::optional<LiteralPoint> pointOf(const Expr& e) {
    if (e.kind != Expr::Kind::Tuple || e.args.size() != 2) return std::nullopt;
    const auto x = literalOf(e.args[0]), z = literalOf(e.args[1]);
    if (!x || !z || x->isShare != z->isShare) return std::nullopt;
    return LiteralPoint{*x, *z};
}

/// Where a plan stands in space: at the foot of a scope.
struct PlanFrame {
    Scope scope;

    Vec3d inSpace(Vec2 p) const { return scope.centre + scope.axes * Vec3d{p.x, -scope.size.y / 2, p.z}; }
    Vec2 inPlan(Vec3d p) const {
        const Vec3d local = scope.axes.transposed() * (p - scope.centre);
        return {local.x, local.z};
    }
};

PlanHandle sideHandle(const PlanFrame& frame, size_t number, Vec2 from, Vec2 to) {
    return {PlanHandle::Kind::Side,
            fmt::format("side {}", number + 1),
            frame.inSpace((from + to) * .5),
            {frame.inSpace(from), frame.inSpace(to)}};
}

/// An outline whose points are all numbers: its corners, then its sides.
class Outline : public PlanHandles::Source {
public:
    Outline(PlanFrame frame, std::vector<LiteralPoint> points) : frame_(std::move(frame)), points_(std::move(points)) {}

    std::vector<Vec2> corners() const { return placed(values()); }

    std::vector<PlanHandle> handles() const override {
        std::vector<PlanHandle> all;
        const std::vector<Vec2> at = corners();
        for (size_t i = 0; i < at.size(); ++i)
            all.push_back({PlanHandle::Kind::Point, fmt::format("corner {}", i + 1), frame_.inSpace(at[i]), {}});
        for (size_t i = 0; i < at.size(); ++i) all.push_back(sideHandle(frame_, i, at[i], at[(i + 1) % at.size()]));
        return all;
    }

    Result<std::vector<TextEdit>> move(size_t index, Vec3d to, double step_m) const override {
        const size_t count = points_.size();
        const Vec2 target = frame_.inPlan(to);
        std::vector<Vec2> values = this->values();
        std::vector<size_t> moved{index};
        if (index >= count) moved = {index - count, (index - count + 1) % count};
        // The outline stands about its centre, which moves with its corners.
        for (int round = 0; round < 50; ++round) {
            const std::vector<Vec2> at = placed(values);
            Vec2 off = target - at[moved[0]];
            if (moved.size() == 2) {
                const Vec2 side = at[moved[1]] - at[moved[0]];
                const double length_m = length(side);
                if (!(length_m > 0)) break;
                const Vec2 normal = Vec2{side.z, -side.x} * (1 / length_m);
                off = normal * dot(target - (at[moved[0]] + at[moved[1]]) * .5, normal);
            }
            for (const size_t i : moved) values[i] = values[i] + inValues(off);
        }
        std::vector<TextEdit> edits;
        for (const size_t i : moved) {
            const double step = isShare() ? .001 : step_m;
            if (std::abs(values[i].x - points_[i].x.value) > step / 2)
                edits.push_back(written(points_[i].x, values[i].x, step));
            if (std::abs(values[i].z - points_[i].z.value) > step / 2)
                edits.push_back(written(points_[i].z, values[i].z, step));
        }
        return edits;
    }

private:
    bool isShare() const { return points_[0].x.isShare; }
    std::vector<Vec2> values() const {
        std::vector<Vec2> all;
        for (const LiteralPoint& p : points_) all.push_back(p.value());
        return all;
    }
    /// Metres in the plan as numbers of the text.
    Vec2 inValues(Vec2 v) const { return isShare() ? Vec2{v.x / frame_.scope.size.x, v.z / frame_.scope.size.z} : v; }
    /// Where the points lie about the scope's centre, metres.
    std::vector<Vec2> placed(std::vector<Vec2> values) const {
        plan::Box2 box;
        for (const Vec2 v : values) box.add(v);
        for (Vec2& v : values)
            v = isShare() ? Vec2{(v.x - .5) * frame_.scope.size.x, (v.z - .5) * frame_.scope.size.z} : v - box.centre();
        return values;
    }

    PlanFrame frame_;
    std::vector<LiteralPoint> points_;
};

/// A plan of the table with numbers: its sides, each moved by the number that moves it most.
class Drawn : public PlanHandles::Source {
public:
    Drawn(PlanFrame frame, const rules::PlanRow& row, std::vector<double> numbers,
          std::vector<std::optional<Literal>> literals)
        : frame_(std::move(frame)), row_(row), numbers_(std::move(numbers)), literals_(std::move(literals)) {}

    std::vector<plan::PlacedEdge> sides() const { return sidesOf(numbers_); }

    std::vector<PlanHandle> handles() const override {
        std::vector<PlanHandle> all;
        const std::vector<plan::PlacedEdge> sides = this->sides();
        if (sides.size() > 64) return all;  // a circle, not sides
        for (size_t i = 0; i < sides.size(); ++i)
            if (strongest(sides, i)) all.push_back(sideHandle(frame_, i, sides[i].from, sides[i].to));
        return all;
    }

    Result<std::vector<TextEdit>> move(size_t index, Vec3d to, double step_m) const override {
        const std::vector<plan::PlacedEdge> sides = this->sides();
        size_t side = 0;
        for (size_t i = 0, seen = 0; i < sides.size(); ++i)
            if (strongest(sides, i) && seen++ == index) side = i;
        const auto by = strongest(sides, side);
        if (!by) return edits::refused("this side has no number of its own");
        const Vec2 middle = (sides[side].from + sides[side].to) * .5;
        const double out_m = dot(frame_.inPlan(to) - middle, sides[side].normal());
        std::vector<double> numbers = numbers_;
        numbers[by->number] = std::max(step_m, numbers_[by->number] + out_m / by->speed);
        if (sidesOf(numbers).size() != sides.size()) return edits::refused("there the plan has no room");
        return std::vector{written(*literals_[by->number], numbers[by->number], step_m)};
    }

private:
    std::vector<plan::PlacedEdge> sidesOf(const std::vector<double>& numbers) const {
        const auto drawn = row_.draw(numbers);
        return drawn.ok() ? plan::edgesOf(*drawn) : std::vector<plan::PlacedEdge>{};
    }

    struct Lever {
        size_t number;
        double speed;  ///< metres along the side's normal per metre of the number
    };
    std::optional<Lever> strongest(const std::vector<plan::PlacedEdge>& sides, size_t side) const {
        constexpr double step_m = 1e-3, least = .05;
        std::optional<Lever> best;
        for (size_t k = 0; k < numbers_.size(); ++k) {
            if (!literals_[k]) continue;
            std::vector<double> numbers = numbers_;
            numbers[k] += step_m;
            const auto moved = sidesOf(numbers);
            if (moved.size() != sides.size()) continue;
            const Vec2 by = (moved[side].from + moved[side].to - sides[side].from - sides[side].to) * .5;
            const double speed = dot(by, sides[side].normal()) / step_m;
            if (std::abs(speed) > std::max(least, best ? std::abs(best->speed) * 1.01 : 0)) best = Lever{k, speed};
        }
        return best;
    }

    PlanFrame frame_;
    const rules::PlanRow& row_;
    std::vector<double> numbers_;
    std::vector<std::optional<Literal>> literals_;  ///< by number: where the text has it
};

/// A place of a town's plan.
class GroundPoint : public PlanHandles::Source {
public:
    GroundPoint(std::string name, LiteralPoint point, double height_m)
        : name_(std::move(name)), point_(std::move(point)), height_m_(height_m) {}

    std::vector<PlanHandle> handles() const override {
        return {{PlanHandle::Kind::Point, name_, {point_.x.value, height_m_, point_.z.value}, {}}};
    }
    Result<std::vector<TextEdit>> move(size_t, Vec3d to, double step_m) const override {
        return std::vector{written(point_.x, to.x, step_m), written(point_.z, to.z, step_m)};
    }

private:
    std::string name_;
    LiteralPoint point_;
    double height_m_;
};

bool isSame(const std::vector<plan::PlacedEdge>& a, const std::vector<plan::PlacedEdge>& b) {
    const auto has = [&](const plan::PlacedEdge& e) {
        return std::any_of(b.begin(), b.end(), [&](const plan::PlacedEdge& o) {
            return length(o.from - e.from) < alike_m + 1e-6 * length(e.from) &&
                   length(o.to - e.to) < alike_m + 1e-6 * length(e.to);
        });
    };
    return a.size() == b.size() && std::all_of(a.begin(), a.end(), has);
}

/// The handles of a written plan, where what stands in the scope is what it draws.
std::unique_ptr<PlanHandles::Source> sourceOf(const Expr& plan, const PlanFrame& frame, const plan::Footprint& stands) {
    if (plan.kind != Expr::Kind::Call) return nullptr;
    const bool isPlain = std::all_of(plan.argNames.begin(), plan.argNames.end(),
                                     [](const std::string& name) { return name != "at" && name != "turn"; });
    if (!isPlain) return nullptr;
    const std::vector<plan::PlacedEdge> edges = plan::edgesOf(stands);
    if (plan.text == "outline") {
        std::vector<LiteralPoint> points;
        for (const Expr& arg : plan.args) {
            const auto point = pointOf(arg);
            if (!point || (!points.empty() && point->x.isShare != points[0].x.isShare)) return nullptr;
            points.push_back(*point);
        }
        if (points.size() < 3) return nullptr;
        auto outline = std::make_unique<Outline>(frame, std::move(points));
        const auto drawn = plan::footprintOf(plan::polygonOf(outline->corners()));
        return isSame(plan::edgesOf(drawn), edges) ? std::move(outline) : nullptr;
    }
    const rules::PlanRow* row = rules::findPlan(plan.text);
    if (!row) return nullptr;
    std::vector<double> numbers;
    std::vector<std::optional<Literal>> literals(row->parameters.size());
    for (const rules::PlanParameter& parameter : row->parameters) numbers.push_back(parameter.fallback);
    size_t next = 0;
    for (size_t i = 0; i < plan.args.size(); ++i) {
        const std::string& name = plan.argNames[i];
        const auto named = std::find_if(row->parameters.begin(), row->parameters.end(),
                                        [&](const rules::PlanParameter& p) { return p.name == name; });
        const size_t k = name.empty() ? next++ : static_cast<size_t>(named - row->parameters.begin());
        const auto literal = k < numbers.size() ? literalOf(plan.args[i]) : std::nullopt;
        if (!literal || literal->isShare) return nullptr;
        numbers[k] = literal->value;
        if (row->parameters[k].kind == rules::PlanParameterKind::Length) literals[k] = literal;
    }
    auto drawn = std::make_unique<Drawn>(frame, *row, std::move(numbers), std::move(literals));
    return isSame(drawn->sides(), edges) ? std::move(drawn) : nullptr;
}

/// The plan that an element's own text gives its shape.
const Expr* writtenPlan(const syntax::Element& element) {
    for (const auto* attributes : {&element.before, &element.after})
        for (const syntax::Attribute& a : *attributes)
            if (a.name.text == "footprint" && !a.args.empty()) return &a.args[0];
    return nullptr;
}

void forCalls(const Expr& e, std::string_view name, const std::function<void(const Expr&)>& visit) {
    if (e.kind == Expr::Kind::Call && e.text == name) visit(e);
    for (const Expr& arg : e.args) forCalls(arg, name, visit);
}

}  // namespace

derive::ShapeId widestShape(const derive::ShapeTree& tree) {
    const auto area = [&](derive::ShapeId s) { return tree.shapes[s].scope.size.x * tree.shapes[s].scope.size.z; };
    derive::ShapeId widest = 0;
    for (derive::ShapeId s = 1; s < tree.shapes.size(); ++s)
        if (area(s) > area(widest)) widest = s;
    return widest;
}

PlanHandles::PlanHandles() = default;
PlanHandles::~PlanHandles() = default;
PlanHandles::PlanHandles(PlanHandles&&) noexcept = default;
PlanHandles& PlanHandles::operator=(PlanHandles&&) noexcept = default;

void PlanHandles::add(std::unique_ptr<Source> source) {
    std::vector<PlanHandle> made = source->handles();
    for (size_t i = 0; i < made.size(); ++i) {
        handles_.push_back(std::move(made[i]));
        places_.push_back({sources_.size(), i});
    }
    sources_.push_back(std::move(source));
}

PlanHandles PlanHandles::of(const Document& document, const BuiltModel& shown, derive::ShapeId selected) {
    PlanHandles found;
    if (!isCurrent(document, shown)) return found;
    found.ast_ = document.ast();
    const derive::ShapeTree& tree = shown.model.derivation.tree;
    for (derive::ShapeId s = selected; s != derive::none; s = tree.shapes[s].parent) {
        if (tree.shapes[s].scope.footprint == derive::none) continue;
        const syntax::Element* element = elementOf(document, shown, s);
        const Expr* plan = element ? writtenPlan(*element) : nullptr;
        if (!plan) continue;
        const Scope& scope = tree.shapes[s].scope;
        if (auto source = sourceOf(*plan, {scope}, derive::footprintOf(scope, tree.footprints)))
            found.add(std::move(source));
        break;
    }
    if (!found.handles_.empty() || (selected != derive::none && selected != 0)) return found;
    const Scope& ground = tree.shapes[widestShape(tree)].scope;
    const double height_m = ground.centre.y + ground.size.y / 2;
    const auto take = [&](const std::string& name, const Expr& e) {
        const auto point = pointOf(e);
        if (point && !point->x.isShare) found.add(std::make_unique<GroundPoint>(name, *point, height_m));
    };
    for (const syntax::RoadsDecl& roads : found.ast_->roads)
        for (const syntax::Setting& setting : roads.settings)
            if (setting.name.text == "from" || setting.name.text == "centre") take(setting.name.text, setting.value);
    for (const syntax::MapDecl& map : found.ast_->maps)
        if (map.formula)
            forCalls(*map.formula, "bump", [&](const Expr& bump) {
                if (!bump.args.empty()) take(map.name.text, bump.args[0]);
            });
    return found;
}

edits::Edit PlanHandles::move(size_t handle, Vec3d to, double step_m) const {
    const Place place = places_[handle];
    auto moved = sources_[place.source]->move(place.index, to, roundStep(step_m));
    if (!moved.ok()) return moved.error();
    return edits::tried(*ast_, merged(ast_->source->text(), std::move(*moved)));
}

}  // namespace sgm::document
