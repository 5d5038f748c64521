// What is known of a text while it is edited: its tree, its problems, its names and those of the files it uses.
// Enters: a source and a loader. Leaves: an Analysis that later questions read. Assumes nothing of the text.
#pragma once

#include <optional>

#include "grammar/language/names.h"
#include "grammar/rules/check.h"
#include "modeler/core/progress.h"
#include "modeler/core/vec.h"

namespace sgm::language {

struct File {
    syntax::SourcePtr source;
    syntax::Ast ast;
    std::vector<Occurrence> names;
};

/// The sizes of the shapes that one element of a rule made.
struct Sizes {
    uint32_t end = 0;    ///< byte offset behind the element
    uint64_t count = 0;  ///< shapes
    Vec3d least, most;   ///< metres, each axis by itself
};

/// What the first model at the defaults made, by rule and symbol; for hovers and inlay hints.
struct Figures {
    std::map<std::string, std::pair<uint64_t, uint64_t>> rules;  ///< by name: applications and shapes made
    std::map<std::string, uint64_t> symbols;                     ///< shapes, by label
    std::map<uint32_t, Sizes> sizes;                             ///< by the byte offset of an element of the main file
};

struct Analysis {
    std::vector<File> files;  ///< the text itself, then the files it uses, each once
    Known known;
    syntax::Diagnostics diagnostics;
    std::shared_ptr<const rules::Grammar> grammar;  ///< null where there are errors
    std::optional<Figures> figures;
    /// Where names are defined: a rule rather than a start. Points into `files`; locals are left out.
    std::map<std::pair<NameKind, std::string>, const Occurrence*> definitions;

    Analysis() = default;
    Analysis(Analysis&&) = default;
    Analysis& operator=(Analysis&&) = default;

    const File& file() const { return files.front(); }
    const syntax::Source& source() const { return *files.front().source; }
};

/// Parses and checks.
Analysis analyze(syntax::SourcePtr source, const rules::Loader& load);

/// The figures of the first start's model at the defaults; nothing where it can't be derived within the budget.
std::optional<Figures> figuresOf(std::shared_ptr<const rules::Grammar> grammar, Progress* progress);

}  // namespace sgm::language
