// Syntax tree to checked grammar: names, types, units, ranges, reachability, termination.
// Enters: Asts. Leaves: a Grammar, or diagnostics with at least one error. Assumes parse errors were collected already.
#pragma once

#include <functional>
#include <memory>
#include <type_traits>

#include "grammar/rules/grammar.h"
#include "modeler/core/result.h"
#include "modeler/image/image_file.h"
#include "modeler/plan/read.h"

namespace sgm::rules {

/// Reads what a grammar names: files are read by cli/ and viewer/ only. Both give null with `why` set where they can't.
struct Loader {
    using Use = std::function<syntax::SourcePtr(const std::string& name, const syntax::Source& from, std::string& why)>;
    using Mesh =
        std::function<field::SampledGridPtr(const std::string& name, const syntax::Source& from, std::string& why)>;
    using Outlines = std::function<std::shared_ptr<const plan::Features>(const std::string& name,
                                                                         const syntax::Source& from, std::string& why)>;

    using Image =
        std::function<image::ImageFilePtr(const std::string& name, const syntax::Source& from, std::string& why)>;
    using Picture =
        std::function<town::RasterPtr(const std::string& name, const syntax::Source& from, std::string& why)>;

    using Streets = std::function<std::shared_ptr<const town::OwnStreets>(
        const std::string& name, const syntax::Source& from, std::string& why)>;

    Loader() = default;
    /// One that reads grammars alone.
    template <class Fn>
    requires(std::is_constructible_v<Use, Fn>) Loader(Fn fn) : use(std::move(fn)) {}

    /// The source behind `use "name"` of `from`. A file is known by its source's name(). Diagnostics point into the
    /// source: whoever loads keeps it for as long as they are read.
    Use use;
    /// The file that a `use` would have to name for a terminal or rule of that name to be known, or "". May be empty.
    std::function<std::string(const std::string& name)> declares;
    /// The distances to the mesh behind `mesh("name")` of `from`.
    Mesh mesh;
    /// The outlines of the file behind `footprint file("name")` of `from`.
    Outlines outlines;
    /// The picture behind `map … = "name"` of `from`.
    Picture picture;
    /// The picture behind `texture "name"` of `from`.
    Image image;
    /// The streets of the file behind `roads … from "name"` of `from`.
    Streets streets;
};

/// Null when `diagnostics` has errors. Reports everything wrong in one run, in the order of the text, used files first:
/// unknown names with "did you mean", units, ranges, unused parameters and unreachable rules (warnings), rules that
/// provably never end, features not built yet.
std::shared_ptr<const Grammar> check(const syntax::Ast& ast, const Loader& load, syntax::Diagnostics& diagnostics);

/// parse + check of one source.
std::shared_ptr<const Grammar> load(syntax::SourcePtr source, const syntax::OperationTable& operations,
                                    const Loader& load, syntax::Diagnostics& diagnostics);

/// Parses and checks "NAME=VALUE" text against a parameter (`--set`): type, unit, range, choices.
Result<Value> parseValue(const Param& param, const std::string& text);

}  // namespace sgm::rules
