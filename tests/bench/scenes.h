// What is measured: the shipped scenes by name, or any grammar file.
// Enters: a name of `sceneTable` or the path of a grammar. Leaves: its compiled field. Assumes the repository's root as
// the working folder.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "grammar/lower/lower.h"
#include "modeler/core/result.h"
#include "modeler/eval/tape.h"
#include "tests/bench/reference.h"
#include "tests/bench/stopwatch.h"

namespace sgm::bench {

/// A scene that ships with the benchmark.
struct SceneEntry {
    std::string_view name;   ///< "S3"; variants as in "S2-csg-4"
    std::string_view file;   ///< from the repository's root
    std::string_view start;  ///< start symbol; empty for the file's first
};

/// All scenes, S1 … S10 and then the examples.
std::span<const SceneEntry> sceneTable();
/// The scenes called `name`: that very one, or all its variants (S2 gives S2-folded-3 …). Empty when there is none.
std::span<const SceneEntry> findScenes(std::string_view name);

/// A grammar with what to derive.
struct GrammarScene {
    std::string name;
    std::shared_ptr<const rules::Grammar> grammar;
    derive::Options options;  ///< start, what its parameters are before a user changes any, seed 1
    bool noise = true;        ///< false: nothing is displaced
};
/// Reads and checks. Error::Input when the file can't be read or the grammar is wrong.
Result<GrammarScene> loadGrammar(const SceneEntry& entry);

/// A field, ready to be measured.
struct Scene {
    std::string name;
    std::unique_ptr<lower::Model> model;
    eval::Tape tape;
    std::optional<Reference> reference;  ///< where it agrees with the tape
    double deriveSeconds = 0, lowerSeconds = 0, compileSeconds = 0;
};

/// Derives, lowers and compiles. Errors as theirs.
Result<Scene> makeScene(const GrammarScene& scene, Running running);

}  // namespace sgm::bench
