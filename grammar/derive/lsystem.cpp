#include "grammar/derive/lsystem.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grammar/derive/builder.h"
#include "modeler/core/conventions.h"
#include "modeler/core/random.h"
#include "modeler/plan/edit.h"
#include "modeler/plan/validate.h"

namespace sgm::derive {
namespace {

struct Letter {
    char text;
    uint64_t key;  ///< names its draws: the way of productions that made it
};

/// The production that rewrites a letter, or null; one of several by their weights.
const rules::Lsystem::Production* productionFor(const rules::Lsystem& lsystem, const Letter& letter) {
    double total = 0;
    for (const auto& p : lsystem.productions)
        if (p.letter == letter.text) total += p.weight;
    if (total <= 0) return nullptr;
    double drawn = uniform(letter.key) * total;
    const rules::Lsystem::Production* last = nullptr;
    for (const auto& p : lsystem.productions) {
        if (p.letter != letter.text || p.weight <= 0) continue;
        last = &p;
        if ((drawn -= p.weight) < 0) break;
    }
    return last;
}

/// What a turtle draws, one outline after the other.
class Turtle {
public:
    Turtle(double angle, double step_m, double shrink_m) : angle_(angle), step_m_(step_m), shrink_m_(shrink_m) {}

    void read(char letter) {
        switch (letter) {
            case 'F':
            case 'G':
                return draw();
            case 'f':
            case 'g':
                return jump();
            case '+':
                heading_ += angle_;
                return;
            case '-':
                heading_ -= angle_;
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

    void draw() {
        if (ring_.points.empty()) ring_.points.push_back(at_);
        advance();
        ring_.points.push_back(at_);
        ring_.edges.emplace_back();
    }
    void jump() {
        finish();
        advance();
    }
    void advance() {
        at_ = at_ + plan::Vec2{std::cos(heading_), std::sin(heading_)} * step_m_;
        step_m_ = std::max(step_m_ - shrink_m_, 0.0);
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
    std::vector<Kept> kept_;
};

Error errorOf(Error::Kind kind, const rules::Lsystem& lsystem, std::string_view what) {
    return {kind, fmt::format("the lsystem '{}' {}", lsystem.name, what)};
}

}  // namespace

Result<std::string> rewritten(const rules::Lsystem& lsystem, const Place& place) {
    const double passes = std::floor(number(lsystem.passes, place));
    constexpr size_t lettersPerTurn = 64;  // of the derivation's budget, which also looks for a cancel
    std::vector<Letter> letters, next;
    size_t read = 0;
    const uint64_t seed = combine(place.key, hashText(lsystem.name));
    const auto isDrawn = [](const auto& production) { return production.weight != 1; };
    if (place.builder && std::any_of(lsystem.productions.begin(), lsystem.productions.end(), isDrawn))
        place.builder->noteChance();
    for (size_t i = 0; i < lsystem.axiom.size(); ++i) letters.push_back({lsystem.axiom[i], combine(seed, i)});
    for (double pass = 0; pass < passes; ++pass) {
        next.clear();
        bool changed = false;
        for (const Letter& letter : letters) {
            const auto* production = productionFor(lsystem, letter);
            if (!production) {
                next.push_back(letter);
                continue;
            }
            changed = true;
            for (size_t i = 0; i < production->text.size(); ++i)
                next.push_back({production->text[i], combine(letter.key, i + 1)});
            if (next.size() > mostLetters)
                return errorOf(
                    Error::Kind::Budget, lsystem,
                    fmt::format("has more than {} letters after {} passes; give it fewer", mostLetters, pass + 1));
            if (++read % lettersPerTurn == 0 && place.builder && !place.builder->work())
                return errorOf(Error::Kind::Budget, lsystem, "takes too long");
        }
        std::swap(letters, next);
        if (!changed) break;
    }
    std::string text;
    for (const Letter& letter : letters) text += letter.text;
    return text;
}

Result<plan::Footprint> drawOutline(const rules::Lsystem& lsystem, const Place& place) {
    const auto letters = rewritten(lsystem, place);
    if (!letters.ok()) return letters.error();
    const auto walls = std::count_if(letters->begin(), letters->end(), [](char c) { return c == 'F' || c == 'G'; });
    if (walls > mostWalls)
        return errorOf(Error::Kind::Budget, lsystem,
                       fmt::format("draws {} walls, more than {}; give it fewer passes", walls, mostWalls));
    Turtle turtle(number(lsystem.angle, place), number(lsystem.step, place), number(lsystem.shrink, place));
    for (const char letter : *letters) turtle.read(letter);
    auto outline = plan::resolved(turtle.take());
    if (!outline.ok()) return errorOf(outline.error().kind, lsystem, "draws no plan: " + outline.error().message);
    if (outline->empty())
        return errorOf(Error::Kind::Input, lsystem, "draws no outline with an area: its walls lie on one line");
    return std::move(*outline);
}

}  // namespace sgm::derive
