#include "grammar/language/completion.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "grammar/operations/operations.h"
#include "grammar/rules/functions.h"
#include "grammar/rules/plans.h"
#include "grammar/rules/words.h"
#include "grammar/syntax/lexer.h"
#include "grammar/syntax/parser.h"
#include "modeler/field/primitives.h"

namespace sgm::language {
namespace {

using syntax::ArgumentType;
using syntax::Token;

/// What may stand at a place.
enum class Want {
    Declaration,
    Clause,
    Body,
    Attribute,
    Expression,
    Joint,
    Host,
    Axis,
    Plan,
    Live,
    Settings,
    Start,
    Rule,
    Shape,
    File,
    Tag,
    Material,
    Nothing
};

class Scanner {
public:
    Scanner(const Analysis& analysis, uint32_t offset) : source_(analysis.source()) {
        for (const Token& token : syntax::lex(source_)) {
            if (token.begin >= offset) break;
            const bool inside =
                offset <= token.end && (token.kind == Token::Kind::Word || token.kind == Token::Kind::Text ||
                                        token.kind == Token::Kind::Comment);
            if (inside) {
                current_ = token;
                break;
            }
            if (!syntax::isTrivia(token.kind)) before_.push_back(token);
        }
        for (size_t i = before_.size(); i-- > 0 && begin_ == none;)
            if (before_[i].columnOne) begin_ = i;
    }

    Want want() const {
        if (current_.kind == Token::Kind::Comment) return Want::Nothing;
        const bool columnOne = current_.kind == Token::Kind::Word ? current_.columnOne : false;
        if (columnOne || begin_ == none) return Want::Declaration;
        const std::string_view word = text(begin_);
        if (current_.kind == Token::Kind::Text) return word == "use" ? Want::File : Want::Nothing;
        const std::string_view last = text(before_.size() - 1);
        if (word == "use") return inBraces() ? Want::Settings : Want::Nothing;
        if (word == "style" || word == "check") return settings(word, last);
        if (word == "derive") return last == "at" ? Want::Shape : Want::Rule;
        if (word == "param")
            return before_.size() == begin_ + 1                                      ? Want::Nothing
                   : last == "in" || last == ".." || last == "=" || isOperator(last) ? Want::Expression
                                                                                     : Want::Clause;
        if (word == "rule" && !seen("->"))
            return before_.size() == begin_ + 1 || last == "beside" || last == ":"              ? Want::Shape
                   : isOperator(last) || last == "when" || last == "weight" || last == "repeat" ? Want::Expression
                                                                                                : Want::Clause;
        if (word == "start" && !seen("->")) return Want::Nothing;
        if (word == "material") return before_.size() > begin_ + 1 ? attribute(last, Want::Attribute) : Want::Nothing;
        if (word == "terminal")
            return seen("=") || before_.size() > begin_ + 1
                       ? attribute(last, last == "=" ? Want::Body : Want::Attribute)
                       : Want::Nothing;
        if (word == "rule" || word == "start") return body(last);
        return Want::Expression;
    }

private:
    static constexpr size_t none = static_cast<size_t>(-1);

    std::string_view text(size_t i) const {
        return i < before_.size() ? syntax::textOf(source_, before_[i]) : std::string_view();
    }
    bool seen(std::string_view what) const {
        for (size_t i = begin_; i < before_.size(); ++i)
            if (text(i) == what) return true;
        return false;
    }
    static bool isOperator(std::string_view word) {
        constexpr std::string_view signs[] = {
            "+", "-", "*", "/", "%", "<", "<=", ">", ">=", "==", "!=", "and", "or", "not", "~>", "..", "~"};
        return std::find(std::begin(signs), std::end(signs), word) != std::end(signs);
    }
    bool inBraces() const {
        int depth = 0;
        for (size_t i = begin_; i < before_.size(); ++i) depth += text(i) == "{" ? 1 : text(i) == "}" ? -1 : 0;
        return depth > 0;
    }
    /// The innermost open bracket: its index, or none.
    size_t openBracket() const {
        std::vector<size_t> open;
        for (size_t i = begin_; i < before_.size(); ++i) {
            const std::string_view t = text(i);
            if (t == "(" || t == "{" || t == "[") open.push_back(i);
            if ((t == ")" || t == "}" || t == "]") && !open.empty()) open.pop_back();
        }
        return open.empty() ? none : open.back();
    }

    Want settings(std::string_view word, std::string_view last) const {
        if (last == "for" || (word == "check" && before_.size() == begin_ + 1)) return Want::Start;
        if (inBraces()) return last == "=" || isOperator(last) ? Want::Expression : Want::Settings;
        return seen("expect") ? Want::Expression : Want::Clause;
    }

    /// Behind an operation's name its argument stands, elsewhere `otherwise`.
    Want attribute(std::string_view last, Want otherwise) const {
        if (last == "facing") return Want::Joint;
        const syntax::Operation* row = operations::table().find(last);
        if (!row || row->arguments.empty()) return otherwise;
        switch (row->arguments[0].type) {
            case ArgumentType::Joint:
                return Want::Joint;
            case ArgumentType::Shape:
                return Want::Host;
            case ArgumentType::Axis:
            case ArgumentType::Cut:
                return Want::Axis;
            case ArgumentType::Plan:
                return Want::Plan;
            case ArgumentType::Solid:
                return Want::Body;
            case ArgumentType::Name:
                return Want::Tag;
            case ArgumentType::Start:
                return Want::Start;
            case ArgumentType::Symbol:
                return Want::Shape;
            case ArgumentType::Material:
                return Want::Material;
            case ArgumentType::Point:
                return Want::Joint;
            default:
                return Want::Expression;
        }
    }

    Want body(std::string_view last) const {
        const size_t open = openBracket();
        const bool call = open != none && text(open) == "(" && open > begin_ && before_[open].glued &&
                          before_[open - 1].kind == Token::Kind::Word;
        if (call) {
            const std::string_view callee = text(open - 1);
            if (callee == "free") return Want::Joint;
            if (callee == "each" || callee == "count") return Want::Shape;
            return callee == "morph" ? Want::Body : Want::Expression;
        }
        // (a, b) behind an operation or a sign is a vector; elsewhere a group.
        const bool vector = open != none && text(open) == "(" && open > begin_ &&
                            (operations::table().find(text(open - 1)) || isOperator(text(open - 1)));
        if (vector || (open != none && text(open) == "[")) return Want::Expression;
        // { name = value … } behind an operation's argument.
        const syntax::Operation* row =
            open != none && text(open) == "{" && open > begin_ + 1 ? operations::table().find(text(open - 2)) : nullptr;
        if (row && row->traits.takesSettings)
            return last == "=" || isOperator(last) ? Want::Expression : Want::Settings;
        if (last == ":") {
            const bool label = open != none && text(open) == "{";
            return label ? Want::Body : Want::Live;
        }
        if (last == "->" || last == "," || last == "+" || last == "-" || last == "&" || last == "{" || last == "|" ||
            last == "(" || last == "}" || last == "finally")
            return Want::Body;
        if (last == "when" || last == "while" || last == "in" || last == "=" || isOperator(last))
            return Want::Expression;
        if (last == "for" || last == "with" || last == "let") return Want::Nothing;
        return attribute(last, Want::Attribute);
    }

    const syntax::Source& source_;
    std::vector<Token> before_;
    Token current_;
    size_t begin_ = none;
};

class Items {
public:
    Items(const Analysis& analysis, uint32_t offset, const std::vector<LibraryFile>& library)
        : analysis_(analysis), offset_(offset), library_(library) {}

    std::vector<Item> take() { return std::move(items_); }

    void keywords(std::span<const Keyword> words) {
        for (const Keyword& k : words)
            items_.push_back({ItemKind::Keyword, std::string(k.word), "", std::string(k.doc)});
    }
    void operations() {
        for (const auto* row : operations::table().rows())
            items_.push_back({ItemKind::Operation, std::string(row->name), "operation", docOf(row->name)});
    }
    void solids() {
        for (const auto& row : field::primitives())
            items_.push_back({ItemKind::Solid, std::string(row.name), "solid", docOf(row.name)});
    }
    void functions() {
        for (const auto& row : rules::functions())
            items_.push_back({ItemKind::Function, std::string(row.name), "function", docOf(row.name)});
    }
    void plans() {
        for (const auto& row : rules::planRows())
            items_.push_back({ItemKind::Function, std::string(row.name), "plan", docOf(row.name)});
        named(NameKind::Lsystem, ItemKind::Function, "lsystem");
    }
    void joints() {
        for (const char* axis : {"+x", "-x", "+y", "-y", "+z", "-z"})
            items_.push_back({ItemKind::Joint, axis, "joint", ""});
        for (const char* word : {"centre", "free"}) items_.push_back({ItemKind::Joint, word, "joint", docOf(word)});
        named(NameKind::Joint, ItemKind::Joint, "joint");
        named(NameKind::Value, ItemKind::Value, "value");
        named(NameKind::Local, ItemKind::Value, "value");
    }
    void some(std::initializer_list<const char*> words) {
        for (const char* word : words) items_.push_back({ItemKind::Keyword, word, "", docOf(word)});
    }
    void symbols() { named(NameKind::Symbol, ItemKind::Shape, "shape"); }
    void liveSymbols() {
        symbols();
        std::erase_if(
            items_, [](const Item& item) { return item.kind == ItemKind::Shape && !rules::isNonTerminal(item.label); });
    }
    /// Terminals, which lend their look, as materials do.
    void materials() {
        symbols();
        std::erase_if(
            items_, [](const Item& item) { return item.kind == ItemKind::Shape && rules::isNonTerminal(item.label); });
    }
    void parameters() { named(NameKind::Parameter, ItemKind::Parameter, "parameter"); }
    void values() {
        parameters();
        named(NameKind::Value, ItemKind::Value, "value");
        named(NameKind::Local, ItemKind::Value, "value");
        named(NameKind::Constant, ItemKind::Value, "value of the file");
        named(NameKind::Map, ItemKind::Value, "map");
        for (const auto& [param, words] : analysis_.known.choices)
            for (const std::string& word : words) items_.push_back({ItemKind::Choice, word, "choice of " + param, ""});
    }
    void rules() { named(NameKind::Rule, ItemKind::Rule, "rule"); }
    void tags() { named(NameKind::Tag, ItemKind::Value, "tag"); }
    void starts() {
        for (const File& file : analysis_.files)
            for (const auto& start : file.ast.starts)
                items_.push_back({ItemKind::Shape, start.symbol.text, "start", commentOf(start.span)});
    }
    void files() {
        for (const LibraryFile& file : library_)
            items_.push_back({ItemKind::File, file.name, "standard library", purposeOf(*file.source)});
    }
    /// Names of the standard library that the text doesn't know yet.
    void unused() {
        for (const LibraryFile& file : library_) {
            syntax::Diagnostics ignored;
            const syntax::Ast ast = syntax::parse(file.source, operations::table(), ignored);
            const auto offer = [&](const std::string& name, syntax::SourceSpan span) {
                if (analysis_.known.symbols.contains(name)) return;
                items_.push_back({ItemKind::Shape, name, file.name,
                                  fmt::format("{}\n\n```sgm\n{}\n```", commentOf(span),
                                              span.text().substr(0, span.text().find('\n'))),
                                  file.name});
            };
            for (const auto& d : ast.terminals)
                for (const auto& name : d.names) offer(name.text, d.span);
            std::string before;
            for (const auto& d : ast.rules)
                if (d.symbol.text != std::exchange(before, d.symbol.text)) offer(d.symbol.text, d.span);
        }
    }

private:
    /// One item a name of this kind, with the docs of where it is defined; locals where they are known.
    void named(NameKind kind, ItemKind as, const char* detail) {
        std::set<std::string> seen;
        for (const File& file : analysis_.files)
            for (const Occurrence& o : file.names) {
                if (o.kind != kind) continue;
                const bool here = o.span.source == &analysis_.source();
                if (kind == NameKind::Local &&
                    !(here && o.defines && o.declaration.begin <= offset_ && offset_ <= o.declaration.end))
                    continue;
                if (here && o.span.end == offset_ && !o.defines) continue;  // what is being typed
                if (seen.insert(o.name).second) items_.push_back({as, o.name, detail, describe(analysis_, o)});
            }
    }

    const Analysis& analysis_;
    uint32_t offset_;
    const std::vector<LibraryFile>& library_;
    std::vector<Item> items_;
};

void fill(Items& items, Want want) {
    switch (want) {
        case Want::Declaration:
            return items.keywords(declarationWords());
        case Want::Clause:
            return items.keywords(clauseWords());
        case Want::Body:
            items.solids();
            items.symbols();
            items.operations();
            items.some({"for", "while", "when", "choose", "let", "nil", "morph"});
            return items.unused();
        case Want::Attribute:
            items.operations();
            return items.some({"for", "while", "when", "choose", "morph", "finally", "joint", "and", "or"});
        case Want::Expression:
            items.values();
            items.functions();
            items.joints();
            return items.keywords(valueWords());
        case Want::Joint:
            return items.joints();
        case Want::Host:
            return items.some({"last", "any", "each"});
        case Want::Axis:
            return items.some({"x", "y", "z"});
        case Want::Plan:
            return items.plans();
        case Want::Live:
            return items.liveSymbols();
        case Want::Settings:
            return items.parameters();
        case Want::Start:
            return items.starts();
        case Want::Rule:
            return items.rules();
        case Want::Shape:
            return items.symbols();
        case Want::File:
            return items.files();
        case Want::Material:
            items.materials();
            items.values();
            return items.some({"choose"});
        case Want::Tag:
            return items.tags();
        case Want::Nothing:
            return;
    }
}

}  // namespace

std::vector<Item> completionsAt(const Analysis& analysis, uint32_t offset, const std::vector<LibraryFile>& library) {
    Items items(analysis, offset, library);
    fill(items, Scanner(analysis, offset).want());
    return items.take();
}

uint32_t useOffset(const Analysis& analysis) {
    const syntax::Source& source = analysis.source();
    uint32_t line = 1;
    for (const auto& use : analysis.file().ast.uses) line = std::max(line, source.place(use.span.begin).line);
    const std::string_view text = source.line(line);
    const auto end = static_cast<size_t>(text.data() - source.text().data()) + text.size();
    return static_cast<uint32_t>(std::min(end + 1, source.text().size()));
}

}  // namespace sgm::language
