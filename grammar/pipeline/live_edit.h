// A model that follows a slider: while it is dragged only a value of the text changes, so the grammar of the moment it
// was taken stays, and every stage keeps what the value doesn't reach. Enters: that grammar, then texts that differ
// from its own in one value. Leaves: models. Assumes one caller at a time.
#pragma once

#include <optional>

#include "grammar/pipeline/incremental.h"
#include "grammar/pipeline/model.h"

namespace sgm::pipeline {

/// What `text` says otherwise than the grammar's own source, where that is one value of a parameter, as default or in a
/// style: index `none` and no value where nothing differs. Nothing where more differs, or where the parameter doesn't
/// take the value. O(size of the text).
std::optional<ValueChange> valueChange(const rules::Grammar& grammar, std::string_view text);

class LiveEdit {
public:
    explicit LiveEdit(std::shared_ptr<const rules::Grammar> grammar) : grammar_(std::move(grammar)) {}

    const std::shared_ptr<const rules::Grammar>& grammar() const { return grammar_; }
    /// The model of these values; errors as of `makeModel`. Its graph is empty, its tape says all that is drawn or
    /// meshed; its spans are of the grammar's source.
    Result<Model> to(const derive::Options& options, Context& context);
    /// Shapes of the last model that were derived anew.
    size_t shapesMade() const { return pipeline_.shapesMade(); }

private:
    std::shared_ptr<const rules::Grammar> grammar_;
    IncrementalPipeline pipeline_;
};

}  // namespace sgm::pipeline
