#include "grammar/derive/monitor.h"

#include <fmt/format.h>

namespace sgm::derive {

void Monitor::fail(Error::Kind kind, const std::string& what, syntax::SourceSpan span, const char* fix) {
    if (failure_) return;
    const auto& grammar = *derivation_.grammar;
    std::string text = what;
    text += rule_ == none ? std::string(" in the start") : fmt::format(" in rule '{}'", grammar.rules[rule_].name);
    if (shape_ < derivation_.tree.shapes.size()) text += fmt::format(" at {}", derivation_.tree.path(shape_));
    text += fmt::format(", seed {}", derivation_.seed);
    for (const Warning& r : derivation_.warnings)  // what was remarked in the text that fails is the cause as a rule
        if (r.span.source == span.source && r.span.begin >= span.begin && r.span.end <= span.end)
            text += "; " + r.message;
    if (*fix) text += fmt::format("; {}", fix);
    failure_ = syntax::errorAt(span, kind, text);
}

syntax::SourceSpan Monitor::here() const {
    if (rule_ != none) return derivation_.grammar->rules[rule_].span;
    return derivation_.tree.shapes.empty() ? syntax::SourceSpan{} : derivation_.tree.shapes[0].span;
}

void Monitor::poll() {
    const syntax::SourceSpan span = here();
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin_;
    if (cancelled(progress_))
        failure_ = Error{Error::Kind::Cancelled, "cancelled while deriving"};
    else if (spent.count() > budget_.seconds)
        fail(Error::Kind::Budget, fmt::format("the budget of {:g} seconds is spent", budget_.seconds), span,
             "--max-seconds allows more");
    else if (derivation_.memory() + joints_.memory() > budget_.memory_bytes)
        fail(Error::Kind::Budget, fmt::format("the budget of {} MiB of memory is spent", budget_.memory_bytes >> 20),
             span);
}

void Monitor::failOfGrowth(const std::string& what, syntax::SourceSpan span) {
    fail(Error::Kind::Budget, what, span,
         "let the rule end ('when', 'repeat'), ask for fewer, or allow more by --max-shapes");
}

void Monitor::diverge() {
    if (!failure_) failure_ = Error{Error::Kind::Internal, "the derivation takes another course"};
}

bool Monitor::work() {
    if (++turns_ % 1024 == 0) poll();
    if (turns_ > 4 * budget_.shapes + 4096 && !failure_)
        failOfGrowth(fmt::format("{} turns were made and there is no end", turns_), here());
    return !failure_;
}

}  // namespace sgm::derive
