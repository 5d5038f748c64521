// The passes of the checker over the declarations of a file, and what they share.
// Enters: an Ast. Leaves: rows of the Grammar, and diagnostics. Assumes the order of grammar/rules/check.cpp. For this
// folder's sources alone.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grammar/rules/check_context.h"

namespace sgm::rules {

/// Takes the names an Ast declares and refuses doubles.
void declareNames(CheckContext& ctx, const syntax::Ast& ast);
void declareLsystem(CheckContext& ctx, const syntax::LsystemDecl& decl);
void declareMap(CheckContext& ctx, const syntax::MapDecl& decl);
void declareRoads(CheckContext& ctx, const syntax::RoadsDecl& decl);

// What stands behind the names.
/// Values for parameters as styles, checks and `use` set them; those with an error are left out.
std::vector<Setting> checkSettings(CheckContext& ctx, const std::vector<syntax::Setting>& written);
void checkParameters(CheckContext& ctx, const syntax::Ast& ast);
void checkLets(CheckContext& ctx, const syntax::Ast& ast);
void checkMaterials(CheckContext& ctx, const syntax::Ast& ast);
void checkLsystems(CheckContext& ctx, const syntax::Ast& ast);
void checkMaps(CheckContext& ctx, const syntax::Ast& ast);
void checkRoads(CheckContext& ctx, const syntax::Ast& ast);
void checkTerminals(CheckContext& ctx, const syntax::Ast& ast);
/// Starts and rules.
void checkProductions(CheckContext& ctx, const syntax::Ast& ast);
/// Derivations, styles and checks.
void checkDeclarations(CheckContext& ctx, const syntax::Ast& ast);
/// Warns of parameters and values of `ast` that nothing asks for.
void warnOfUnused(CheckContext& ctx, const syntax::Ast& ast);

/// The symbol of a shape that rules rewrite, which needs no declaration.
SymbolId declareSymbol(CheckContext& ctx, const syntax::Name& name);
/// Reports a name that `seen` holds already.
bool isDeclaredTwice(CheckContext& ctx, Declared::Spans& seen, const syntax::Name& name, std::string_view kind);
/// The names of all shapes, or of terminals and of shapes with rules alone.
std::vector<std::string> symbolNames(CheckContext& ctx, bool withRulesOnly);
/// The symbol of that name, where there is one, for a place that refers to its shapes, as count(Name): a name that is
/// referred to needs no rule of its own.
std::optional<SymbolId> findReferenced(CheckContext& ctx, const std::string& name);

}  // namespace sgm::rules
