#include "grammar/derive/lsystem.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "grammar/derive/builder.h"
#include "modeler/core/random.h"

namespace sgm::derive {
namespace {

using Production = rules::Lsystem::Production;
using Module = rules::Lsystem::Module;

Error errorOf(Error::Kind kind, const rules::Lsystem& lsystem, std::string_view what) {
    return {kind, fmt::format("the lsystem '{}' {}", lsystem.name, what)};
}

/// Turtle commands, which letters that stand beside each other are looked for past.
bool isCommand(char letter) { return !std::isalnum(static_cast<unsigned char>(letter)) && letter != '_'; }

/// The letters that stand beside each one, past commands and branches; 0 where none does.
struct Beside {
    std::string before, behind;
};
Beside neighboursOf(const std::string& text) {
    Beside beside{std::string(text.size(), '\0'), std::string(text.size(), '\0')};
    std::vector<char> kept;
    char last = 0;
    for (size_t i = 0; i < text.size(); ++i) {
        beside.before[i] = last;
        if (text[i] == '[') {
            kept.push_back(last);
        } else if (text[i] == ']') {
            if (!kept.empty()) last = kept.back(), kept.pop_back();
        } else if (!isCommand(text[i])) {
            last = text[i];
        }
    }
    // Behind a letter comes the next one of its own branch.
    kept.clear();
    char next = 0;
    for (size_t i = text.size(); i-- > 0;) {
        beside.behind[i] = next;
        if (text[i] == ']') {
            kept.push_back(next);
            next = 0;
        } else if (text[i] == '[') {
            if (!kept.empty()) next = kept.back(), kept.pop_back();
        } else if (!isCommand(text[i])) {
            next = text[i];
        }
    }
    return beside;
}

/// Rewrites letters pass by pass.
class Rewriting {
public:
    Rewriting(const rules::Lsystem& lsystem, const Place& place) : lsystem_(lsystem), place_(place) {
        for (const Production& p : lsystem.productions) {
            of_[static_cast<unsigned char>(p.letter)].push_back(&p);
            asksBeside_ = asksBeside_ || p.before || p.behind;
        }
    }

    Result<Letters> run(double mostPasses) {
        const uint64_t seed = combine(place_.key, hashText(lsystem_.name));
        begin(next_);
        for (size_t i = 0; i < lsystem_.axiom.size(); ++i) put(lsystem_.axiom[i], combine(seed, i), {});
        end();
        const double passes = std::min(std::floor(number(lsystem_.passes, place_)), mostPasses);
        for (double pass = 0; pass < passes; ++pass) {
            const auto changed = rewrite(pass);
            if (!changed.ok()) return changed.error();
            if (!*changed) break;
        }
        return std::move(now_);
    }

private:
    static void begin(Letters& letters) {
        letters.text.clear(), letters.from.clear(), letters.numbers.clear(), letters.keys.clear();
    }
    void put(const Module& module, uint64_t key, std::span<const rules::Value> locals) {
        next_.text += module.letter;
        next_.keys.push_back(key);
        next_.from.push_back(static_cast<uint32_t>(next_.numbers.size()));
        if (module.args.empty()) return;
        Place at = place_;
        at.locals = locals;
        at.key = key;
        for (const rules::Expr& arg : module.args) next_.numbers.push_back(number(arg, at));
    }
    void end() {
        next_.from.push_back(static_cast<uint32_t>(next_.numbers.size()));
        std::swap(now_, next_);
    }

    /// The letter's numbers as the values that a production reads.
    std::span<const rules::Value> localsOf(size_t i) {
        locals_.clear();
        for (const double n : now_.of(i)) locals_.push_back(rules::Value::number(n));
        return locals_;
    }

    bool fits(const Production& p, size_t i, std::span<const rules::Value> locals) const {
        if (p.parameters > 0 && p.parameters != locals.size()) return false;
        if (p.before && p.before != beside_.before[i]) return false;
        if (p.behind && p.behind != beside_.behind[i]) return false;
        if (!p.when) return true;
        Place at = place_;
        at.locals = locals;
        at.key = now_.keys[i];
        return holds(*p.when, at);
    }

    /// The production that rewrites a letter, or null; one of several by their weights.
    const Production* productionFor(size_t i, std::span<const rules::Value> locals) {
        fitting_.clear();
        double total = 0;
        for (const Production* p : of_[static_cast<unsigned char>(now_.text[i])])
            if (p->weight > 0 && fits(*p, i, locals)) fitting_.push_back(p), total += p->weight;
        if (fitting_.size() < 2) return fitting_.empty() ? nullptr : fitting_[0];
        if (place_.builder) place_.builder->monitor().noteChance();
        double drawn = uniform(now_.keys[i]) * total;
        for (const Production* p : fitting_)
            if ((drawn -= p->weight) < 0) return p;
        return fitting_.back();
    }

    Result<bool> rewrite(double pass) {
        constexpr size_t lettersPerTurn = 64;  // of the derivation's budget, which also looks for a cancel
        bool changed = false;
        begin(next_);
        if (asksBeside_) beside_ = neighboursOf(now_.text);
        for (size_t i = 0; i < now_.text.size(); ++i) {
            const auto locals = localsOf(i);
            const Production* production = productionFor(i, locals);
            if (!production) {
                next_.text += now_.text[i];
                next_.keys.push_back(now_.keys[i]);
                next_.from.push_back(static_cast<uint32_t>(next_.numbers.size()));
                for (const double n : now_.of(i)) next_.numbers.push_back(n);
            } else {
                changed = true;
                for (size_t k = 0; k < production->modules.size(); ++k)
                    put(production->modules[k], combine(now_.keys[i], k + 1), locals);
            }
            if (next_.text.size() > mostLetters)
                return errorOf(
                    Error::Kind::Budget, lsystem_,
                    fmt::format("has more than {} letters after {} passes; give it fewer", mostLetters, pass + 1));
            if (++read_ % lettersPerTurn == 0 && place_.builder && !place_.builder->monitor().work())
                return errorOf(Error::Kind::Budget, lsystem_, "takes too long");
        }
        end();
        return changed;
    }

    const rules::Lsystem& lsystem_;
    const Place& place_;
    std::array<std::vector<const Production*>, 256> of_;
    bool asksBeside_ = false;
    Letters now_, next_;
    Beside beside_;
    std::vector<rules::Value> locals_;
    std::vector<const Production*> fitting_;
    size_t read_ = 0;
};

}  // namespace

Result<Letters> rewritten(const rules::Lsystem& lsystem, const Place& place, double mostPasses) {
    return Rewriting(lsystem, place).run(mostPasses);
}

}  // namespace sgm::derive
