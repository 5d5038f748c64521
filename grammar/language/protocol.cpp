#include "grammar/language/protocol.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "grammar/language/server.h"
#include "grammar/operations/operations.h"
#include "grammar/syntax/lexer.h"
#include "grammar/syntax/printer.h"

namespace sgm::language {
namespace {

using Json = nlohmann::json;

Json jsonOf(Position position) { return {{"line", position.line}, {"character", position.character}}; }
Json markdown(const std::string& text) { return {{"kind", "markdown"}, {"value", text}}; }
Json location(syntax::SourceSpan span) {
    return {{"uri", uriOf(span.source->name())}, {"range", jsonOf(rangeOf(span))}};
}

/// Numbers of the protocol, by ItemKind.
constexpr int completionKinds[] = {14, 3, 7, 7, 6, 6, 3, 5, 20, 17, 3, 13};
/// Names of the protocol, by TokenKind; the legend.
constexpr const char* tokenTypes[] = {"keyword",  "function", "type",     "class",  "type",   "parameter", "variable",
                                      "function", "property", "function", "number", "string", "comment"};

/// The numbers of symbols in an outline, by NameKind.
constexpr int symbolKinds[] = {5, 13, 13, 13, 12, 8, 19, 24, 12, 17, 20, 14};

}  // namespace

Json jsonOf(Range range) { return {{"start", jsonOf(range.begin)}, {"end", jsonOf(range.end)}}; }

Position positionFrom(const Json& json) {
    return {json.at("line").get<uint32_t>(), json.at("character").get<uint32_t>()};
}

Json capabilities(const std::string& version) {
    Json types = Json::array();
    for (const char* type : tokenTypes) types.push_back(type);
    return {{"capabilities",
             {{"textDocumentSync", {{"openClose", true}, {"change", 2}, {"save", true}}},
              {"completionProvider", {{"triggerCharacters", {":", ">", "+", "-", "\"", "/"}}}},
              {"hoverProvider", true},
              {"definitionProvider", true},
              {"referencesProvider", true},
              {"documentHighlightProvider", true},
              {"documentSymbolProvider", true},
              {"documentFormattingProvider", true},
              {"foldingRangeProvider", true},
              {"colorProvider", true},
              {"inlayHintProvider", true},
              {"renameProvider", {{"prepareProvider", true}}},
              {"codeActionProvider", {{"codeActionKinds", {"quickfix"}}}},
              {"semanticTokensProvider",
               {{"legend", {{"tokenTypes", types}, {"tokenModifiers", {"declaration"}}}}, {"full", true}}}}},
            {"serverInfo", {{"name", "sgm"}, {"version", version}}}};
}

Json jsonOf(const Analysis& analysis, const syntax::Diagnostic& d) {
    Range range;
    std::string message = d.message;
    if (d.span.source == &analysis.source()) {
        range = rangeOf(d.span);
    } else if (d.span.source) {
        message = syntax::placeText(d.span) + message;
        for (const auto& use : analysis.file().ast.uses)
            if (d.span.source->name().ends_with("/" + use.file.text)) range = rangeOf(use.span);
    }
    if (!d.hint.empty()) message += "\n" + d.hint;
    return {{"range", jsonOf(range)},
            {"severity", d.severity == syntax::Severity::Error ? 1 : 2},
            {"source", "sgm"},
            {"message", message}};
}

Json completionJson(const Analysis& analysis, uint32_t offset, const std::vector<LibraryFile>& library) {
    Json items = Json::array();
    for (const Item& item : completionsAt(analysis, offset, library)) {
        Json json{{"label", item.label},
                  {"kind", completionKinds[static_cast<size_t>(item.kind)]},
                  {"sortText", fmt::format("{:02}{}", item.use.empty() ? 10 : 20, item.label)}};
        if (!item.detail.empty()) json["detail"] = item.detail;
        if (!item.doc.empty()) json["documentation"] = markdown(item.doc);
        if (!item.use.empty()) {
            const Position at = positionOf(analysis.source(), useOffset(analysis));
            json["additionalTextEdits"] = {
                {{"range", jsonOf(Range{at, at})}, {"newText", "use \"" + item.use + "\"\n"}}};
        }
        items.push_back(std::move(json));
    }
    return {{"isIncomplete", false}, {"items", items}};
}

Json hoverJson(const Analysis& analysis, uint32_t offset) {
    if (const Occurrence* o = occurrenceAt(analysis.file().names, offset))
        return {{"contents", markdown(describe(analysis, *o))}, {"range", jsonOf(rangeOf(o->span))}};
    for (const syntax::Token& token : syntax::lex(analysis.source())) {
        if (token.begin > offset) break;
        if (offset >= token.end || token.kind != syntax::Token::Kind::Word) continue;
        const std::string doc = docOf(textOf(analysis.source(), token));
        if (!doc.empty())
            return {{"contents", markdown(doc)},
                    {"range", jsonOf(rangeOf({&analysis.source(), token.begin, token.end}))}};
    }
    return nullptr;
}

Json definitionJson(const Analysis& analysis, uint32_t offset) {
    for (const auto& use : analysis.file().ast.uses)
        if (use.file.span.begin <= offset && offset <= use.file.span.end)
            for (const File& file : analysis.files)
                if (file.source->name().ends_with("/" + use.file.text)) return location({file.source.get(), 0, 0});
    const Occurrence* at = occurrenceAt(analysis.file().names, offset);
    if (!at) return nullptr;
    Json places = Json::array();
    const Occurrence* first = definitionOf(analysis, *at);
    if (first) places.push_back(location(first->span));
    if (at->kind == NameKind::Symbol)  // every rule of it
        for (const File& file : analysis.files)
            for (const Occurrence& o : file.names)
                if (o.defines && same(o, *at) && &o != first) places.push_back(location(o.span));
    return places.empty() ? Json(nullptr) : places;
}

Json locationsJson(const std::vector<Occurrence>& occurrences) {
    Json places = Json::array();
    for (const Occurrence& o : occurrences) places.push_back(location(o.span));
    return places;
}

Json highlightsJson(const Analysis& analysis, uint32_t offset) {
    Json places = Json::array();
    for (const Occurrence& o : referencesAt(analysis, offset, true))
        if (o.span.source == &analysis.source())
            places.push_back({{"range", jsonOf(rangeOf(o.span))}, {"kind", o.defines ? 3 : 2}});
    return places;
}

Json workspaceEdit(const std::vector<Edit>& edits) {
    Json changes = Json::object();
    for (const Edit& edit : edits)
        changes[uriOf(edit.span.source->name())].push_back(
            {{"range", jsonOf(rangeOf(edit.span))}, {"newText", edit.text}});
    return {{"changes", changes}};
}

Json formattingJson(const Analysis& analysis) {
    const syntax::Source& source = analysis.source();
    const std::string text = syntax::format(source, operations::table());
    if (text == source.text()) return Json::array();
    return Json::array(
        {{{"range", jsonOf(rangeOf({&source, 0, static_cast<uint32_t>(source.text().size())}))}, {"newText", text}}});
}

Json symbolsJson(const Analysis& analysis) {
    Json symbols = Json::array();
    for (const Entry& entry : outlineOf(analysis))
        symbols.push_back({{"name", entry.name},
                           {"detail", entry.detail},
                           {"kind", symbolKinds[static_cast<size_t>(entry.kind)]},
                           {"range", jsonOf(rangeOf(entry.span))},
                           {"selectionRange", jsonOf(rangeOf(entry.nameSpan))}});
    return symbols;
}

Json foldingJson(const Analysis& analysis) {
    Json folds = Json::array();
    for (const Fold& fold : foldsOf(analysis)) {
        Json json{{"startLine", fold.first}, {"endLine", fold.last}};
        if (fold.comment) json["kind"] = "comment";
        folds.push_back(std::move(json));
    }
    return folds;
}

Json colorsJson(const Analysis& analysis) {
    Json colors = Json::array();
    for (const syntax::Token& token : syntax::lex(analysis.source())) {
        const std::string_view text = textOf(analysis.source(), token);
        if (token.kind != syntax::Token::Kind::Color || text.size() != 7 ||
            text.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string_view::npos)
            continue;
        const unsigned long number = std::stoul(std::string(text.substr(1)), nullptr, 16);
        const auto part = [&](int shift) { return static_cast<double>((number >> shift) & 255) / 255; };
        colors.push_back({{"range", jsonOf(rangeOf({&analysis.source(), token.begin, token.end}))},
                          {"color", {{"red", part(16)}, {"green", part(8)}, {"blue", part(0)}, {"alpha", 1}}}});
    }
    return colors;
}

Json colorPresentationJson(const Json& params) {
    const auto part = [&](const char* name) {
        return static_cast<int>(std::lround(std::clamp(params.at("color").at(name).get<double>(), 0.0, 1.0) * 255));
    };
    return Json::array({{{"label", fmt::format("#{:02x}{:02x}{:02x}", part("red"), part("green"), part("blue"))}}});
}

Json semanticTokensJson(const Analysis& analysis) {
    Json data = Json::array();
    Position last;
    for (const Stretch& s : stretchesOf(analysis)) {
        const Range range = rangeOf({&analysis.source(), s.begin, s.end});
        const bool newLine = range.begin.line != last.line;
        data.push_back(range.begin.line - last.line);
        data.push_back(newLine ? range.begin.character : range.begin.character - last.character);
        data.push_back(range.end.character - range.begin.character);
        // The legend names some types twice; an editor takes the number of the first.
        const auto* const type = std::find_if(std::begin(tokenTypes), std::end(tokenTypes), [&](const char* t) {
            return std::string_view(t) == tokenTypes[static_cast<size_t>(s.kind)];
        });
        data.push_back(type - std::begin(tokenTypes));
        data.push_back(s.defines ? 1 : 0);
        last = range.begin;
    }
    return {{"data", data}};
}

Json hintsJson(const syntax::Source& source, const std::vector<SizeHint>& hints, const Json& range) {
    const Position begin = positionFrom(range.at("start")), end = positionFrom(range.at("end"));
    Json list = Json::array();
    for (const SizeHint& hint : hints) {
        const Position at = positionOf(source, hint.offset);
        if (at < begin || end < at) continue;
        list.push_back(
            {{"position", jsonOf(at)}, {"label", hint.label}, {"tooltip", hint.detail}, {"paddingLeft", true}});
    }
    return list;
}

}  // namespace sgm::language
