// What turtles draw of the letters of an L-system: outlines, walls, steps in space.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "grammar/derive/builder.h"
#include "grammar/derive/lsystem.h"
#include "modeler/core/conventions.h"
#include "modeler/plan/edit.h"
#include "modeler/plan/plates.h"
#include "modeler/plan/validate.h"

namespace sgm::derive {
namespace {

/// What a turtle draws, one outline after the other.
class Turtle {
public:
    Turtle(double angle, double step_m, double shrink_m) : angle_(angle), step_m_(step_m), shrink_m_(shrink_m) {}

    void read(char letter, std::span<const double> numbers) {
        const double turn = numbers.empty() ? angle_ : numbers[0];
        switch (letter) {
            case 'F':
            case 'G':
                return draw(numbers);
            case 'f':
            case 'g':
                return jump(numbers);
            case '+':
                heading_ += turn;
                return;
            case '-':
                heading_ -= turn;
                return;
            case '|':
                heading_ += pi;
                return;
            case '[':
                kept_.push_back({at_, heading_, step_m_});
                return;
            case ']':
                return recall();
            default:
                return tag(letter);
        }
    }

    /// Chains as they were drawn, open or closed; tags are of `take`.
    std::vector<plan::Ring> takeChains() {
        finish();
        return std::move(chains_);
    }
    /// The outlines of three points or more, closed.
    plan::Footprint take() {
        finish();
        return std::move(drawn_);
    }

private:
    struct Kept {
        plan::Vec2 at;
        double heading, step_m;
    };

    void draw(std::span<const double> numbers) {
        if (ring_.points.empty()) ring_.points.push_back(at_);
        advance(numbers);
        ring_.points.push_back(at_);
        ring_.edges.emplace_back();
    }
    void jump(std::span<const double> numbers) {
        finish();
        advance(numbers);
    }
    /// By the letter's own number, or by the step, which then shrinks.
    void advance(std::span<const double> numbers) {
        const double by_m = numbers.empty() ? step_m_ : numbers[0];
        at_ = at_ + plan::Vec2{std::cos(heading_), std::sin(heading_)} * by_m;
        if (numbers.empty()) step_m_ = std::max(step_m_ - shrink_m_, 0.0);
    }
    void recall() {
        finish();
        if (kept_.empty()) return;
        at_ = kept_.back().at, heading_ = kept_.back().heading, step_m_ = kept_.back().step_m;
        kept_.pop_back();
    }
    void tag(char letter) {
        if (ring_.edges.empty()) return;
        plan::Edge& edge = ring_.edges.back();
        const std::string& before = drawn_.tags[edge.tag];
        edge.tag = drawn_.tag(before.empty() ? std::string(1, letter) : before + ' ' + letter);
    }
    void finish() {
        constexpr double near_m = 1e-6;
        plan::Ring ring = std::exchange(ring_, {});
        if (ring.points.size() > 1) chains_.push_back(ring);
        if (ring.points.size() < 3) return;
        const bool isClosed = length(ring.points.back() - ring.points.front()) < near_m;
        if (isClosed)
            ring.points.pop_back();
        else
            ring.edges.emplace_back();  // the wall that encloses it
        if (ring.points.size() < 3) return;
        plan::Polygon& polygon = drawn_.polygons.emplace_back();
        polygon.outer = plan::signedArea(ring) < 0 ? plan::reversed(ring) : std::move(ring);
    }

    double angle_, step_m_, shrink_m_, heading_ = 0;
    plan::Vec2 at_;
    plan::Ring ring_;
    plan::Footprint drawn_;
    std::vector<plan::Ring> chains_;
    std::vector<Kept> kept_;
};

Error errorOf(Error::Kind kind, const rules::Lsystem& lsystem, std::string_view what) {
    return {kind, fmt::format("the lsystem '{}' {}", lsystem.name, what)};
}

/// A turtle in the plan that has read all letters.
Result<Turtle> drawn(const rules::Lsystem& lsystem, const Place& place) {
    const auto letters = rewritten(lsystem, place);
    if (!letters.ok()) return letters.error();
    const auto walls =
        std::count_if(letters->text.begin(), letters->text.end(), [](char c) { return c == 'F' || c == 'G'; });
    if (walls > mostWalls)
        return errorOf(Error::Kind::Budget, lsystem,
                       fmt::format("draws {} walls, more than {}; give it fewer passes", walls, mostWalls));
    Turtle turtle(number(lsystem.angle, place), number(lsystem.step, place), number(lsystem.shrink, place));
    for (size_t i = 0; i < letters->text.size(); ++i) turtle.read(letters->text[i], letters->of(i));
    return turtle;
}

/// A turtle in space.
class Walker {
public:
    Walker(double angle, double step_m, double shrink_m, bool rises, double width_m)
        : angle_(angle), step_m_(step_m), shrink_m_(shrink_m) {
        now_ = rises ? State{{}, {0, 1, 0}, {-1, 0, 0}, {0, 0, 1}, width_m}
                     : State{{}, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}, width_m};
    }

    void read(const Letters& letters, uint32_t at) {
        const char letter = letters.text[at];
        const std::span<const double> numbers = letters.of(at);
        if (skips_ > 0 && letter != '[' && letter != ']') return;
        const double turn = numbers.empty() ? angle_ : numbers[0];
        switch (letter) {
            case '+':
                return rotate(now_.heading, now_.left, turn);
            case '-':
                return rotate(now_.heading, now_.left, -turn);
            case '&':
                return rotate(now_.heading, now_.up, -turn);
            case '^':
                return rotate(now_.heading, now_.up, turn);
            case '\\':
                return rotate(now_.left, now_.up, -turn);
            case '/':
                return rotate(now_.left, now_.up, turn);
            case '|':
                return rotate(now_.heading, now_.left, pi);
            case '$':
                return level();
            case '!':
                now_.width_m = numbers.empty() ? now_.width_m * .9 : std::max(numbers[0], 0.0);
                return;
            case '%':
                skips_ = 1;
                return;
            case '[':
                if (skips_ > 0)
                    ++skips_;
                else
                    kept_.push_back({now_, step_m_});
                return;
            case ']':
                return recall();
            default:
                return step(letters, at);
        }
    }
    std::vector<TurtleStep> take() { return std::move(steps_); }

private:
    struct State {
        Vec3d at, heading, left, up;
        double width_m;
    };

    /// Turns `a` toward `b` in their plane.
    static void rotate(Vec3d& a, Vec3d& b, double angle) {
        const double c = std::cos(angle), s = std::sin(angle);
        const Vec3d from = a;
        a = a * c + b * s;
        b = b * c - from * s;
    }
    /// Rolls until `left` lies level; upright headings stay as they are.
    void level() {
        const Vec3d flat = cross(Vec3d{0, 1, 0}, now_.heading);
        if (dot(flat, flat) < 1e-12) return;
        const double handed = dot(cross(now_.heading, now_.left), now_.up) > 0 ? 1 : -1;
        now_.left = flat / length(flat) * handed;
        now_.up = cross(now_.heading, now_.left) * handed;
    }
    void recall() {
        if (skips_ > 1) {
            --skips_;
            return;
        }
        skips_ = 0;
        if (kept_.empty()) return;
        now_ = kept_.back().first, step_m_ = kept_.back().second;
        kept_.pop_back();
    }
    void step(const Letters& letters, uint32_t at) {
        const char letter = letters.text[at];
        const std::span<const double> numbers = letters.of(at);
        TurtleStep made{letter, at, letters.keys[at], now_.at, now_.at, now_.heading, now_.left, now_.up, now_.width_m};
        const bool goes = letter == 'F' || letter == 'G' || letter == 'f' || letter == 'g';
        if (goes) {
            now_.at += now_.heading * (numbers.empty() ? step_m_ : numbers[0]);
            if (numbers.empty()) step_m_ = std::max(step_m_ - shrink_m_, 0.0);
            made.to = now_.at;
        }
        steps_.push_back(made);
    }

    double angle_, step_m_, shrink_m_;
    State now_;
    std::vector<std::pair<State, double>> kept_;
    std::vector<TurtleStep> steps_;
    uint32_t skips_ = 0;  ///< branches open since '%' cut one off
};

}  // namespace

Result<plan::Footprint> drawOutline(const rules::Lsystem& lsystem, const Place& place) {
    auto turtle = drawn(lsystem, place);
    if (!turtle.ok()) return turtle.error();
    auto outline = plan::resolved(turtle->take());
    if (!outline.ok()) return errorOf(outline.error().kind, lsystem, "draws no plan: " + outline.error().message);
    if (outline->empty())
        return errorOf(Error::Kind::Input, lsystem, "draws no outline with an area: its walls lie on one line");
    return std::move(*outline);
}

Result<plan::Footprint> drawWalls(const rules::Lsystem& lsystem, const Place& place, double width_m) {
    auto turtle = drawn(lsystem, place);
    if (!turtle.ok()) return turtle.error();
    plan::Footprint walls;
    std::vector<plan::Ring> chains = turtle->takeChains();
    const std::vector<std::string> tags = turtle->take().tags;
    for (plan::Ring& chain : chains) {
        const bool isClosed = chain.points.size() > 3 && length(chain.points.back() - chain.points.front()) < 1e-6;
        if (isClosed) chain.points.pop_back();
        auto one = plan::band(chain, tags, width_m, isClosed);
        if (!one.ok()) return errorOf(one.error().kind, lsystem, "draws no walls: " + one.error().message);
        if (!walls.empty()) one = plan::booleanInBudget(plan::Boolean::Union, walls, *one);
        if (!one.ok()) return errorOf(one.error().kind, lsystem, "draws no walls: " + one.error().message);
        walls = std::move(*one);
    }
    if (walls.empty()) return errorOf(Error::Kind::Input, lsystem, "draws no walls: it has no letter F or G");
    return walls;
}

std::vector<TurtleStep> walk(const rules::Lsystem& lsystem, const Letters& letters, const Place& place, bool rises,
                             double width_m) {
    Walker walker(number(lsystem.angle, place), number(lsystem.step, place), number(lsystem.shrink, place), rises,
                  width_m);
    for (uint32_t i = 0; i < letters.text.size(); ++i) walker.read(letters, i);
    return walker.take();
}

}  // namespace sgm::derive
