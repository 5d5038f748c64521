#include "grammar/syntax/printer.h"

#include <algorithm>
#include <array>

#include "grammar/syntax/declarations.h"
#include "grammar/syntax/parser.h"

namespace sgm::syntax {

namespace {

constexpr size_t step = 2;            // columns a level is indented
constexpr size_t bodyIndent = 4;      // of a body whose arrow stands too far to the right, or at the end of its line
constexpr size_t rightmostBody = 24;  // column up to which later lines of a body stand under its first word
constexpr size_t widest = 120;        // columns; a table that would be wider isn't aligned

/// Columns of a table of parameters: name, = default, in or of, "label", group, key.
enum Column : size_t { First, Default, Range, Label, Group, Key, columns };

/// One line of output. Only a parameter's line has more than its first cell.
struct Line {
    bool blankBefore = false;
    bool isParam = false;
    size_t indent = 0;
    std::array<std::string, columns> cells;
    std::string comment;  ///< trailing, or alone in its line
};

/// Columns a text takes: its code points.
size_t widthOf(std::string_view text) {
    return static_cast<size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

std::string_view withoutTrailingBlanks(std::string_view text) {
    const size_t last = text.find_last_not_of(" \t\r");
    return text.substr(0, last == std::string_view::npos ? 0 : last + 1);
}

/// Lays tokens out in lines: the author's line breaks, our blanks and indents.
class Layout {
public:
    Layout(const Source& source, const std::vector<Token>& tokens) : source_(source), tokens_(tokens) {}

    std::vector<Line> lines() {
        for (size_t i = 0; i < tokens_.size(); ++i) {
            const Token& token = tokens_[i];
            if (token.kind == Token::Kind::Blank) {
                const std::string_view blank = text(i);
                newlines_ += static_cast<size_t>(std::count(blank.begin(), blank.end(), '\n'));
                continue;
            }
            if (newlines_ > 0 || lines_.empty()) beginLine(i);
            if (token.kind == Token::Kind::Comment)
                lines_.back().comment = withoutTrailingBlanks(text(i));
            else
                place(i);
            newlines_ = 0;
        }
        return std::move(lines_);
    }

private:
    std::string_view text(size_t i) const {
        return i < tokens_.size() ? textOf(source_, tokens_[i]) : std::string_view();
    }
    bool opens(size_t i) const { return text(i) == "(" || text(i) == "[" || text(i) == "{"; }
    bool closes(size_t i) const { return text(i) == ")" || text(i) == "]" || text(i) == "}"; }
    /// A token from which later lines of a body are indented.
    bool leadsBody(size_t i) const { return declaration_ != "lsystem" && (text(i) == "->" || text(i) == "finally"); }
    bool isDeclaration(size_t i) const {
        return tokens_[i].columnOne && (text(i) == "grammar" || findDeclaration(text(i)));
    }

    void beginLine(size_t i) {
        Line line;
        line.blankBefore = newlines_ > 1 && !lines_.empty();
        if (isDeclaration(i)) {
            declaration_ = text(i);
            bodyColumn_ = depth_ = 0;
            line.isParam = declaration_ == "param";
        } else if (!(tokens_[i].kind == Token::Kind::Comment && tokens_[i].columnOne)) {
            const size_t outer = depth_ - std::min<size_t>(depth_, closes(i));
            line.indent = (leadsBody(i) ? step : std::max(step, bodyColumn_)) + step * outer;
        }
        lines_.push_back(std::move(line));
        column_ = First;
        previous_ = tokens_.size();
    }

    /// Appends a token to the last line.
    void place(size_t i) {
        Line& line = lines_.back();
        if (line.isParam && depth_ == 0) column_ = columnOf(i);
        std::string& cell = line.cells[column_];
        if (!cell.empty() && blankBetween(previous_, i)) cell += ' ';
        cell += text(i);
        if (opens(i)) ++depth_;
        if (closes(i) && depth_ > 0) --depth_;
        if (leadsBody(i) && depth_ == 0) {
            const size_t column = line.indent + widthOf(line.cells[First]) + 1;
            bodyColumn_ = column <= rightmostBody && !endsLine(i) ? column : bodyIndent;
        }
        previous_ = i;
    }

    /// Nothing but a comment follows in the line.
    bool endsLine(size_t i) const {
        size_t next = i + 1;
        if (text(next).find('\n') != std::string_view::npos) return true;
        if (next < tokens_.size() && tokens_[next].kind == Token::Kind::Blank) ++next;
        return next >= tokens_.size() || tokens_[next].kind == Token::Kind::Comment;
    }

    /// The column a token of a parameter's line begins, or the one it goes on with.
    Column columnOf(size_t i) const {
        if (column_ == First && text(i) == "=") return Default;
        if (tokens_[i].role != Token::Role::Part) return column_;
        if (tokens_[i].kind == Token::Kind::Text) return Label;
        return text(i) == "group" ? Group : text(i) == "key" ? Key : Range;
    }

    bool blankBetween(size_t before, size_t after) const {
        using Role = Token::Role;
        const Role left = tokens_[before].role, right = tokens_[after].role;
        if (left == Role::Prefix || left == Role::Tight || right == Role::Suffix || right == Role::Tight) return false;
        if (text(before) == "(" || text(before) == "[" || text(after) == ")" || text(after) == "]" ||
            text(after) == ",")
            return false;
        if (text(before) == "..") return isWideRange(before);
        if (text(after) == "..") return isWideRange(after);
        return true;
    }

    /// 0 .. .5 can be read, 0...5 can't.
    bool isWideRange(size_t dots) const {
        size_t next = dots + 1;
        while (next < tokens_.size() && isTrivia(tokens_[next].kind)) ++next;
        return text(next).substr(0, 1) == ".";
    }

    const Source& source_;
    const std::vector<Token>& tokens_;
    std::vector<Line> lines_;
    std::string_view declaration_;
    size_t newlines_ = 0, depth_ = 0, bodyColumn_ = 0, previous_ = 0;
    Column column_ = First;
};

/// Joins the cells of parameters that stand one below the other into a table.
void alignParams(std::vector<Line>& lines, size_t begin, size_t end) {
    std::array<size_t, columns> width{};
    for (size_t i = begin; i < end; ++i)
        for (size_t c = 0; c < columns; ++c) width[c] = std::max(width[c], widthOf(lines[i].cells[c]));
    size_t total = 0;
    for (const size_t w : width) total += w + (w > 0);
    for (size_t i = begin; i < end; ++i) {
        std::string joined;
        size_t column = 0;
        for (size_t c = 0; c < columns; ++c) {
            const std::string& cell = lines[i].cells[c];
            if (!cell.empty()) {
                if (total <= widest)
                    joined.append(column - std::min(column, widthOf(joined)), ' ');
                else if (!joined.empty())
                    joined += ' ';
                joined += cell;
            }
            column += width[c] + (width[c] > 0);
            lines[i].cells[c].clear();
        }
        lines[i].cells[First] = std::move(joined);
    }
}

/// Trailing comments of lines one below the other begin in one column.
size_t commentColumn(const std::vector<Line>& lines, size_t begin, size_t end) {
    size_t column = 0;
    for (size_t i = begin; i < end; ++i)
        column = std::max(column, lines[i].indent + widthOf(lines[i].cells[First]) + 2);
    return column;
}

/// Calls `use(begin, end)` for every longest run of lines without a blank one between that all are `fit`.
template <class Fit, class Use>
void forRuns(const std::vector<Line>& lines, Fit fit, Use use) {
    for (size_t begin = 0; begin < lines.size();) {
        size_t end = begin;
        while (end < lines.size() && fit(lines[end]) && (end == begin || !lines[end].blankBefore)) ++end;
        if (end > begin) use(begin, end);
        begin = std::max(end, begin + 1);
    }
}

std::string write(std::vector<Line> lines) {
    forRuns(
        lines, [](const Line& l) { return l.isParam; },
        [&](size_t begin, size_t end) { alignParams(lines, begin, end); });
    forRuns(
        lines, [](const Line& l) { return !l.comment.empty() && !l.cells[First].empty(); },
        [&](size_t begin, size_t end) {
            const size_t column = commentColumn(lines, begin, end);
            for (size_t i = begin; i < end; ++i) {
                std::string& cell = lines[i].cells[First];
                cell.append(column - lines[i].indent - widthOf(cell), ' ');
            }
        });
    std::string out;
    for (const Line& line : lines) {
        if (line.blankBefore) out += '\n';
        out.append(line.indent, ' ').append(line.cells[First]).append(line.comment) += '\n';
    }
    return out;
}

}  // namespace

std::string format(const Source& source, const OperationTable& operations) {
    // The parser wants to share its source; this one is only borrowed for the call.
    const SourcePtr borrowed(std::shared_ptr<void>(), &source);
    Diagnostics diagnostics;
    std::vector<Token> significant = lexSignificant(source);
    parse(borrowed, significant, operations, diagnostics);
    if (diagnostics.hasErrors()) return std::string(source.text());

    std::vector<Token> tokens = lex(source);
    auto next = significant.begin();
    for (Token& token : tokens)
        if (!isTrivia(token.kind)) token.role = (next++)->role;
    return write(Layout(source, tokens).lines());
}

std::string_view sign(Operator op) {
    constexpr std::string_view signs[] = {"", "+", "-", "&", "morph"};
    return signs[static_cast<size_t>(op)];
}

}  // namespace sgm::syntax
