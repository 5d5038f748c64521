// Grammars from text and derivations of them, for tests.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "grammar/derive/derive.h"
#include "grammar/derive/print.h"
#include "grammar/operations/operations.h"
#include "grammar/rules/check.h"
#include "tests/field/sampled.h"

namespace sgm::testing_ {

/// The text of a file in the repository, "" where there is none.
inline std::string fileText(const std::string& path) {
    std::ifstream file(path);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

inline std::shared_ptr<const rules::Grammar> grammarOf(const std::string& text) {
    syntax::Diagnostics diagnostics;
    const auto source = std::make_shared<const syntax::Source>("test.sgm", text);
    rules::Loader fromGrammar([](const std::string& name, const syntax::Source&, std::string& why) {
        const std::string used = fileText("grammar/" + name);
        if (!used.empty()) return syntax::SourcePtr(std::make_shared<const syntax::Source>(name, used));
        why = "there is no such file";
        return syntax::SourcePtr();
    });
    fromGrammar.mesh = [](const std::string&, const syntax::Source&, std::string&) {
        return field::test::sampledTorus(16);
    };
    auto grammar = rules::load(source, operations::table(), fromGrammar, diagnostics);
    for (const auto& d : diagnostics.all())
        if (d.severity == syntax::Severity::Error) ADD_FAILURE() << syntax::render(d);
    return grammar;
}

inline Result<derive::Derivation> tryDerive(const std::string& text, derive::Options options = {}) {
    const auto grammar = grammarOf(text);
    if (!grammar) return Error{Error::Kind::Internal, "the test's grammar is wrong"};
    return derive::derive(grammar, options, nullptr);
}

inline derive::Derivation derived(const std::string& text, derive::Options options = {}) {
    auto d = tryDerive(text, options);
    if (!d.ok()) {
        ADD_FAILURE() << d.error().message;
        return {};
    }
    return *std::move(d);
}

/// What a derivation warns of: "line:column message", with the hints "; hint" behind it, one a line.
inline std::string warningsOf(const derive::Derivation& d, bool withHints = false) {
    std::string text;
    const syntax::Diagnostics found = derive::warnings(d);
    for (const syntax::Diagnostic& w : found.all()) {
        const auto place = w.span.source->place(w.span.begin);
        text += std::to_string(place.line) + ":" + std::to_string(place.column) + " " + w.message +
                (withHints ? "; " + w.hint : "") + "\n";
    }
    return text;
}

inline derive::Options withSeed(uint64_t seed) {
    derive::Options options;
    options.seed = seed;
    return options;
}
inline derive::Options way(const std::string& name) {
    derive::Options options;
    options.derive = name;
    return options;
}

/// The shape at a path, asserted to exist.
inline derive::Shape at(const derive::Derivation& d, const std::string& path) {
    const derive::ShapeId id = d.tree.find(path);
    EXPECT_NE(id, derive::none) << path << "\n" << derive::toText(d, true);
    return d.tree.shapes[id == derive::none ? 0 : id];
}

inline void expectNear(Vec3d a, Vec3d b, double tolerance = 1e-9) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "component " << i;
}

/// The paper's caves, clouds and houses, as in docs/language.md.
inline const char* const cave = R"(grammar 1
param cells  = 14   in 1..3000       "Rules in the chain"
param blend  = 0.35 in 0..1          "Sphere to cube"
param shiftj = (0, .25, .1) in 0..1  "Joint shift S_J"
start Cave -> cube : Cell
rule Cell repeat cells
  -> + morph(sphere, cube, blend) size 2 ~> 1.2 at free(+x, -x, +z) to centre
       shift -shiftj..shiftj : Cell
)";
inline const char* const cloud = R"(grammar 1
param reach  = (9, 6, 3, 2, 4, 4) in 0..40 "Max +x -x +y -y +z -z"
start Cloud -> sphere : Puff
rule Puff repeat max(reach)
  -> for d in axes when reach[d] >= i {
       for k in 1..i {
         + sphere size 1.5 ~> .5 on any(d) at d to centre shift -.2 .. .2 : Puff } }
  finally morph torus by .2
)";
inline const char* const house = R"(grammar 1
param floors = 7    in 1..40         "Storeys"
param bulge  = flat of flat, convex, concave "Floor profile"
param peak   = 0.4  in 0..1          "Pyramid to sphere"
start House -> Level size (12, 3.5, 9) : Storey
rule Storey repeat floors - 1
  -> + Level size (12 ~> 8, 3.5 ~> 2.8, 9 ~> 7) at +y : Storey
  finally + roof(peak) size (8.5, 3, 7.5) on last at +y
rule Level when bulge == convex  -> cube for d in sides { + cube size 30% at d to centre }
rule Level when bulge == concave -> cube for d in sides { - cube size 30% at d to centre }
rule Level -> cube
check House { floors = 3 } expect bonds == 3 and overlaps == 0
)";
inline const char* const figure1 = R"(grammar 1
start Figure -> cube : I0
rule R0: I0 -> + sphere at +x : A
rule R1: A -> cube : B
rule R2: A -> + morph(cube, sphere, .5) at +y : DE
rule R3: B -> + cylinder at +y : C
rule R4: DE -> cone : F, torus : G
derive left:  R0 => R1 => R3
derive right: R0 => R2 => R4
)";

}  // namespace sgm::testing_
