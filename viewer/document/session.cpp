#include "viewer/document/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "modeler/core/guarded.h"
#include "modeler/core/pages.h"

namespace sgm::document {
namespace fs = std::filesystem;
namespace {

constexpr double patience_s = 1;  ///< a request that is overtaken may run on for so long
constexpr std::chrono::seconds restBeforeGivingBack{2};

bool sameOptions(const derive::Options& a, const derive::Options& b) {
    return a.start == b.start && a.derive == b.derive && a.params == b.params && a.seed == b.seed &&
           a.budget.shapes == b.budget.shapes && a.budget.seconds == b.budget.seconds;
}

bool sameValues(const BuiltModel& a, const BuiltModel& b) {
    return a.fingerprint == b.fingerprint && a.model.tape.lipschitz() == b.model.tape.lipschitz();
}

/// What every model has, however it was made.
std::shared_ptr<const BuiltModel> finished(BuiltModel shown) {
    shown.fingerprint = eval::fingerprint(shown.model.tape);
    return std::make_shared<const BuiltModel>(std::move(shown));
}

fs::file_time_type timeOf(const fs::path& path) {
    std::error_code failed;
    const auto time = fs::last_write_time(path, failed);
    return failed ? fs::file_time_type::min() : time;
}

/// The choice in the words of `optionsFor`; what the grammar doesn't know any more is left out, with a warning.
pipeline::ModelChoice wordsOf(const Choice& choice, const rules::Grammar& grammar, std::vector<Problem>& problems) {
    const auto known = [&](const auto& list, const std::string& name, const char* what, auto nameOf) {
        if (name.empty() || std::any_of(list.begin(), list.end(), [&](const auto& row) { return nameOf(row) == name; }))
            return name;
        problems.push_back(
            {syntax::Severity::Warning, {}, 0, 0, 0, 0, fmt::format("there is no {} '{}' any more", what, name), {}});
        return std::string();
    };
    pipeline::ModelChoice words;
    words.seed = choice.seed;
    words.start = known(grammar.starts, choice.start, "start",
                        [&](const rules::Start& s) { return grammar.symbols[s.symbol].name; });
    words.style = known(grammar.styles, choice.style, "style", [](const rules::Style& s) { return s.name; });
    words.derive = known(grammar.derives, choice.way, "derive way", [](const rules::Derive& d) { return d.name; });
    return words;
}

}  // namespace

bool looksLike(const BuiltModel& a, const BuiltModel& b) {
    const Provenance &p = a.model.lowered->provenance, &q = b.model.lowered->provenance;
    return sameValues(a, b) && p.materials == q.materials &&
           std::equal(p.parts.begin(), p.parts.end(), q.parts.begin(), q.parts.end(),
                      [](const Part& x, const Part& y) { return x.material == y.material; });
}

ShowRequest requestOf(const Document& document) {
    ShowRequest request;
    request.ast = document.ast();
    request.syntaxProblems = document.syntaxProblems();
    request.choice = document.choice();
    request.revision = document.revision();
    request.parseSeconds = document.parseSeconds();
    request.dragging = document.dragging();
    return request;
}

Session::Session(std::function<void()> notify, rules::Loader loader)
    : notify_(std::move(notify)), loader_(std::move(loader)), worker_([this] { work(); }) {}

Session::~Session() {
    {
        const std::lock_guard lock(queue_.mutex);
        queue_.quit = true;
        if (queue_.running) queue_.running->cancel();
    }
    queue_.wanted.notify_one();
    worker_.join();
}

void Session::show(ShowRequest request) {
    {
        const std::lock_guard lock(queue_.mutex);
        queue_.pending = std::move(request);
        if (queue_.running && (queue_.meshing || queue_.since.seconds() > patience_s)) queue_.running->cancel();
    }
    queue_.wanted.notify_one();
}

void Session::cancel() {
    const std::lock_guard lock(queue_.mutex);
    queue_.pending.reset();
    if (queue_.running) queue_.running->cancel();
}

bool Session::poll() {
    const std::lock_guard lock(queue_.mutex);
    if (queue_.pending && queue_.running && queue_.since.seconds() > patience_s) queue_.running->cancel();
    if (!queue_.fresh) return false;
    queue_.fresh = false;
    Update update = std::exchange(queue_.update, Update{});
    if (update.model || update.plan) plan_ = std::move(update.plan);
    if (update.model) queue_.deferred.push_back(std::exchange(model_, std::move(update.model)));
    if (update.mesh) queue_.deferred.push_back(std::exchange(mesh_, std::move(update.mesh)));
    queue_.wanted.notify_one();
    if (update.problems) problems_ = std::move(*update.problems);
    if (update.used) used_ = std::move(*update.used);
    if (update.modelled) revisions_.modelled = *update.modelled;
    revisions_.attempted = std::max(revisions_.attempted, update.attempted);
    return true;
}

bool Session::busy() const {
    const std::lock_guard lock(queue_.mutex);
    return queue_.running || queue_.pending;
}

std::string_view Session::stage() const {
    const std::lock_guard lock(queue_.mutex);
    return queue_.running ? queue_.running->stage() : "";
}

double Session::fraction() const {
    const std::lock_guard lock(queue_.mutex);
    return queue_.running ? queue_.running->fraction() : 0;
}

bool Session::usedFilesChanged() const {
    return std::any_of(used_.begin(), used_.end(), [](const UsedFile& used) { return timeOf(used.path) != used.time; });
}

std::vector<std::filesystem::path> Session::usedFiles() const {
    std::vector<std::filesystem::path> files;
    for (const UsedFile& used : used_) files.push_back(used.path);
    return files;
}

void Session::work() {
    bool worked = false;  // since memory was given back
    for (;;) {
        std::optional<ShowRequest> request;
        std::vector<std::shared_ptr<const void>> deferred;
        std::shared_ptr<Progress> progress;
        bool forgets = false;
        {
            std::unique_lock lock(queue_.mutex);
            queue_.running.reset();
            queue_.meshing = false;
            const auto asked = [this] { return queue_.pending || queue_.quit || !queue_.deferred.empty(); };
            if (worked && !queue_.wanted.wait_for(lock, restBeforeGivingBack, asked)) {
                lock.unlock();
                releaseHeap();
                worked = false;
                continue;
            }
            queue_.wanted.wait(lock, asked);
            if (queue_.quit) return;
            worked = true;
            deferred.swap(queue_.deferred);
            forgets = std::exchange(queue_.forgetsMesh, false);
            request = std::exchange(queue_.pending, std::nullopt);
            if (request) {
                queue_.running = progress = std::make_shared<Progress>();
                queue_.since = Stopwatch();
            }
        }
        deferred.clear();
        if (forgets) last_.forgetMesh();
        if (!request) continue;
        const Status done = guarded([&]() -> Status { return attempt(*request, *progress), Done{}; });
        if (!done.ok()) giveUp(*request, done.error());
    }
}

/// What an exception left half made is let go; the last good model stays.
void Session::giveUp(const ShowRequest& request, const Error& error) {
    last_.liveEdit.reset();
    last_.forgetMesh();
    last_.ast.reset();
    last_.grammar.reset();
    last_.shown.reset();
    last_.handShown.reset();
    Update update;
    update.attempted = request.revision;
    update.problems = std::vector<Problem>{problemOf(error)};
    publish(std::move(update));
}

void Session::publish(Update update) {
    {
        const std::lock_guard lock(queue_.mutex);
        if (update.model) queue_.update.model = std::move(update.model);
        if (update.mesh && !queue_.forgetsMesh) queue_.update.mesh = std::move(update.mesh);
        if (update.plan) queue_.update.plan = std::move(update.plan);
        if (update.problems) queue_.update.problems = std::move(update.problems);
        if (update.used) queue_.update.used = std::move(update.used);
        queue_.update.attempted = std::max(queue_.update.attempted, update.attempted);
        if (update.modelled) queue_.update.modelled = update.modelled;
        queue_.fresh = true;
    }
    if (notify_) notify_();
}

/// Where a slider is dragged over a town, its plan is there long before its buildings.
void Session::sketchPlan(const std::shared_ptr<const rules::Grammar>& grammar, derive::Options options,
                         Progress& progress) {
    if (grammar->roads.empty()) return;
    options.planAlone = true;
    auto laid = derive::derive(grammar, options, &progress);
    if (!laid.ok() || laid->plan.empty()) return;  // what is wrong is told of the model
    Update update;
    update.plan = std::make_shared<const town::TownPlan>(std::move(laid->plan));
    publish(std::move(update));
}

std::shared_ptr<const town::TownPlan> Session::plan() const {
    if (plan_ || !model_ || model_->model.derivation.plan.empty()) return plan_;
    return {model_, &model_->model.derivation.plan};
}

void Session::attempt(const ShowRequest& request, Progress& progress) {
    pipeline::Context context{&progress};
    std::vector<Problem> problems;
    Update update;
    update.attempted = request.revision;
    const bool follow = follows(request);
    bool good = follow || checked(request, context, problems);
    update.used = last_.usedByCheck;
    if (good) {
        auto shown = follow ? followed(request, problems, progress) : made(request, context, problems);
        good = shown.ok();
        if (good) {
            if (*shown != last_.shown) update.model = *shown;
            update.modelled = request.revision;
            last_.shown = *shown;
            // While a slider is dragged the last ones stay: to look for them takes as long as a frame.
            if (!follow) last_.problems.derived = problemsOf(derive::warnings(last_.shown->model.derivation));
            problems.insert(problems.end(), last_.problems.derived.begin(), last_.problems.derived.end());
        } else if (shown.error().kind != Error::Kind::Cancelled) {
            problems.push_back(problemOf(shown.error()));
        } else if (queue_.isSuperseded()) {
            return;
        } else {
            problems.push_back(
                {syntax::Severity::Warning, {}, 0, 0, 0, 0, "cancelled: what is shown was made before", {}});
        }
    }
    update.problems = problems;
    last_.problems.model = std::move(problems);
    publish(std::move(update));
    if (good && request.meshResolution > 0) meshIt(request, progress);
}

bool Session::Last::isAsChecked() const {
    return std::none_of(usedByCheck.begin(), usedByCheck.end(),
                        [](const UsedFile& used) { return timeOf(used.path) != used.time; });
}

/// Whether the request can be shown by the grammar of the moment the slider was taken; else that grammar is let go.
bool Session::follows(const ShowRequest& request) {
    const bool may = request.dragging && last_.grammar && !request.byHand && last_.isAsChecked();
    if (!may) {
        last_.liveEdit.reset();
        return false;
    }
    const std::string_view text = request.ast->source->text();
    if (last_.liveEdit)
        if ((last_.valueChange = pipeline::valueChange(*last_.liveEdit->grammar(), text))) return true;
    last_.liveEdit.reset();
    if (!(last_.valueChange = pipeline::valueChange(*last_.grammar, text))) return false;
    last_.liveEdit.emplace(last_.grammar);
    return true;
}

/// The model of a request that `follows`.
Result<std::shared_ptr<const BuiltModel>> Session::followed(const ShowRequest& request, std::vector<Problem>& problems,
                                                            Progress& progress) {
    problems = last_.problems.check;
    const rules::Grammar& grammar = *last_.liveEdit->grammar();
    auto options = pipeline::optionsFor(grammar, wordsOf(request.choice, grammar, problems), *last_.valueChange);
    if (!options.ok()) return options.error();
    options->budget = request.budget;
    BuiltModel shown;
    shown.revision = request.revision;
    shown.grammar = last_.liveEdit->grammar();
    shown.options = std::move(*options);
    shown.held = true;
    pipeline::Context context{&progress};
    sketchPlan(shown.grammar, shown.options, progress);
    auto model = last_.liveEdit->to(shown.options, context);
    if (!model.ok()) return model.error();
    shown.model = std::move(*model);
    shown.stages = std::move(context.stages);
    shown.shapesMade = last_.liveEdit->shapesMade();
    // What the slider stood at when it was taken is shown already.
    if (last_.shown && last_.shown->grammar == shown.grammar && !last_.handShown &&
        sameOptions(last_.shown->options, shown.options))
        return last_.shown;
    last_.handShown = nullptr;
    return finished(std::move(shown));
}

/// Parsed text to a grammar, unless neither the text nor a file it uses has changed. Adds what is wrong to `problems`.
bool Session::checked(const ShowRequest& request, pipeline::Context& context, std::vector<Problem>& problems) {
    if (request.ast != last_.ast || !last_.isAsChecked()) {
        std::vector<syntax::SourcePtr> sources;  // diagnostics point into them
        last_.usedByCheck.clear();
        rules::Loader noting = loader_;  // a copy, so that every kind of file can be read
        noting.use = [&](const std::string& name, const syntax::Source& from, std::string& why) {
            const syntax::SourcePtr source = loader_.use ? loader_.use(name, from, why) : nullptr;
            if (source) {
                sources.push_back(source);
                last_.usedByCheck.push_back({source->name(), timeOf(source->name())});
            }
            return source;
        };
        // `load` for a file beside the grammar, whose path and time are noted.
        const auto beside = [&](const auto& load) {
            return [&](const std::string& name, const syntax::Source& from, std::string& why) {
                const std::string path = (fs::path(from.name()).parent_path() / name).string();
                last_.usedByCheck.push_back({path, timeOf(path)});
                return load ? load(name, from, why) : nullptr;
            };
        };
        noting.mesh = beside(loader_.mesh);
        noting.outlines = beside(loader_.outlines);
        noting.picture = beside(loader_.picture);
        noting.streets = beside(loader_.streets);
        noting.image = beside(loader_.image);
        syntax::Diagnostics diagnostics = request.syntaxProblems;
        last_.ast = request.ast;
        context.stages.emplace_back("parse", request.parseSeconds);
        last_.grammar = context.timed("check", [&] { return rules::check(*request.ast, noting, diagnostics); });
        last_.problems.check = problemsOf(diagnostics);
    }
    problems = last_.problems.check;
    return last_.grammar != nullptr;
}

/// The model of the request: the last one where nothing it is made from has changed.
Result<std::shared_ptr<const BuiltModel>> Session::made(const ShowRequest& request, pipeline::Context& context,
                                                        std::vector<Problem>& problems) {
    auto options = pipeline::optionsFor(*last_.grammar, wordsOf(request.choice, *last_.grammar, problems));
    if (!options.ok()) return options.error();
    options->budget = request.budget;
    if (last_.shown && !last_.shown->held && last_.shown->grammar == last_.grammar &&
        last_.handShown == request.byHand && sameOptions(last_.shown->options, *options))
        return last_.shown;
    constexpr auto objects = pipeline::Objects::Sketched;
    if (request.dragging && !request.byHand) sketchPlan(last_.grammar, *options, *context.progress);
    auto model = request.byHand ? pipeline::makeModel(derive::Derivation(*request.byHand), context, objects)
                                : pipeline::makeModel(last_.grammar, *options, context, objects);
    if (!model.ok()) return model.error();
    last_.handShown = request.byHand;
    BuiltModel shown;
    shown.revision = request.revision;
    shown.grammar = last_.grammar;
    shown.options = std::move(*options);
    shown.model = std::move(*model);
    shown.byHand = request.byHand != nullptr;
    shown.shapesMade = shown.model.derivation.tree.shapes.size();
    shown.stages = std::move(context.stages);
    return finished(std::move(shown));
}

}  // namespace sgm::document
