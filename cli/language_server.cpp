// sgm lsp: the language server on the standard streams.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <charconv>
#include <condition_variable>
#include <cstdio>
#include <deque>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <thread>

#include "cli/commands.h"
#include "cli/messages.h"
#include "cli/trials.h"
#include "grammar/derive/derive.h"
#include "grammar/language/server.h"
#include "grammar/pipeline/checks.h"
#include "grammar/pipeline/files.h"
#include "modeler/core/guarded.h"

namespace sgm::cli {
namespace {

using Json = nlohmann::json;
constexpr size_t mostMessage_bytes = 64u << 20;
constexpr std::chrono::milliseconds settled{300};  ///< models of a text that is still being typed aren't tried

/// A member of what may be anything; null where there is none.
const Json& memberOf(const Json& json, const char* name) {
    static const Json null;
    const auto found = json.is_object() ? json.find(name) : json.end();
    return json.is_object() && found != json.end() ? *found : null;
}

bool isCalled(const Json& message, const char* method) { return memberOf(message, "method") == method; }

/// The next message's text; nothing at the stream's end, or where what comes is no message.
std::optional<std::string> readMessage(std::FILE* stream) {
    size_t length = 0;
    bool known = false;
    std::string line;
    for (int c; (c = std::fgetc(stream)) != EOF;) {
        if (c != '\n') {
            if (line.size() < 4096) line += static_cast<char>(c);
            continue;
        }
        if (line == "\r" || line.empty()) {
            if (!known || length > mostMessage_bytes) return std::nullopt;
            std::string text(length, '\0');
            if (std::fread(text.data(), 1, length, stream) != length) return std::nullopt;
            return text;
        }
        constexpr std::string_view header = "Content-Length:";
        if (line.starts_with(header)) {
            const size_t digits = std::min(line.find_first_of("0123456789"), line.size());
            known = std::from_chars(line.data() + digits, line.data() + line.size(), length).ec == std::errc();
        }
        line.clear();
    }
    return std::nullopt;
}

void writeMessage(const Json& message) {
    const std::string text = message.dump(-1, ' ', false, Json::error_handler_t::replace);
    std::fprintf(stdout, "Content-Length: %zu\r\n\r\n", text.size());
    std::fwrite(text.data(), 1, text.size(), stdout);
    std::fflush(stdout);
}

/// Messages between the thread that reads them and the one that answers.
class Queue {
public:
    void push(Json message) {
        const std::lock_guard lock(mutex_);
        if (isCalled(message, "$/cancelRequest")) {
            cancelled_.insert(textOf(memberOf(memberOf(message, "params"), "id")));
        } else {
            messages_.push_back(std::move(message));
        }
        changed_.notify_one();
    }

    void close() {
        const std::lock_guard lock(mutex_);
        closed_ = true;
        changed_.notify_one();
    }

    /// Tells who waits that a trial has ended.
    void noteTrial() {
        const std::lock_guard lock(mutex_);
        trialEnded_ = true;
        changed_.notify_one();
    }

    struct Taken {
        Json message;
        bool cancelled = false;   ///< the client wants no answer any more
        bool superseded = false;  ///< a later change of the same text waits already
    };

    /// The next message, waiting for it so long; nothing when none came or a trial has ended. `closed` says that none
    /// will.
    std::optional<Taken> take(std::optional<std::chrono::milliseconds> patience, bool& closed) {
        std::unique_lock lock(mutex_);
        const auto ready = [this] { return closed_ || trialEnded_ || !messages_.empty(); };
        if (patience)
            changed_.wait_for(lock, *patience, ready);
        else
            changed_.wait(lock, ready);
        trialEnded_ = false;
        closed = closed_ && messages_.empty();
        if (messages_.empty()) return std::nullopt;
        Taken taken{std::move(messages_.front())};
        messages_.pop_front();
        const Json& id = memberOf(taken.message, "id");
        taken.cancelled = !id.is_null() && cancelled_.erase(textOf(id)) > 0;
        taken.superseded = isSuperseded(taken.message);
        return taken;
    }

private:
    static std::string textOf(const Json& id) { return id.dump(-1, ' ', false, Json::error_handler_t::replace); }
    /// The URI of the text that a message changes, or null.
    static const Json& changedText(const Json& message) {
        return memberOf(
            memberOf(memberOf(message, isCalled(message, "textDocument/didChange") ? "params" : ""), "textDocument"),
            "uri");
    }
    /// Requests in between ask for the text as it is then.
    bool isSuperseded(const Json& message) const {
        const Json& uri = changedText(message);
        return !uri.is_null() && !messages_.empty() && changedText(messages_.front()) == uri;
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Json> messages_;
    std::set<std::string> cancelled_;
    bool closed_ = false, trialEnded_ = false;
};

/// Runs trials of models on a thread of its own, one at a time, so that nobody who types waits for them.
class Trials {
public:
    Trials(const language::Server& server, Queue& queue) : server_(server), queue_(queue) {}
    ~Trials() {
        cancel();
        if (thread_.joinable()) thread_.join();
    }
    Trials(const Trials&) = delete;
    Trials& operator=(const Trials&) = delete;

    bool isBusy() const { return trial_.has_value(); }

    void begin(language::Server::Trial trial) {
        trial_ = std::move(trial);
        progress_ = std::make_unique<Progress>();
        ended_ = false;
        thread_ = std::thread([this] {
            try {
                server_.run(*trial_, progress_.get());
            } catch (const std::exception&) {
                // As when memory is short: the text is left untried.
            }
            ended_ = true;
            queue_.noteTrial();
        });
    }

    /// What is no longer asked for ends soon.
    void cancel() {
        if (isBusy()) progress_->cancel();
    }

    /// The trial, once it has ended; one that was cancelled goes.
    std::optional<language::Server::Trial> take() {
        if (!isBusy() || !ended_) return std::nullopt;
        thread_.join();
        std::optional<language::Server::Trial> done;
        done.swap(trial_);
        if (cancelled(progress_.get())) done.reset();
        return done;
    }

private:
    const language::Server& server_;
    Queue& queue_;
    std::optional<language::Server::Trial> trial_;
    std::unique_ptr<Progress> progress_;
    std::atomic<bool> ended_{false};
    std::thread thread_;
};

void readMessages(Queue& queue) {
    while (const auto text = readMessage(stdin)) {
        Json message = Json::parse(*text, nullptr, false);
        if (message.is_discarded()) {
            queue.push({{"sgm", "unreadable"}});
            continue;
        }
        const bool last = isCalled(message, "exit");
        queue.push(std::move(message));
        if (last) break;
    }
}

/// A thread that puts what the editor sends into a queue, until it sends the last message. It may wait for the next one
/// for ever, so that it isn't waited for when the server ends by an exception.
class Reader {
public:
    explicit Reader(const std::shared_ptr<Queue>& queue)
        : thread_([queue] {
              const Status read = guarded([&]() -> Status { return readMessages(*queue), Done{}; });
              if (!read.ok()) printMessage("error: {}\n", read.error().message);
              queue->close();
          }) {}
    ~Reader() {
        if (thread_.joinable()) thread_.detach();
    }
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;
    void join() { thread_.join(); }

private:
    std::thread thread_;
};

/// What `sgm check` would say of the models, and of the grammar's own tests.
void tryGrammar(const std::shared_ptr<const rules::Grammar>& grammar, Progress* progress, syntax::Diagnostics& found) {
    TrialOptions options;
    options.model.secondsBudget = 10;
    options.otherSeconds = 2;
    if (!tryModels(grammar, options, progress, found).ok() || cancelled(progress)) return;
    pipeline::Context context{progress};
    const auto verdicts = pipeline::runChecks(grammar, options.model.seed, context, options.model.secondsBudget);
    if (!verdicts.ok()) return;
    for (const pipeline::Verdict& v : *verdicts)
        if (!v.passed) found.error(v.span, v.message);
}

void answer(language::Server& server, const Queue::Taken& taken) {
    const Json& message = taken.message;
    if (message.is_object() && message.contains("sgm")) {
        writeMessage({{"jsonrpc", "2.0"},
                      {"id", nullptr},
                      {"error", {{"code", -32700}, {"message", "the message isn't JSON"}}}});
    } else if (taken.cancelled) {
        writeMessage(
            {{"jsonrpc", "2.0"}, {"id", message["id"]}, {"error", {{"code", -32800}, {"message", "cancelled"}}}});
    } else {
        for (const Json& out : server.handle(message, taken.superseded)) writeMessage(out);
    }
}

int serve() {
    language::Environment environment;
    environment.load = pipeline::fileLoader();
    for (auto& [name, source] : pipeline::standardFiles()) environment.library.push_back({name, std::move(source)});
    environment.tryModels = tryGrammar;
    environment.version = SGM_VERSION;
    language::Server server(std::move(environment));
    const auto queue = std::make_shared<Queue>();
    Reader reader(queue);
    Trials trials(server, *queue);
    bool closed = false;
    while (!closed && server.exitCode() < 0) {
        auto next = trials.isBusy() ? std::nullopt : server.nextTrial();
        const auto taken = queue->take(next ? std::optional(settled) : std::nullopt, closed);
        if (taken) {
            if (!isCalled(taken->message, "$/cancelRequest") && memberOf(taken->message, "id").is_null())
                trials.cancel();
            answer(server, *taken);
        } else if (auto done = trials.take()) {
            for (const Json& out : server.finish(std::move(*done))) writeMessage(out);
        } else if (next && !closed) {
            trials.begin(std::move(*next));
        }
    }
    trials.cancel();
    reader.join();
    return std::max(server.exitCode(), 0);
}

}  // namespace

void addLsp(CLI::App& app, int& exitCode) {
    CLI::App* command =
        app.add_subcommand("lsp", "Serve editors: the Language Server Protocol on the standard streams");
    command->footer("Example, for Neovim:\n  vim.lsp.start({ name = \"sgm\", cmd = { \"sgm\", \"lsp\" } })");
    command->callback([&exitCode] { exitCode = serve(); });
}

}  // namespace sgm::cli
