#include "tests/bench/scenes.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "grammar/operations/operations.h"
#include "grammar/rules/check.h"
#include "grammar/rules/params.h"
#include "modeler/mesh/distances.h"

namespace sgm::bench {
namespace {

constexpr SceneEntry table[] = {
    {"S1", "tests/bench/scenes/s1_sphere.sgm", ""},
    {"S2-folded-3", "tests/bench/scenes/s2_folded.sgm", "Depth3"},
    {"S2-folded-4", "tests/bench/scenes/s2_folded.sgm", "Depth4"},
    {"S2-csg-3", "tests/bench/scenes/s2_csg.sgm", "Depth3"},
    {"S2-csg-4", "tests/bench/scenes/s2_csg.sgm", "Depth4"},
    {"S3", "tests/bench/scenes/spheres.sgm", "S3"},
    {"S4", "tests/bench/scenes/s4_cave.sgm", ""},
    {"S5", "tests/bench/scenes/buildings.sgm", "S5"},
    {"S6", "tests/bench/scenes/buildings.sgm", "S6"},
    {"S7", "tests/bench/scenes/s7_morph.sgm", "S7"},
    {"S8", "tests/bench/scenes/spheres.sgm", "S8"},
    {"S9", "tests/bench/scenes/s9_kifs.sgm", ""},
    {"S10", "tests/bench/scenes/buildings.sgm", "S10"},
    {"grotto", "examples/grotto.sgm", ""},
    {"cumulus", "examples/cumulus.sgm", ""},
    {"tower", "examples/tower.sgm", ""},
};

syntax::SourcePtr readSource(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return file ? std::make_shared<const syntax::Source>(path, text.str()) : nullptr;
}

/// `use` reads from the file's own folder and from the library.
syntax::SourcePtr readUsed(const std::string& name, const std::string& folder) {
    auto source = readSource(folder + name);
    return source ? source : readSource("grammar/" + name);
}

Result<uint32_t> startIndex(const rules::Grammar& grammar, std::string_view start) {
    if (start.empty()) return 0u;
    for (uint32_t i = 0; i < grammar.starts.size(); ++i)
        if (grammar.symbols[grammar.starts[i].symbol].name == start) return i;
    return Error{Error::Kind::Input, "no start is called " + std::string(start)};
}

}  // namespace

std::span<const SceneEntry> sceneTable() { return table; }

std::span<const SceneEntry> findScenes(std::string_view name) {
    const auto isVariant = [&](const SceneEntry& e) {
        return e.name == name || (e.name.starts_with(name) && e.name.substr(name.size()).starts_with("-"));
    };
    const auto first = std::find_if(std::begin(table), std::end(table), isVariant);
    const auto last = std::find_if_not(first, std::end(table), isVariant);
    return {first, last};
}

Result<GrammarScene> loadGrammar(const SceneEntry& entry) {
    const std::string path(entry.file);
    const auto source = readSource(path);
    if (!source) return Error{Error::Kind::Input, "can't read " + path};
    const std::string folder = path.substr(0, path.rfind('/') + 1);
    rules::Loader loader([&](const std::string& name, const syntax::Source&, std::string& why) {
        auto used = readUsed(name, folder);
        if (!used) why = "not found";
        return used;
    });
    loader.mesh = [&](const std::string& name, const syntax::Source&, std::string& why) {
        const auto grid = mesh::readDistances(folder + name);
        if (!grid.ok()) why = grid.error().message;
        return grid.ok() ? *grid : nullptr;
    };
    syntax::Diagnostics diagnostics;
    const auto grammar = rules::load(source, operations::table(), loader, diagnostics);
    if (!grammar) return Error{Error::Kind::Input, syntax::render(diagnostics.all().front())};
    const auto start = startIndex(*grammar, entry.start);
    if (!start.ok()) return start.error();

    derive::Options options;
    options.start = *start;
    options.params = rules::valuesOf(*grammar, *start);
    return GrammarScene{std::string(entry.name), grammar, std::move(options)};
}

Result<Scene> makeScene(const GrammarScene& scene, Running running) {
    const Stopwatch deriving(running);
    auto derivation = derive::derive(scene.grammar, scene.options, nullptr);
    if (!derivation.ok()) return derivation.error();
    if (!scene.noise)
        for (derive::Extras& x : derivation->tree.extras) x.displace.clear();
    const double deriveSeconds = deriving.seconds();
    const Stopwatch lowering(running);
    auto model = lower::lower(*derivation, nullptr);
    if (!model.ok()) return model.error();
    const double lowerSeconds = lowering.seconds();
    const Stopwatch compiling(running);
    eval::Tape tape = eval::compile((*model)->graph, (*model)->field, (*model)->graph.constants());
    const double compileSeconds = compiling.seconds();
    auto reference = referenceOf(derivation->tree);
    if (reference && !agrees(*reference, tape, (*model)->field.bounds)) reference.reset();
    return Scene{scene.name,    std::move(*model), std::move(tape), std::move(reference),
                 deriveSeconds, lowerSeconds,      compileSeconds};
}

}  // namespace sgm::bench
