// Damaged grammars: a stream of texts near a given one, for the fuzz tests of the parser, the formatter and the
// checker. Enters: a grammar's text and a key. Leaves: a mutant, decided by them alone. Assumes nothing of the text.
#pragma once

#include <string>
#include <vector>

#include "grammar/operations/operations.h"
#include "grammar/syntax/lexer.h"
#include "grammar/syntax/operations.h"
#include "modeler/core/random.h"

namespace sgm::syntax {

/// Makes mutants of one text: byte flips, tokens deleted, doubled, swapped or replaced, cuts, splices, deep nesting.
class Mutator {
public:
    explicit Mutator(std::string text) : text_(std::move(text)) {
        const Source source("mutant", text_);
        for (const Token& token : lexSignificant(source)) words_.emplace_back(textOf(source, token));
        for (const Operation* row : operations::table().rows()) words_.emplace_back(row->name);
        for (const char* word :
             {"((", "))", "{ {", "}*", "-", "~", "not", "..", "~>", "\"", "#", "1e999", "0x", "\xff\xfe"})
            words_.emplace_back(word);
    }

    /// The mutant of `key`: one to four edits of the text.
    std::string operator()(uint64_t key) const {
        std::string text = text_;
        const uint64_t edits = 1 + pick(combine(key, 0), 4);
        for (uint64_t i = 1; i <= edits; ++i) edit(text, combine(key, i));
        return text;
    }

private:
    static size_t place(const std::string& text, uint64_t key) { return pick(key, text.size() + 1); }

    void edit(std::string& text, uint64_t key) const {
        if (text.empty()) text = " ";
        switch (pick(combine(key, 100), 8)) {
            case 0:
                text[pick(combine(key, 1), text.size())] ^= static_cast<char>(1u << pick(combine(key, 2), 8));
                break;
            case 1:
                text.insert(place(text, combine(key, 1)), 1, static_cast<char>(pick(combine(key, 2), 256)));
                break;
            case 2:
                text.insert(place(text, combine(key, 1)), ' ' + word(combine(key, 2)) + ' ');
                break;
            case 3:
                editTokens(text, key);
                break;
            case 4:
                editTokens(text, combine(key, 9));
                break;
            case 5:
                splice(text, key);
                break;
            case 6:
                nest(text, key);
                break;
            // Cutting leaves little to find afterwards, so it comes rarely.
            default:
                if (pick(combine(key, 1), 4) == 0) text.resize(place(text, combine(key, 2)));
                break;
        }
    }

    const std::string& word(uint64_t key) const { return words_[pick(key, words_.size())]; }

    /// Deletes, doubles, replaces or swaps tokens.
    void editTokens(std::string& text, uint64_t key) const {
        const Source source("mutant", text);
        const std::vector<Token> tokens = lexSignificant(source);
        if (tokens.empty()) return;
        Token a = tokens[pick(combine(key, 3), tokens.size())], b = tokens[pick(combine(key, 4), tokens.size())];
        if (b.begin < a.begin) std::swap(a, b);
        const std::string first(textOf(source, a)), second(textOf(source, b));
        switch (pick(combine(key, 5), 4)) {
            case 0:
                text.erase(a.begin, first.size());
                break;
            case 1:
                text.insert(a.end, ' ' + first);
                break;
            case 2:
                text.replace(a.begin, first.size(), word(combine(key, 6)));
                break;
            default:
                text.replace(b.begin, second.size(), first);
                text.replace(a.begin, first.size(), second);
        }
    }

    /// Copies a stretch of the text to another place.
    static void splice(std::string& text, uint64_t key) {
        const size_t from = place(text, combine(key, 1));
        const std::string part = text.substr(from, pick(combine(key, 2), 200));
        text.insert(place(text, combine(key, 3)), part);
    }

    /// Repeats an opening many times: what a recursive parser fears.
    void nest(std::string& text, uint64_t key) const {
        constexpr const char* openings[] = {
            "(", "{", "[", "- ", "not ", "~", "a(", "split x { 1: ", "(+ cube", "a[", "a + ", "a .. "};
        const std::string opening = openings[pick(combine(key, 1), std::size(openings))];
        const uint64_t times = pick(combine(key, 2), 10) == 0 ? 2000 : pick(combine(key, 3), 50);
        std::string run;
        for (uint64_t i = 0; i < times; ++i) run += opening;
        text.insert(place(text, combine(key, 4)), run);
    }

    std::string text_;
    std::vector<std::string> words_;
};

}  // namespace sgm::syntax
