// The files that a grammar names.
// Enters: names as they are written. Leaves: what stands in the files, in the lists of the Grammar. Assumes that the
// loader keeps the sources.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "grammar/rules/check.h"
#include "grammar/rules/grammar.h"
#include "grammar/syntax/ast.h"

namespace sgm::rules {

/// The files that a grammar names: each is read once, into the Grammar's lists.
class FileTables {
public:
    FileTables(Grammar& grammar, syntax::Diagnostics& diagnostics, Loader load)
        : grammar_(grammar), diagnostics_(diagnostics), load_(std::move(load)) {}

    /// The place in Grammar::outlines of the file that `name` (a text) stands for, read here; nothing after an error.
    std::optional<uint32_t> readOutlines(const syntax::Expr& name);
    /// The name by which the grammar calls Grammar::outlines[place]. O(files).
    std::string outlinesName(size_t place) const;
    /// The place in Grammar::images of the picture that `name` (a text) stands for, read here; nothing after an error.
    std::optional<uint32_t> readImage(const syntax::Expr& name);
    /// The place in Grammar::meshes of the file that `name` (a text) stands for, where null stands after an error.
    size_t readMesh(const syntax::Expr& name);
    /// Null after an error.
    town::RasterPtr readPicture(const syntax::Expr& name);
    std::shared_ptr<const town::OwnStreets> readStreets(const syntax::Expr& name);
    /// The file that a `use` would have to name for `word` to be known, or "".
    std::string declaring(const std::string& word) const;

private:
    using Places = std::map<std::pair<const syntax::Source*, std::string>, size_t>;

    Grammar& grammar_;
    syntax::Diagnostics& diagnostics_;
    Loader load_;
    Places outlines_, images_, meshes_;
};

}  // namespace sgm::rules
