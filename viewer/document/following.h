// A model that follows a slider: while a hand holds it only a value of the text changes, so the grammar of the moment
// it was taken stays, and every stage keeps what the value doesn't reach. Enters: that grammar, then texts that differ
// from its own in one value. Leaves: models. Assumes one caller at a time.
#pragma once

#include <optional>

#include "grammar/incremental/pipeline.h"
#include "viewer/document/model.h"

namespace sgm::viewer {

/// `grammar` with the value of a parameter, as default or in a style, that `text` has where the grammar's own source
/// has another. Nothing where the text differs in more than one value, or in one that its parameter doesn't take.
std::optional<rules::Grammar> withValueOf(const rules::Grammar& grammar, std::string_view text);

class Following {
public:
    explicit Following(std::shared_ptr<const rules::Grammar> grammar) : grammar_(std::move(grammar)) {}

    const std::shared_ptr<const rules::Grammar>& grammar() const { return grammar_; }
    /// The model of these values; errors as of `makeModel`. Its graph is empty, its tape says all that is drawn or
    /// meshed; its spans are of the grammar's source.
    Result<Model> to(const derive::Options& options, Stages& stages, Progress* progress);
    /// Shapes of the last model that were derived anew.
    size_t shapesMade() const { return pipeline_.shapesMade(); }

private:
    std::shared_ptr<const rules::Grammar> grammar_;
    incremental::Pipeline pipeline_;
};

}  // namespace sgm::viewer
