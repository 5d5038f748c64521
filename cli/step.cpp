// sgm step: a derivation by hand, from commands on stdin.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdio>
#include <iostream>

#include "cli/commands.h"
#include "cli/requests.h"
#include "cli/watch.h"
#include "grammar/derive/print.h"
#include "grammar/derive/session.h"
#include "grammar/derive/way.h"
#include "grammar/pipeline/files.h"
#include "modeler/core/atomic_file.h"
#include "viewer/document/stepper.h"

namespace sgm::cli {
namespace {

constexpr const char* commandList = R"(Commands, one a line:
  NUMBER             apply the rule of that number in the list
  RULE [at PATH]     apply a rule, written as in a `derive` line; several with => between
  rest               go on automatically until no rule matches
  undo, redo         take a step back, or do it again
  list               the live shapes and the rules that match each
  tree               the shape tree
  way [NAME]         print the way so far as a `derive` line
  save NAME          write that line into FILE; the rest of the file stays as it is
  help, quit         also Ctrl-D
)";

/// A dialogue about one derivation.
class Dialogue {
public:
    Dialogue(const ModelRequest& request, std::shared_ptr<const rules::Grammar> grammar, derive::Session session)
        : request_(request), grammar_(std::move(grammar)), session_(std::move(session)) {}

    /// Reads commands to their end. At a terminal it goes on after a mistake, otherwise it stops there with 1.
    int run();

private:
    Status execute(const std::string& line);
    Status applyAll(std::string_view steps);
    Status applyOne(std::string_view step);
    Status applyNumber(size_t number);
    /// What stood before a step.
    struct Before {
        size_t shapes = 0;
        std::vector<uint64_t> closed;  ///< Derivation::closed, their counts
    };
    Before now() const;
    Status applied(const Status& done, const Before& before);
    Result<std::string> wayLine(const std::string& name) const;
    Status save(const std::string& name);
    void list();

    ModelRequest request_;
    std::shared_ptr<const rules::Grammar> grammar_;
    derive::Session session_;
    std::vector<derive::Application> listed_;  ///< what the numbers of the list mean
};

std::string_view trimmed(std::string_view text) {
    const size_t begin = text.find_first_not_of(" \t\r");
    return begin == std::string_view::npos ? std::string_view()
                                           : text.substr(begin, text.find_last_not_of(" \t\r") + 1 - begin);
}

Error refusal(std::string what) { return Error{Error::Kind::Input, std::move(what)}; }

void Dialogue::list() {
    listed_.clear();
    const derive::ShapeTree& tree = session_.tree();
    const auto live = session_.live();
    for (const derive::ShapeId s : live) {
        const Vec3d size = tree.shapes[s].scope.size;
        fmt::print("{}  {}, {:.4g} x {:.4g} x {:.4g} m\n", tree.path(s), grammar_->symbols[tree.shapes[s].symbol].name,
                   size.x, size.y, size.z);
        const auto rules = session_.rulesFor(s);
        const std::string closed = derive::closedBy(session_.underWay(), session_.blockedAt(s));
        if (rules.empty()) fmt::print("      no rule matches{}\n", closed.empty() ? closed : ": " + closed);
        for (const uint32_t r : rules) {
            listed_.push_back({r, s});
            const syntax::SourceSpan span = grammar_->rules[r].span;
            fmt::print("{:5} {}  {}, line {}\n", listed_.size(), grammar_->rules[r].name, span.source->name(),
                       span.source->place(span.begin).line);
        }
    }
    if (live.empty()) fmt::print("nothing is live: every shape is finished\n");
}

Dialogue::Before Dialogue::now() const {
    Before before{session_.tree().shapes.size(), {}};
    for (const derive::Closed& c : session_.underWay().closed) before.closed.push_back(c.count);
    return before;
}

/// Says what a step made, where a closed joint kept something from growing, and what may follow.
Status Dialogue::applied(const Status& done, const Before& before) {
    if (!done.ok()) return done;
    const size_t made = session_.tree().shapes.size() - before.shapes;
    fmt::print("{} new shape{}\n", made, made == 1 ? "" : "s");
    const auto& closed = session_.underWay().closed;
    for (size_t i = 0; i < closed.size(); ++i) {
        if (i < before.closed.size() && closed[i].count == before.closed[i]) continue;
        const std::string closer = derive::closedBy(session_.underWay(), closed[i]);
        fmt::print("{}nothing grew here: {}\n", syntax::placeText(closed[i].span),
                   closer.empty() ? "its joint is closed" : closer);
    }
    list();
    return Done{};
}

Status Dialogue::applyNumber(size_t number) {
    if (number == 0 || number > listed_.size())
        return refusal(listed_.empty()
                           ? "no rule matches a live shape"
                           : fmt::format("there is no number {} in the list: it has 1 to {}", number, listed_.size()));
    const Before before = now();
    Watch watch(false);
    return applied(session_.apply(listed_[number - 1], watch.progress()), before);
}

/// RULE [at PATH]
Status Dialogue::applyOne(std::string_view step) {
    const size_t end = std::min(step.find_first_of(" \t"), step.size());
    const std::string name(step.substr(0, end));
    const std::string_view rest = trimmed(step.substr(end));
    if (!rest.empty() && !rest.starts_with("at "))
        return refusal(fmt::format("'{}' is no step: write RULE or RULE at PATH, or 'help'", step));
    const std::string place(rest.empty() ? rest : trimmed(rest.substr(3)));
    std::vector<std::string> known;
    for (uint32_t r = 0; r < grammar_->rules.size(); ++r) {
        known.push_back(grammar_->rules[r].name);
        if (known.back() != name) continue;
        const auto shape = session_.meant(r, place);
        if (!shape.ok()) return shape.error();
        const Before before = now();
        Watch watch(false);
        return applied(session_.apply({r, *shape}, watch.progress()), before);
    }
    const std::string near = syntax::didYouMean(name, known);
    return refusal(fmt::format("no command and no rule is called '{}'{}", name,
                               near.empty() ? ": write 'help'" : fmt::format(" (did you mean '{}'?)", near)));
}

Status Dialogue::applyAll(std::string_view steps) {
    while (true) {
        const size_t arrow = steps.find("=>");
        if (const Status s = applyOne(trimmed(steps.substr(0, arrow))); !s.ok() || arrow == std::string_view::npos)
            return s;
        steps.remove_prefix(arrow + 2);
    }
}

Result<std::string> Dialogue::wayLine(const std::string& name) const {
    if (!session_.canUndo()) return refusal("no rule was applied yet, so there is no way to show");
    const auto way = session_.way();
    if (!way.ok()) return way.error();
    return derive::wayText(*grammar_, name, *way);
}

/// Writes the way into the file, unless the file has changed since, or the line wouldn't lead to this very tree.
Status Dialogue::save(const std::string& name) {
    if (const Status s = checkUnchanged(request_.file, *grammar_); !s.ok()) return s;
    const auto options = optionsFor(*grammar_, request_);
    if (!options.ok()) return options.error();
    const auto saved = document::withWay(session_, *grammar_, *options, name, pipeline::fileLoader());
    if (!saved.ok()) return saved.error();
    if (const Status s = writeFile(request_.file, saved->text); !s.ok()) return s;
    grammar_ = saved->grammar;
    fmt::print("saved; run it with: sgm tree {} --derive {}{}\n", request_.file, name,
               request_.seed == 1 ? "" : fmt::format(" --seed {}", request_.seed));
    return Done{};
}

Status Dialogue::execute(const std::string& line) {
    const std::string_view text = trimmed(line);
    const size_t end = std::min(text.find_first_of(" \t"), text.size());
    const std::string_view word = text.substr(0, end), rest = trimmed(text.substr(end));
    size_t number = 0;
    if (const auto [stop, bad] = std::from_chars(text.data(), text.data() + text.size(), number);
        bad == std::errc() && stop == text.data() + text.size())
        return applyNumber(number);
    if (word == "apply") return execute(std::string(rest));
    if (word == "save") return rest.empty() ? Status(refusal("write 'save NAME'")) : save(std::string(rest));
    if (word == "way") {
        const auto way = wayLine(rest.empty() ? "way" : std::string(rest));
        if (way.ok()) fmt::print("{}", *way);
        return way.ok() ? Status(Done{}) : way.error();
    }
    if (!rest.empty()) return applyAll(text);
    if (word.empty() || word == "list") return list(), Done{};
    if (word == "help") return fmt::print("{}", commandList), Done{};
    if (word == "tree") {
        const auto d = session_.derivation();
        if (d.ok()) fmt::print("{}", derive::toText(*d, false));
        return d.ok() ? Status(Done{}) : d.error();
    }
    if (word == "undo" || word == "redo") {
        if (!(word == "undo" ? session_.canUndo() : session_.canRedo()))
            return refusal(fmt::format("there is nothing to {}", word));
        if (const Status s = word == "undo" ? session_.undo() : session_.redo(); !s.ok()) return s;
        return list(), Done{};
    }
    if (word == "rest") {
        const Before before = now();
        Watch watch(false);
        return applied(session_.applyRest(watch.progress()), before);
    }
    return applyAll(text);
}

int Dialogue::run() {
    const bool person = isatty(STDIN_FILENO);
    list();
    std::string line;
    const auto prompt = [&] {
        if (person) fmt::print("> ");
        std::fflush(stdout);
    };
    for (prompt(); std::getline(std::cin, line); prompt()) {
        const std::string_view word = trimmed(line);
        if (word == "quit" || word == "exit") return 0;
        if (word.starts_with("//") || (word.empty() && !person)) continue;
        const Status done = execute(line);
        std::fflush(stdout);
        if (!done.ok())
            if (const int code = fail(done.error()); !person) return code;
    }
    if (person) fmt::print("\n");
    return 0;
}

int step(const ModelRequest& request) {
    Context context;
    const auto loaded = loadGrammar(request, context);
    if (!loaded.ok()) return fail(loaded.error());
    const std::shared_ptr<const rules::Grammar>& grammar = *loaded;
    const auto options = optionsFor(*grammar, request);
    if (!options.ok()) return fail(options.error());
    auto session = derive::Session::begin(grammar, *options);
    if (!session.ok()) return fail(session.error());
    if (!options->derive.empty()) {
        const auto way = std::find_if(grammar->derives.begin(), grammar->derives.end(),
                                      [&](const auto& d) { return d.name == options->derive; });
        for (const rules::Derive::Step& s : way->steps) {
            const auto shape = session->meant(s.rule, s.place);
            if (!shape.ok()) return fail(shape.error());
            if (const Status done = session->apply({s.rule, *shape}); !done.ok()) return fail(done.error());
        }
    }
    return Dialogue(request, grammar, std::move(*session)).run();
}

}  // namespace

void addStep(CLI::App& app, int& exitCode) {
    CLI::App* command = app.add_subcommand("step", "Derive by hand: apply rules one at a time, undo, save the way");
    auto request = std::make_shared<ModelRequest>();
    addModelOptions(*command, *request);
    command->footer(std::string(commandList) +
                    "\nWith --derive the way's steps are done first. Commands may come from a pipe; it ends at the "
                    "first that fails.\n\n"
                    "Examples:\n  sgm step examples/figure1.sgm\n"
                    "  printf 'R0\\nR2 => R4\\ntree\\n' | sgm step examples/figure1.sgm\n"
                    "  echo rest | sgm step examples/tower.sgm --set floors=3");
    command->callback([request, &exitCode] { exitCode = step(*request); });
}

}  // namespace sgm::cli
