#include "viewer/document/session.h"

#include <fmt/format.h>

#include <algorithm>

#include "modeler/core/guarded.h"

namespace sgm::document {
namespace fs = std::filesystem;
namespace {

constexpr double patience_s = 1;  ///< a request that is overtaken may run on for so long

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
        const std::lock_guard lock(mutex_);
        quit_ = true;
        if (running_) running_->cancel();
    }
    wanted_.notify_one();
    worker_.join();
}

void Session::show(ShowRequest request) {
    {
        const std::lock_guard lock(mutex_);
        pending_ = std::move(request);
        if (running_ && (meshing_ || since_.seconds() > patience_s)) running_->cancel();
    }
    wanted_.notify_one();
}

void Session::cancel() {
    const std::lock_guard lock(mutex_);
    pending_.reset();
    if (running_) running_->cancel();
}

bool Session::poll() {
    const std::lock_guard lock(mutex_);
    if (pending_ && running_ && since_.seconds() > patience_s) running_->cancel();
    if (!fresh_) return false;
    fresh_ = false;
    Update update = std::exchange(update_, Update{});
    if (update.model || update.plan) plan_ = std::move(update.plan);
    if (update.model) deferred_.push_back(std::exchange(model_, std::move(update.model)));
    if (update.mesh) deferred_.push_back(std::exchange(mesh_, std::move(update.mesh)));
    wanted_.notify_one();
    if (update.problems) problems_ = std::move(*update.problems);
    if (update.used) used_ = std::move(*update.used);
    attempted_ = std::max(attempted_, update.attempted);
    return true;
}

bool Session::busy() const {
    const std::lock_guard lock(mutex_);
    return running_ || pending_;
}

std::string_view Session::stage() const {
    const std::lock_guard lock(mutex_);
    return running_ ? running_->stage() : "";
}

double Session::fraction() const {
    const std::lock_guard lock(mutex_);
    return running_ ? running_->fraction() : 0;
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
    for (;;) {
        std::optional<ShowRequest> request;
        std::vector<std::shared_ptr<const void>> deferred;
        std::shared_ptr<Progress> progress;
        {
            std::unique_lock lock(mutex_);
            running_.reset();
            meshing_ = false;
            wanted_.wait(lock, [this] { return pending_ || quit_ || !deferred_.empty(); });
            if (quit_) return;
            deferred.swap(deferred_);
            request = std::exchange(pending_, std::nullopt);
            if (request) {
                running_ = progress = std::make_shared<Progress>();
                since_ = Stopwatch();
            }
        }
        deferred.clear();
        if (!request) continue;
        const Status done = guarded([&]() -> Status { return attempt(*request, *progress), Done{}; });
        if (!done.ok()) giveUp(*request, done.error());
    }
}

/// What an exception left half made is let go; the last good model stays.
void Session::giveUp(const ShowRequest& request, const Error& error) {
    liveEdit_.reset();
    rebuild_ = mesh::Rebuild(mesh::PolygonizeOptions{.surface = mesh::Surface::Crisp});
    ast_.reset();
    grammar_.reset();
    shown_.reset();
    handShown_.reset();
    meshed_.reset();
    Update update;
    update.attempted = request.revision;
    update.problems = std::vector<Problem>{problemOf(error)};
    publish(std::move(update));
}

bool Session::superseded() {
    const std::lock_guard lock(mutex_);
    return pending_ || quit_;
}

void Session::publish(Update update) {
    {
        const std::lock_guard lock(mutex_);
        if (update.model) update_.model = std::move(update.model);
        if (update.mesh) update_.mesh = std::move(update.mesh);
        if (update.plan) update_.plan = std::move(update.plan);
        if (update.problems) update_.problems = std::move(update.problems);
        if (update.used) update_.used = std::move(update.used);
        update_.attempted = std::max(update_.attempted, update.attempted);
        fresh_ = true;
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
    update.used = usedByCheck_;
    if (good) {
        auto shown = follow ? followed(request, problems, progress) : made(request, context, problems);
        good = shown.ok();
        if (good) {
            if (*shown != shown_) update.model = *shown;
            shown_ = *shown;
            // While a slider is dragged the last ones stay: to look for them takes as long as a frame.
            if (!follow) derivedProblems_ = problemsOf(derive::warnings(shown_->model.derivation));
            problems.insert(problems.end(), derivedProblems_.begin(), derivedProblems_.end());
        } else if (shown.error().kind != Error::Kind::Cancelled) {
            problems.push_back(problemOf(shown.error()));
        } else if (superseded()) {
            return;
        } else {
            problems.push_back(
                {syntax::Severity::Warning, {}, 0, 0, 0, 0, "cancelled: what is shown was made before", {}});
        }
    }
    update.problems = problems;
    modelProblems_ = std::move(problems);
    publish(std::move(update));
    if (good && request.meshResolution > 0) meshIt(request, progress);
}

/// No file that the grammar uses has changed since it was checked.
bool Session::asChecked() const {
    return std::none_of(usedByCheck_.begin(), usedByCheck_.end(),
                        [](const UsedFile& used) { return timeOf(used.path) != used.time; });
}

/// Whether the request can be shown by the grammar of the moment the slider was taken; else that grammar is let go.
bool Session::follows(const ShowRequest& request) {
    const bool may = request.dragging && grammar_ && !request.byHand && asChecked();
    if (!may) {
        liveEdit_.reset();
        return false;
    }
    const std::string_view text = request.ast->source->text();
    if (liveEdit_)
        if ((valueChange_ = pipeline::valueChange(*liveEdit_->grammar(), text))) return true;
    liveEdit_.reset();
    if (!(valueChange_ = pipeline::valueChange(*grammar_, text))) return false;
    liveEdit_.emplace(grammar_);
    return true;
}

/// The model of a request that `follows`.
Result<std::shared_ptr<const BuiltModel>> Session::followed(const ShowRequest& request, std::vector<Problem>& problems,
                                                            Progress& progress) {
    problems = checkProblems_;
    const rules::Grammar& grammar = *liveEdit_->grammar();
    auto options = pipeline::optionsFor(grammar, wordsOf(request.choice, grammar, problems), *valueChange_);
    if (!options.ok()) return options.error();
    options->budget = request.budget;
    BuiltModel shown;
    shown.revision = request.revision;
    shown.grammar = liveEdit_->grammar();
    shown.options = std::move(*options);
    shown.held = true;
    pipeline::Context context{&progress};
    sketchPlan(shown.grammar, shown.options, progress);
    auto model = liveEdit_->to(shown.options, context);
    if (!model.ok()) return model.error();
    shown.model = std::move(*model);
    shown.stages = std::move(context.stages);
    shown.shapesMade = liveEdit_->shapesMade();
    // What the slider stood at when it was taken is shown already.
    if (shown_ && shown_->grammar == shown.grammar && !handShown_ && sameOptions(shown_->options, shown.options))
        return shown_;
    handShown_ = nullptr;
    return finished(std::move(shown));
}

/// Parsed text to a grammar, unless neither the text nor a file it uses has changed. Adds what is wrong to `problems`.
bool Session::checked(const ShowRequest& request, pipeline::Context& context, std::vector<Problem>& problems) {
    if (request.ast != ast_ || !asChecked()) {
        std::vector<syntax::SourcePtr> sources;  // diagnostics point into them
        usedByCheck_.clear();
        rules::Loader noting = loader_;  // a copy, so that every kind of file can be read
        noting.use = [&](const std::string& name, const syntax::Source& from, std::string& why) {
            const syntax::SourcePtr source = loader_.use ? loader_.use(name, from, why) : nullptr;
            if (source) {
                sources.push_back(source);
                usedByCheck_.push_back({source->name(), timeOf(source->name())});
            }
            return source;
        };
        // `load` for a file beside the grammar, whose path and time are noted.
        const auto beside = [&](const auto& load) {
            return [&](const std::string& name, const syntax::Source& from, std::string& why) {
                const std::string path = (fs::path(from.name()).parent_path() / name).string();
                usedByCheck_.push_back({path, timeOf(path)});
                return load ? load(name, from, why) : nullptr;
            };
        };
        noting.mesh = beside(loader_.mesh);
        noting.outlines = beside(loader_.outlines);
        noting.picture = beside(loader_.picture);
        noting.streets = beside(loader_.streets);
        noting.image = beside(loader_.image);
        syntax::Diagnostics diagnostics = request.syntaxProblems;
        ast_ = request.ast;
        context.stages.emplace_back("parse", request.parseSeconds);
        grammar_ = context.timed("check", [&] { return rules::check(*request.ast, noting, diagnostics); });
        checkProblems_ = problemsOf(diagnostics);
    }
    problems = checkProblems_;
    return grammar_ != nullptr;
}

/// The model of the request: the last one where nothing it is made from has changed.
Result<std::shared_ptr<const BuiltModel>> Session::made(const ShowRequest& request, pipeline::Context& context,
                                                        std::vector<Problem>& problems) {
    auto options = pipeline::optionsFor(*grammar_, wordsOf(request.choice, *grammar_, problems));
    if (!options.ok()) return options.error();
    options->budget = request.budget;
    if (shown_ && !shown_->held && shown_->grammar == grammar_ && handShown_ == request.byHand &&
        sameOptions(shown_->options, *options))
        return shown_;
    constexpr auto objects = pipeline::Objects::Sketched;
    if (request.dragging && !request.byHand) sketchPlan(grammar_, *options, *context.progress);
    auto model = request.byHand ? pipeline::makeModel(derive::Derivation(*request.byHand), context, objects)
                                : pipeline::makeModel(grammar_, *options, context, objects);
    if (!model.ok()) return model.error();
    handShown_ = request.byHand;
    BuiltModel shown;
    shown.revision = request.revision;
    shown.grammar = grammar_;
    shown.options = std::move(*options);
    shown.model = std::move(*model);
    shown.byHand = request.byHand != nullptr;
    shown.shapesMade = shown.model.derivation.tree.shapes.size();
    shown.stages = std::move(context.stages);
    return finished(std::move(shown));
}

}  // namespace sgm::document
