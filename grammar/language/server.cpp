#include "grammar/language/server.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "grammar/language/protocol.h"
#include "grammar/language/sizes.h"

namespace sgm::language {
namespace {

enum ErrorCode { MethodNotFound = -32601, InvalidParams = -32602, InvalidRequest = -32600, RequestFailed = -32803 };

/// A request that can't be met, with a sentence for the user.
struct Refused : std::runtime_error {
    using std::runtime_error::runtime_error;
};
struct UnknownMethod : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Applies one change of the protocol to a text and the hints in it.
void applyChange(std::string& text, std::vector<SizeHint>& hints, const nlohmann::json& change) {
    std::string put = change.at("text").get<std::string>();
    if (!change.contains("range")) {
        hints.clear();
        text = std::move(put);
        return;
    }
    const syntax::Source source("", text);
    const uint32_t begin = offsetOf(source, positionFrom(change.at("range").at("start")));
    const uint32_t end = std::max(begin, offsetOf(source, positionFrom(change.at("range").at("end"))));
    shiftHints(hints, begin, end, static_cast<uint32_t>(put.size()));
    text.replace(begin, end - begin, put);
}

bool overlaps(const nlohmann::json& a, const nlohmann::json& b) {
    return positionFrom(a.at("start")) <= positionFrom(b.at("end")) &&
           positionFrom(b.at("start")) <= positionFrom(a.at("end"));
}

/// How much is wrong with a text: errors weigh more than all warnings.
size_t weigh(const Analysis& analysis, std::string_view message, uint32_t offset) {
    size_t weight = 0;
    bool still = false;
    for (const auto& d : analysis.diagnostics.all()) {
        weight += d.severity == syntax::Severity::Error ? 1000 : 1;
        still = still || (d.message == message && d.span.source == &analysis.source() && d.span.begin == offset);
    }
    return weight * 2 + still;
}

}  // namespace

struct Server::Document {
    std::string uri, text;
    int64_t version = 0;
    uint64_t revision = 0;  ///< another one after every analysis
    std::unique_ptr<Analysis> analysis;
    bool figured = false;                         ///< the figures of this text are there, or can't be had
    std::optional<syntax::Diagnostics> ofModels;  ///< of this text; empty until the models were tried
    std::vector<SizeHint> hints;                  ///< of the last models, where their elements stand by now
};

Server::Server(Environment environment) : environment_(std::move(environment)) {}
Server::~Server() = default;

std::vector<nlohmann::json> Server::handle(const Json& message, bool superseded) {
    std::vector<Json> out;
    const Json id = message.is_object() && message.contains("id") ? message["id"] : Json();
    const auto fail = [&](int code, const std::string& why) {
        if (!id.is_null())
            out.push_back({{"jsonrpc", "2.0"}, {"id", id}, {"error", {{"code", code}, {"message", why}}}});
    };
    try {
        if (!message.is_object() || !message.contains("method")) return out;  // an answer to us, or nothing
        const std::string method = message.at("method").get<std::string>();
        const Json params = message.contains("params") ? message.at("params") : Json::object();
        if (id.is_null()) {
            notice(method, params, superseded, out);
        } else if (shutDown_) {
            fail(InvalidRequest, "the server was shut down");
        } else {
            out.push_back({{"jsonrpc", "2.0"}, {"id", id}, {"result", answer(method, params)}});
        }
    } catch (const UnknownMethod& e) {
        fail(MethodNotFound, e.what());
    } catch (const Refused& e) {
        fail(RequestFailed, e.what());
    } catch (const nlohmann::json::exception& e) {
        fail(InvalidParams, e.what());
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& e) {
        fail(RequestFailed, e.what());
    }
    return out;
}

Server::Document& Server::documentOf(const Json& params) {
    const auto found = documents_.find(params.at("textDocument").at("uri").get<std::string>());
    if (found == documents_.end()) throw Refused("the text isn't open");
    if (!found->second->analysis) {
        std::vector<Json> unsent;
        analyze(*found->second, unsent);
    }
    return *found->second;
}

nlohmann::json Server::initialize(const Json& params) {
    const Json::json_pointer refresh("/capabilities/workspace/inlayHint/refreshSupport");
    refreshesHints_ = params.is_object() && params.contains(refresh) && params.at(refresh) == true;
    return capabilities(environment_.version);
}

nlohmann::json Server::answer(const std::string& method, const Json& params) {
    if (method == "initialize") return initialize(params);
    if (method == "shutdown") {
        shutDown_ = true;
        return nullptr;
    }
    if (method == "textDocument/colorPresentation") return colorPresentationJson(params);
    if (!method.starts_with("textDocument/")) throw UnknownMethod("no method " + method);
    const Document& document = documentOf(params);
    const Analysis& analysis = *document.analysis;
    if (method == "textDocument/formatting") return formattingJson(analysis);
    if (method == "textDocument/documentSymbol") return symbolsJson(analysis);
    if (method == "textDocument/foldingRange") return foldingJson(analysis);
    if (method == "textDocument/documentColor") return colorsJson(analysis);
    if (method == "textDocument/semanticTokens/full") return semanticTokensJson(analysis);
    if (method == "textDocument/codeAction") return actions(document, params);
    if (method == "textDocument/inlayHint") return hintsJson(analysis.source(), document.hints, params.at("range"));
    const uint32_t offset =
        params.contains("position") ? offsetOf(analysis.source(), positionFrom(params["position"])) : 0;
    if (method == "textDocument/completion") return completionJson(analysis, offset, environment_.library);
    if (method == "textDocument/hover") return hoverJson(analysis, offset);
    if (method == "textDocument/definition") return definitionJson(analysis, offset);
    if (method == "textDocument/documentHighlight") return highlightsJson(analysis, offset);
    if (method == "textDocument/references")
        return locationsJson(referencesAt(analysis, offset, params.at("context").at("includeDeclaration").get<bool>()));
    if (method == "textDocument/prepareRename") {
        const Occurrence* at = occurrenceAt(analysis.file().names, offset);
        return at ? Json{{"range", jsonOf(rangeOf(at->span))}, {"placeholder", at->name}} : Json(nullptr);
    }
    if (method == "textDocument/rename") {
        const auto edits = rename(analysis, offset, params.at("newName").get<std::string>());
        if (!edits.ok()) throw Refused(edits.error().message);
        return workspaceEdit(*edits);
    }
    throw UnknownMethod("no method " + method);
}

void Server::notice(const std::string& method, const Json& params, bool superseded, std::vector<Json>& out) {
    if (method == "exit") {
        exitCode_ = shutDown_ ? 0 : 1;
    } else if (method == "textDocument/didOpen") {
        const Json& item = params.at("textDocument");
        const std::string uri = item.at("uri").get<std::string>();
        auto document = std::make_unique<Document>();
        document->uri = uri;
        document->text = item.at("text").get<std::string>();
        document->version = item.value("version", 0);
        documents_[uri] = std::move(document);
        analyzeAll(uri, out);
    } else if (method == "textDocument/didChange") {
        const std::string uri = params.at("textDocument").at("uri").get<std::string>();
        const auto found = documents_.find(uri);
        if (found == documents_.end()) return;
        Document& document = *found->second;
        for (const Json& change : params.at("contentChanges")) applyChange(document.text, document.hints, change);
        document.version = params.at("textDocument").value("version", document.version);
        document.analysis.reset();
        if (!superseded) analyzeAll(uri, out);
    } else if (method == "textDocument/didClose") {
        const std::string uri = params.at("textDocument").at("uri").get<std::string>();
        if (documents_.erase(uri) > 0)
            out.push_back({{"jsonrpc", "2.0"},
                           {"method", "textDocument/publishDiagnostics"},
                           {"params", {{"uri", uri}, {"diagnostics", Json::array()}}}});
    }
}

void Server::analyzeAll(const std::string& changed, std::vector<Json>& out) {
    analyze(*documents_.at(changed), out);
    const std::string path = pathOf(changed);
    for (auto& [uri, document] : documents_) {
        if (uri == changed || !document->analysis) continue;
        const auto& files = document->analysis->files;
        const bool uses =
            std::any_of(files.begin() + 1, files.end(), [&](const File& f) { return f.source->name() == path; });
        if (!uses) continue;
        analyze(*document, out);
    }
}

rules::Loader Server::loader() const {
    rules::Loader loader = environment_.load;
    loader.use = [this](const std::string& name, const syntax::Source& from, std::string& why) -> syntax::SourcePtr {
        syntax::SourcePtr found = environment_.load.use(name, from, why);
        if (!found) return found;
        const auto open = documents_.find(uriOf(found->name()));
        return open == documents_.end() ? found
                                        : std::make_shared<const syntax::Source>(found->name(), open->second->text);
    };
    return loader;
}

void Server::analyze(Document& document, std::vector<Json>& out) {
    auto source = std::make_shared<const syntax::Source>(pathOf(document.uri), document.text);
    document.analysis = std::make_unique<Analysis>(language::analyze(std::move(source), loader()));
    document.revision = ++revisions_;
    document.figured = false;
    document.ofModels.reset();
    out.push_back(diagnosticsOf(document));
}

nlohmann::json Server::diagnosticsOf(const Document& document) const {
    Json list = Json::array();
    for (const auto& d : document.analysis->diagnostics.all()) list.push_back(jsonOf(*document.analysis, d));
    if (document.ofModels)
        for (const auto& d : document.ofModels->all()) list.push_back(jsonOf(*document.analysis, d));
    return {{"jsonrpc", "2.0"},
            {"method", "textDocument/publishDiagnostics"},
            {"params", {{"uri", document.uri}, {"version", document.version}, {"diagnostics", list}}}};
}

nlohmann::json Server::actions(const Document& document, const Json& params) const {
    const Analysis& analysis = *document.analysis;
    const auto load = loader();
    const auto check = [&](const std::string& text, std::string_view message, uint32_t offset) {
        return weigh(language::analyze(std::make_shared<const syntax::Source>(analysis.source().name(), text), load),
                     message, offset);
    };
    Json found = Json::array();
    for (const auto& d : analysis.diagnostics.all()) {
        const Json problem = jsonOf(analysis, d);
        if (d.hint.empty() || !overlaps(problem["range"], params.at("range"))) continue;
        std::vector<Edit> extra;
        const size_t use = d.hint.find("use \"");
        if (use != std::string::npos) {
            const uint32_t at = useOffset(analysis);
            extra.push_back(
                {{&analysis.source(), at, at}, d.hint.substr(use, d.hint.find('"', use + 5) + 1 - use) + '\n'});
        }
        for (const Fix& fix : fixesOf(analysis.source(), d, extra, check))
            found.push_back({{"title", fix.title},
                             {"kind", "quickfix"},
                             {"isPreferred", true},
                             {"diagnostics", Json::array({problem})},
                             {"edit", workspaceEdit({fix.edit})}});
    }
    return found;
}

std::optional<Server::Trial> Server::nextTrial() const {
    for (const bool ofFigures : {true, false})
        for (const auto& [uri, document] : documents_)
            if (document->analysis && document->analysis->grammar &&
                (ofFigures ? !document->figured : !document->ofModels))
                return Trial{uri, document->revision, ofFigures, document->analysis->grammar, {}, {}};
    return std::nullopt;
}

void Server::run(Trial& trial, Progress* progress) const {
    if (trial.ofFigures)
        trial.figures = figuresOf(trial.grammar, progress);
    else
        environment_.tryModels(trial.grammar, progress, trial.found);
}

std::vector<nlohmann::json> Server::finish(Trial trial) {
    const auto found = documents_.find(trial.uri);
    if (found == documents_.end() || found->second->revision != trial.revision || !found->second->analysis) return {};
    Document& document = *found->second;
    if (!trial.ofFigures) {
        document.ofModels = std::move(trial.found);
        return {diagnosticsOf(document)};
    }
    document.figured = true;
    document.hints.clear();
    if (trial.figures) document.hints = sizeHints(document.analysis->source(), *trial.figures);
    document.analysis->figures = std::move(trial.figures);
    if (!refreshesHints_) return {};
    std::vector<Json> out;
    out.push_back({{"jsonrpc", "2.0"},
                   {"id", fmt::format("sgm-{}", ++requests_)},
                   {"method", "workspace/inlayHint/refresh"},
                   {"params", nullptr}});
    return out;
}

std::string pathOf(const std::string& uri) {
    if (!uri.starts_with("file://")) return uri;
    std::string path;
    for (size_t i = 7; i < uri.size(); ++i) {
        const auto digit = [&](size_t at) {
            return at < uri.size() ? std::string_view("0123456789abcdef")
                                         .find(static_cast<char>(std::tolower(static_cast<unsigned char>(uri[at]))))
                                   : std::string_view::npos;
        };
        if (uri[i] == '%' && digit(i + 1) != std::string_view::npos && digit(i + 2) != std::string_view::npos) {
            path += static_cast<char>(digit(i + 1) * 16 + digit(i + 2));
            i += 2;
        } else {
            path += uri[i];
        }
    }
    return path;
}

std::string uriOf(const std::string& path) {
    if (path.find("://") != std::string::npos || path.starts_with("untitled:")) return path;
    std::string uri = "file://";
    for (const char c : path) {
        const bool plain =
            std::isalnum(static_cast<unsigned char>(c)) || std::string_view("/-_.~").find(c) != std::string_view::npos;
        uri += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
    return uri;
}

}  // namespace sgm::language
