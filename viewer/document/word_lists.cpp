#include "viewer/document/word_lists.h"

#include <algorithm>

#include "modeler/field/primitives.h"
#include "viewer/document/edits.h"

namespace sgm::document {
namespace {

/// Within their groups, which stay in order.
void sortGroups(std::vector<ListedWord>& words) {
    for (auto begin = words.begin(); begin != words.end();) {
        const auto end = std::find_if(begin, words.end(), [&](const ListedWord& w) { return w.group != begin->group; });
        std::sort(begin, end, [](const ListedWord& a, const ListedWord& b) { return a.name < b.name; });
        begin = end;
    }
}

std::string whereFrom(const rules::Grammar& grammar, const rules::Symbol& symbol) {
    const syntax::Source* file = symbol.span.source;
    return file && file != grammar.sources[0].get() ? "of " + file->name() : "";
}

void addSymbols(std::vector<ListedWord>& words, const rules::Grammar& grammar, const char* group, auto&& belongs) {
    for (const rules::Symbol& symbol : grammar.symbols)
        if (belongs(symbol)) words.push_back({symbol.name, group, whereFrom(grammar, symbol)});
}

bool needsFile(const field::Primitive& primitive) {
    return std::any_of(primitive.parameters.begin(), primitive.parameters.end(),
                       [](const auto& p) { return p.kind == field::ParameterKind::File && !p.optional; });
}

const char* groupOf(const syntax::Operation& operation) {
    switch (operation.phase) {
        case syntax::Operation::Phase::Scope:
            return "Size and plan";
        case syntax::Operation::Phase::Placement:
            return "How it joins";
        case syntax::Operation::Phase::Look:
            return "Look";
        case syntax::Operation::Phase::Whole:
            return "All that it holds";
        case syntax::Operation::Phase::Detail:
            return "Details of others";
        case syntax::Operation::Phase::Content:
            return "Divide it";
    }
    return "";
}

}  // namespace

std::vector<ListedWord> placeableWords(const rules::Grammar* grammar) {
    std::vector<ListedWord> words;
    if (grammar) {
        addSymbols(words, *grammar, "Shapes with rules",
                   [](const rules::Symbol& s) { return !s.terminal && !s.rules.empty(); });
        addSymbols(words, *grammar, "Terminals", [](const rules::Symbol& s) { return s.terminal && !s.isMaterial; });
    }
    for (const field::Primitive& primitive : field::primitives())
        if (!needsFile(primitive)) words.push_back({std::string(primitive.name), "Solids", std::string(primitive.doc)});
    words.push_back({"nil", "Solids", "Nothing: the scope stays empty"});
    sortGroups(words);
    return words;
}

std::vector<ListedWord> materialWords(const rules::Grammar* grammar) {
    std::vector<ListedWord> words;
    if (!grammar) return words;
    addSymbols(words, *grammar, "Materials", [](const rules::Symbol& s) { return s.isMaterial; });
    addSymbols(words, *grammar, "Terminals", [](const rules::Symbol& s) { return s.terminal && !s.isMaterial; });
    sortGroups(words);
    return words;
}

std::vector<ListedWord> attributeWords(const syntax::Ast& ast, const syntax::Element& element) {
    using Phase = syntax::Operation::Phase;
    const auto has = [&](const syntax::Operation* operation) {
        for (const auto* list : {&element.before, &element.after})
            for (const syntax::Attribute& a : *list)
                if (a.operation == operation) return true;
        return false;
    };
    std::vector<ListedWord> words;
    for (const Phase phase : {Phase::Scope, Phase::Placement, Phase::Look, Phase::Whole, Phase::Detail}) {
        for (const syntax::Operation* row : ast.operations->rows())
            if (row->phase == phase && !row->hasBlock() && !row->arguments.empty() && !has(row))
                words.push_back({std::string(row->name), groupOf(*row), std::string(row->doc)});
    }
    if (element.solid && element.live.empty())
        for (const edits::Division& division : edits::divisions())
            words.push_back({division.name, "Divide it", division.doc});
    sortGroups(words);
    return words;
}

}  // namespace sgm::document
