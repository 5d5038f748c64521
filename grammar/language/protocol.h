// The server's answers as JSON of the Language Server Protocol.
// Enters: an Analysis and an offset. Leaves: JSON. Assumes the analysis is of the present text.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "grammar/language/completion.h"
#include "grammar/language/edits.h"
#include "grammar/language/sizes.h"

namespace sgm::language {

nlohmann::json capabilities(const std::string& version);

nlohmann::json jsonOf(Range range);
Position positionFrom(const nlohmann::json& json);

/// A diagnostic of the text; one of another file is shown at the `use` that brought it in, or in the first line.
nlohmann::json jsonOf(const Analysis& analysis, const syntax::Diagnostic& diagnostic);

nlohmann::json completionJson(const Analysis& analysis, uint32_t offset, const std::vector<LibraryFile>& library);
nlohmann::json hoverJson(const Analysis& analysis, uint32_t offset);
nlohmann::json definitionJson(const Analysis& analysis, uint32_t offset);
nlohmann::json locationsJson(const std::vector<Occurrence>& occurrences);
nlohmann::json highlightsJson(const Analysis& analysis, uint32_t offset);
/// {changes: {uri: [edits]}}
nlohmann::json workspaceEdit(const std::vector<Edit>& edits);
nlohmann::json formattingJson(const Analysis& analysis);
nlohmann::json symbolsJson(const Analysis& analysis);
nlohmann::json foldingJson(const Analysis& analysis);
nlohmann::json colorsJson(const Analysis& analysis);
nlohmann::json colorPresentationJson(const nlohmann::json& params);
nlohmann::json semanticTokensJson(const Analysis& analysis);
/// Those within a range of the protocol.
nlohmann::json hintsJson(const syntax::Source& source, const std::vector<SizeHint>& hints, const nlohmann::json& range);

}  // namespace sgm::language
