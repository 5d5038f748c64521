// Edits of parameter values and styles.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grammar/syntax/parser.h"
#include "viewer/document/nodes.h"

namespace sgm::document::edits {
namespace {

using syntax::ParamDecl;
using syntax::Setting;
using syntax::StyleDecl;
using syntax::UseDecl;

/// The style of that name that counts for the start: its own, or one for any start; where it is asked for by name, any.
const StyleDecl* styleFor(const Ast& ast, std::string_view name, std::string_view start) {
    const StyleDecl* found = nullptr;
    for (const StyleDecl& style : ast.styles)
        if (style.name.text == name && (style.start.text == start || (style.start.empty() && !found))) found = &style;
    for (const StyleDecl& style : ast.styles)
        if (!found && name != "default" && style.name.text == name) found = &style;
    return found;
}

/// The style of just this name and start.
const StyleDecl* exactStyle(const Ast& ast, std::string_view name, std::string_view start) {
    for (const StyleDecl& style : ast.styles)
        if (style.name.text == name && style.start.text == start) return &style;
    return nullptr;
}

const Setting* find(const std::vector<Setting>& settings, std::string_view name) {
    for (const Setting& s : settings)
        if (s.name.text == name) return &s;
    return nullptr;
}

TextEdit over(syntax::SourceSpan span, std::string text) { return {span.begin, span.end, std::move(text)}; }

/// " name = value" into the braces of a declaration that ends with '}', behind what stands there.
TextEdit intoBraces(const Ast& ast, syntax::SourceSpan declaration, const std::vector<Setting>& settings,
                    std::string text) {
    const uint32_t brace = declaration.end - 1;
    const uint32_t at = settings.empty() ? endBefore(ast, brace) : settings.back().span.end;
    const bool tight = settings.empty() && at == brace;
    return {at, at, " " + std::move(text) + (tight ? " " : "")};
}

std::string settingText(const NamedValue& v) { return v.name + " = " + v.value; }

/// Where one value is written. Values that are new to the same braces are gathered in `added`.
class Values {
public:
    Values(const Ast& ast, std::string_view start, std::string_view style) : ast_(ast), start_(start), style_(style) {}

    Status set(const NamedValue& value) {
        if (!style_.empty()) {
            const StyleDecl* style = styleFor(ast_, style_, start_);
            if (!style) return refused(fmt::format("there is no style '{}'", style_));
            return write(style->span, style->settings, value);
        }
        if (const StyleDecl* style = styleFor(ast_, "default", start_))
            if (const Setting* s = find(style->settings, value.name))
                return edits_.push_back(over(s->value.span, value.value)), Done{};
        for (auto use = ast_.uses.rbegin(); use != ast_.uses.rend(); ++use)
            if (const Setting* s = find(use->settings, value.name))
                return edits_.push_back(over(s->value.span, value.value)), Done{};
        for (const ParamDecl& param : ast_.params)
            if (param.name.text == value.name) return edits_.push_back(over(param.value.span, value.value)), Done{};
        if (ast_.uses.empty()) return refused(fmt::format("there is no parameter '{}'", value.name));
        const UseDecl& use = ast_.uses.front();
        if (!use.settings.empty() || use.span.text().back() == '}') return write(use.span, use.settings, value);
        afterUse_ += (afterUse_.empty() ? "" : " ") + settingText(value);
        return Done{};
    }

    Edit whole() {
        if (!afterUse_.empty()) {
            const uint32_t end = ast_.uses.front().span.end;
            edits_.push_back({end, end, " { " + afterUse_ + " }"});
        }
        for (const auto& [span, settings, text] : added_) edits_.push_back(intoBraces(ast_, span, *settings, text));
        return tried(ast_, merged(ast_.source->text(), std::move(edits_)));
    }

private:
    struct Added {
        syntax::SourceSpan span;
        const std::vector<Setting>* settings;
        std::string text;
    };

    Status write(syntax::SourceSpan span, const std::vector<Setting>& settings, const NamedValue& value) {
        if (const Setting* s = find(settings, value.name))
            return edits_.push_back(over(s->value.span, value.value)), Done{};
        for (Added& added : added_)
            if (added.settings == &settings) return added.text += " " + settingText(value), Done{};
        added_.push_back({span, &settings, settingText(value)});
        return Done{};
    }

    const Ast& ast_;
    std::string_view start_, style_;
    std::vector<TextEdit> edits_;
    std::vector<Added> added_;
    std::string afterUse_;
};

std::string styleText(std::string_view name, std::string_view start, const std::vector<NamedValue>& values) {
    constexpr size_t widest = 100;
    const std::string head = fmt::format("style {}{} {{", name, start.empty() ? "" : fmt::format(" for {}", start));
    std::string text = head;
    for (const NamedValue& v : values) text += " " + settingText(v);
    text += " }";
    if (text.size() <= widest) return text;
    text = head;
    std::string line = "   ";
    for (const NamedValue& v : values) {
        if (line.size() + settingText(v).size() > widest) {
            text += "\n" + line;
            line = "   ";
        }
        line += " " + settingText(v);
    }
    return text + "\n" + line + "\n  }";
}

}  // namespace

Edit setValues(const Ast& ast, std::string_view start, std::string_view style, const std::vector<NamedValue>& values) {
    Values written(ast, start, style);
    for (const NamedValue& value : values) {
        const auto text = asExpression(value.value);
        if (!text.ok()) return text.error();
        if (const Status s = written.set({value.name, *text}); !s.ok()) return s.error();
    }
    return written.whole();
}

Edit saveStyle(const Ast& ast, std::string_view name, std::string_view start, const std::vector<NamedValue>& values) {
    const auto known = asName(name);
    if (!known.ok()) return known.error();
    const std::string line = styleText(*known, start, values);
    if (const StyleDecl* same = exactStyle(ast, *known, start)) return tried(ast, over(same->span, line));
    const std::string_view text = ast.source->text();
    if (!ast.styles.empty()) {
        const uint32_t end = lineEnd(text, ast.styles.back().span.end);
        return tried(ast, {end, end, "\n" + line});
    }
    const auto end = static_cast<uint32_t>(text.size());
    return tried(ast, {end, end, (text.empty() || text.back() == '\n' ? "\n" : "\n\n") + line + "\n"});
}

Edit removeSetting(const Ast& ast, std::string_view start, std::string_view style, std::string_view param) {
    const StyleDecl* found = styleFor(ast, style, start);
    const Setting* setting = found ? find(found->settings, param) : nullptr;
    if (!setting) return refused(fmt::format("style '{}' doesn't set '{}'", style, param));
    return tried(ast, removal(ast.source->text(), setting->span.begin, setting->span.end));
}

Edit removeStyle(const Ast& ast, std::string_view name, std::string_view start) {
    const StyleDecl* found = exactStyle(ast, name, start);
    if (!found) return refused(fmt::format("there is no style '{}'", name));
    return tried(ast, removal(ast.source->text(), found->span.begin, found->span.end));
}

namespace {

/// A line of its own behind the last parameter, or else behind the last `use`, or else behind the version.
TextEdit parameterLine(const Ast& ast, std::string line) {
    const std::string_view text = ast.source->text();
    const uint32_t last = !ast.params.empty() ? ast.params.back().span.end
                          : !ast.uses.empty() ? ast.uses.back().span.end
                                              : tokenFrom(ast, tokenFrom(ast, 0).end).end;
    const uint32_t end = lineEnd(text, last);
    return {end, end, "\n" + std::move(line)};
}

bool isParameter(const Ast& ast, std::string_view name) {
    return std::any_of(ast.params.begin(), ast.params.end(), [&](const ParamDecl& p) { return p.name.text == name; });
}

/// "1.5", ".75", and "2.0" for a number that isn't counted.
std::string numberText(double value, Quantity quantity) {
    std::string text = fmt::format("{:.4g}", value);
    if (text.substr(0, 2) == "0.") text.erase(0, 1);
    const bool whole = text.find_first_of(".e") == std::string::npos;
    return quantity == Quantity::Real && whole ? text + ".0" : text;
}

}  // namespace

Edit addParameter(const Ast& ast, std::string_view written) {
    syntax::Diagnostics problems;
    const syntax::Ast alone = syntax::parse(
        std::make_shared<const syntax::Source>("param", fmt::format("grammar {}\nparam {}\n", ast.version, written)),
        *ast.operations, problems);
    if (problems.hasErrors()) return refused(problems.all()[0].message);
    if (alone.params.size() != 1 || written.find('\n') != std::string_view::npos)
        return refused("write 'name = value in least..most'");
    if (isParameter(ast, alone.params[0].name.text))
        return refused(fmt::format("there is a parameter '{}' already", alone.params[0].name.text));
    return tried(ast, parameterLine(ast, fmt::format("param {}", written)));
}

Edit makeParameter(const Ast& ast, const syntax::Expr& number, std::string_view name, Quantity quantity) {
    if (number.kind != syntax::Expr::Kind::Number || !(number.number > 0))
        return refused("only a number above 0 becomes a parameter");
    const std::string unit = number.unit.empty() && quantity == Quantity::Metres ? "m" : number.unit;
    if (!unit.empty()) quantity = Quantity::Metres;  // a unit says that it isn't counted
    std::string called(name);
    for (int i = 2; isParameter(ast, called); ++i) called = fmt::format("{}{}", name, i);
    const double least = quantity == Quantity::Count ? std::max(1.0, std::floor(number.number / 2)) : number.number / 2;
    const auto text = [&](double value) { return numberText(value, quantity) + unit; };
    const TextEdit line = parameterLine(
        ast, fmt::format("param {} = {} in {}..{}", called, text(number.number), text(least), text(2 * number.number)));
    return tried(ast, merged(ast.source->text(), {line, over(number.span, called)}));
}

}  // namespace sgm::document::edits
