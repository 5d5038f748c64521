// The language server: messages of the Language Server Protocol in, messages out.
// Enters: JSON, one message at a time. Leaves: answers, and notices such as diagnostics. Assumes one thread; reading
// and writing streams is the caller's.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "grammar/language/completion.h"
#include "modeler/core/progress.h"

namespace sgm::language {

/// What the server has from the program that it runs in.
struct Environment {
    rules::Loader load;                ///< reads files from the disk
    std::vector<LibraryFile> library;  ///< the standard library
    /// Problems that only the model shows; adds to the diagnostics. Ends early when progress says so.
    std::function<void(std::shared_ptr<const rules::Grammar>, Progress*, syntax::Diagnostics&)> tryModels;
    std::string version;
};

class Server {
public:
    explicit Server(Environment environment);
    ~Server();

    /// Messages that answer one. `superseded`: a later change of the same text follows at once, so that this one is
    /// only taken in. Never throws.
    std::vector<nlohmann::json> handle(const nlohmann::json& message, bool superseded = false);

    /// Work on a text that takes longer: first the figures for hovers and inlay hints, then the problems of its models.
    struct Trial {
        std::string uri;
        uint64_t revision = 0;   ///< of the text
        bool ofFigures = false;  ///< else of problems
        std::shared_ptr<const rules::Grammar> grammar;
        syntax::Diagnostics found;
        std::optional<Figures> figures;
    };
    /// That of a text that hasn't been tried as it is now.
    std::optional<Trial> nextTrial() const;
    /// Does it. May run on a thread of its own beside all other calls; where progress is cancelled, what it leaves is
    /// thrown away by the caller.
    void run(Trial& trial, Progress* progress) const;
    /// Takes what was found; nothing where the text has changed meanwhile.
    std::vector<nlohmann::json> finish(Trial trial);

    /// After `exit`: the exit code, 1 where no `shutdown` came before. −1 while it goes on.
    int exitCode() const { return exitCode_; }

private:
    struct Document;
    using Json = nlohmann::json;

    Json answer(const std::string& method, const Json& params);
    Json initialize(const Json& params);
    void notice(const std::string& method, const Json& params, bool superseded, std::vector<Json>& out);
    void analyzeAll(const std::string& changed, std::vector<Json>& out);
    void analyze(Document& document, std::vector<Json>& out);
    Json diagnosticsOf(const Document& document) const;
    Document& documentOf(const Json& params);
    rules::Loader loader() const;
    Json actions(const Document& document, const Json& params) const;

    Environment environment_;
    std::map<std::string, std::unique_ptr<Document>> documents_;  ///< by URI
    uint64_t revisions_ = 0;                                      ///< of all texts so far
    uint64_t requests_ = 0;                                       ///< to the client so far
    bool refreshesHints_ = false;  ///< the client asks again for inlay hints when it is told to
    bool shutDown_ = false;
    int exitCode_ = -1;
};

/// The path of a file's URI, and back; a URI of another kind is its own path.
std::string pathOf(const std::string& uri);
std::string uriOf(const std::string& path);

}  // namespace sgm::language
