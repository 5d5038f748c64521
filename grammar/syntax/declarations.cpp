#include "grammar/syntax/declarations.h"

#include <algorithm>

#include "grammar/syntax/bodies.h"
#include "grammar/syntax/expressions.h"
#include "grammar/syntax/lsystems.h"

namespace sgm::syntax {

namespace {

void readUse(Cursor& cursor, Ast& ast) {
    UseDecl use;
    const uint32_t begin = cursor.take().begin;
    use.file = readText(cursor, "a file's name");
    if (cursor.at("{")) use.settings = readSettings(cursor);
    use.span = cursor.since(begin);
    ast.uses.push_back(std::move(use));
}

/// The words after a parameter's default: in, of, "label", group, key.
void readParamPart(Cursor& cursor, ParamDecl& param) {
    if (cursor.accept("in")) {
        param.range = readExpr(cursor);
    } else if (cursor.accept("of")) {
        do param.choices.push_back(readName(cursor, "a choice"));
        while (cursor.accept(","));
    } else if (cursor.at(Token::Kind::Text)) {
        param.label = readArgument(cursor).text;
    } else if (cursor.accept("group")) {
        param.group = readName(cursor, "a group").text;
    } else {
        cursor.take();
        param.key = readName(cursor, "a key");
        if (param.key.text.size() > 1)
            cursor.complain(param.key.span, "a key is one letter", "write 'key " + param.key.text.substr(0, 1) + "'");
    }
}

bool atParamPart(const Cursor& cursor) {
    return cursor.at("in") || cursor.at("of") || cursor.at("group") || cursor.at("key") || cursor.at(Token::Kind::Text);
}

/// The line with its default before its range: 'param n = 2 in 0..4' for 'param n in 0..4 = 2'.
std::string defaultFirst(const Cursor& cursor, const Name& name) {
    std::string part, value = "…";
    for (size_t i = 0; cursor.peek(i).kind != Token::Kind::End; ++i) {
        if (cursor.at("=", i)) {
            if (cursor.peek(i + 1).kind != Token::Kind::End) value = std::string(cursor.peekText(i + 1));
            break;
        }
        if (cursor.at(Token::Kind::Text, i)) break;
        part += (i > 0 && !cursor.peek(i).glued ? " " : "") + std::string(cursor.peekText(i));
    }
    if (value == "…" && cursor.at("in") && cursor.at("..", 2)) value = std::string(cursor.peekText(1));
    return "write 'param " + name.text + " = " + value + " " + part + "'";
}

/// The line with its choices behind 'of': 'param wall = brick of brick, stone' for 'param wall = brick | stone'.
std::string choicesBehindOf(const Cursor& cursor, const ParamDecl& param) {
    if (!param.choices.empty() || cursor.previous(1).kind != Token::Kind::Word)
        return "write them with commas, as in 'of brick, stone'";
    const std::string first(cursor.text(cursor.previous(1)));
    std::string choices = first;
    for (size_t i = 0; cursor.at("|", i) && cursor.peek(i + 1).kind == Token::Kind::Word; i += 2)
        choices += ", " + std::string(cursor.peekText(i + 1));
    return "write 'param " + param.name.text + " = " + first + " of " + choices + "'";
}

void readParam(Cursor& cursor, Ast& ast) {
    ParamDecl param;
    const uint32_t begin = cursor.take().begin;
    param.name = readName(cursor, "a parameter");
    if (atParamPart(cursor) && !cursor.at(Token::Kind::Text)) {
        cursor.fail("the default of parameter " + quoted(param.name.text) + " comes first",
                    defaultFirst(cursor, param.name));
        return;
    }
    cursor.expect("=", "and a default after the parameter's name", missingEqualsHint(cursor, param.name));
    param.value = readExpr(cursor);
    while (atParamPart(cursor)) {
        cursor.mark(Token::Role::Part);
        readParamPart(cursor, param);
    }
    if (cursor.at("|")) cursor.fail("choices are listed behind 'of'", choicesBehindOf(cursor, param));
    param.span = cursor.since(begin);
    if (!param.name.empty()) ast.params.push_back(std::move(param));
}

/// #7fb2d9: river, #9cc77c: park, else: dry
void readMapClasses(Cursor& cursor, MapDecl& map) {
    do {
        MapDecl::Class& c = map.classes.emplace_back();
        const uint32_t begin = cursor.peek().begin;
        if (cursor.at("else")) {
            cursor.take();
        } else if (cursor.at(Token::Kind::Color)) {
            c.color = readArgument(cursor);
        } else {
            cursor.fail("expected a colour or 'else', found " + cursor.found(), "write '#7fb2d9: river, else: dry'");
            return;
        }
        if (!cursor.accept(":", Token::Role::Suffix)) cursor.expect(":", "and a word after the colour");
        c.word = readName(cursor, "a class of land");
        c.span = cursor.since(begin);
    } while (cursor.accept(","));
}

void readMap(Cursor& cursor, Ast& ast) {
    MapDecl map;
    const uint32_t begin = cursor.take().begin;
    map.name = readName(cursor, "a map");
    cursor.expect("=", "after the map's name", missingEqualsHint(cursor, map.name));
    if (cursor.at(Token::Kind::Text)) {
        map.file = readArgument(cursor);
    } else {
        const std::string file(cursor.peekText());
        map.formula = readExpr(cursor);
        const syntax::Expr& formula = *map.formula;
        if (formula.kind == Expr::Kind::Member && formula.text == "png")
            cursor.failAt(formula.span, "expected a file's name in quotes, found " + quoted(file),
                          "write '\"" + file + ".png\"'");
    }
    for (bool more = true; more && !cursor.done();) {
        more = false;
        if (cursor.at("as") && !map.range) cursor.take(), map.range = readExpr(cursor), more = true;
        if (cursor.at("of") && map.classes.empty()) cursor.take(), readMapClasses(cursor, map), more = true;
        if (cursor.at("over") && !map.over) cursor.take(), map.over = readExpr(cursor), more = true;
    }
    map.span = cursor.since(begin);
    if (!map.name.empty()) ast.maps.push_back(std::move(map));
}

void readRoads(Cursor& cursor, Ast& ast) {
    RoadsDecl roads;
    const uint32_t begin = cursor.take().begin;
    roads.name = readName(cursor, "roads");
    if (cursor.at("from")) {
        cursor.take();
        if (cursor.at(Token::Kind::Text))
            roads.file = readArgument(cursor);
        else
            cursor.fail("expected a file's name in quotes, found " + cursor.found(),
                        "write 'from \"streets.geojson\"'");
    }
    roads.settings = readSettings(cursor);
    roads.span = cursor.since(begin);
    if (!roads.name.empty()) ast.roads.push_back(std::move(roads));
}

TerminalDecl::JointDecl readJoint(Cursor& cursor) {
    TerminalDecl::JointDecl joint;
    const uint32_t begin = cursor.take().begin;
    joint.name = readName(cursor, "a joint");
    if (cursor.expect("at", "and a point after the joint's name")) joint.at = readArgument(cursor);
    if (cursor.expect("facing", "and a direction after the joint's point")) joint.facing = readArgument(cursor);
    joint.span = cursor.since(begin);
    return joint;
}

/// The name of a new symbol: an operation's word can't be one, since it would read as an attribute.
Name readSymbol(Cursor& cursor, std::string_view what) {
    Name name = readName(cursor, what);
    if (!name.empty() && (cursor.operations().find(name.text) || isLaterOperation(name.text)))
        cursor.complain(name.span, quoted(name.text) + " is an operation and can't name " + std::string(what));
    return name;
}

void readLook(Cursor& cursor, Ast& ast, bool isMaterial) {
    TerminalDecl terminal;
    terminal.isMaterial = isMaterial;
    const uint32_t begin = cursor.take().begin;
    do terminal.names.push_back(readSymbol(cursor, isMaterial ? "a material" : "a terminal"));
    while (cursor.accept(","));
    if (isMaterial && (cursor.at("=") || cursor.at("joint")))
        cursor.fail("a material is a look alone: it has no solid and no joints", "write 'terminal' for a shape");
    if (cursor.accept("=")) terminal.solid = readSolid(cursor);
    while (atAttribute(cursor) || cursor.at("joint")) {
        if (cursor.at("joint"))
            terminal.joints.push_back(readJoint(cursor));
        else
            terminal.attributes.push_back(readAttribute(cursor));
    }
    terminal.span = cursor.since(begin);
    if (!terminal.names[0].empty()) ast.terminals.push_back(std::move(terminal));
}

void readTerminal(Cursor& cursor, Ast& ast) { readLook(cursor, ast, false); }
void readMaterial(Cursor& cursor, Ast& ast) { readLook(cursor, ast, true); }

void readLet(Cursor& cursor, Ast& ast) {
    LetDecl let;
    const uint32_t begin = cursor.take().begin;
    let.name = readName(cursor, "a value");
    cursor.expect("=", "after the value's name", missingEqualsHint(cursor, let.name));
    let.value = readExpr(cursor);
    let.span = cursor.since(begin);
    if (!let.name.empty()) ast.lets.push_back(std::move(let));
}

void readStart(Cursor& cursor, Ast& ast) {
    StartDecl start;
    const uint32_t begin = cursor.take().begin;
    start.symbol = readSymbol(cursor, "a symbol");
    if (cursor.at("when") || cursor.at("weight"))
        cursor.fail("a start has no " + cursor.found(),
                    "let the start put a symbol, and give its rules a 'when' or a 'weight'");
    cursor.resume(0, Cursor::Next::Body);
    expectArrow(cursor, "after the start's symbol");
    start.body = readBody(cursor);
    start.span = cursor.since(begin);
    if (!start.symbol.empty()) ast.starts.push_back(std::move(start));
}

/// What may stand between a rule's symbol and its arrow, in any order, each once.
bool readRuleCondition(Cursor& cursor, RuleDecl& rule) {
    const Token word = cursor.peek();
    const bool again = (cursor.at("beside") && !rule.beside.empty()) || (cursor.at("after") && !rule.after.empty()) ||
                       (cursor.at("when") && rule.when) || (cursor.at("weight") && rule.weight) ||
                       (cursor.at("repeat") && rule.repeat);
    if (cursor.accept("beside"))
        rule.beside = readName(cursor, "a symbol");
    else if (cursor.accept("after"))
        rule.after = readName(cursor, "a symbol");
    else if (cursor.accept("when"))
        rule.when = readExpr(cursor);
    else if (cursor.accept("weight"))
        rule.weight = readExpr(cursor);
    else if (cursor.accept("repeat"))
        rule.repeat = readExpr(cursor);
    else
        return false;
    if (again)
        cursor.complain(cursor.span(word), quoted(cursor.text(word)) + " stands twice before '->'", "say it once");
    return true;
}

void readRule(Cursor& cursor, Ast& ast) {
    RuleDecl rule;
    const uint32_t begin = cursor.take().begin;
    if (cursor.at(":", 1)) {
        rule.name = readName(cursor, "a rule");
        cursor.take(Token::Role::Suffix);
    }
    rule.symbol = readSymbol(cursor, "a symbol");
    while (readRuleCondition(cursor, rule)) {
    }
    if (cursor.at(Token::Kind::Number))
        cursor.fail("expected '->' after what the rule matches, found " + cursor.found(),
                    "the weight of a rule among others is written 'weight 30'");
    if (cursor.at("("))
        cursor.fail("rules take no parameters",
                    "declare 'param height = 3m' and hand a value down: '" + rule.symbol.text + " with height = 4m'");
    if (cursor.at(Token::Kind::Word) && !cursor.at("->")) {
        const std::string near = didYouMean(cursor.peekText(), {"beside", "after", "when", "weight", "repeat"});
        cursor.fail(
            "expected '->' after what the rule matches, found " + cursor.found(),
            near.empty() ? "write '-> " + std::string(cursor.peekText()) + "'" : "did you mean '" + near + "'?");
    }
    cursor.resume(0, Cursor::Next::Body);
    expectArrow(cursor, "after what the rule matches");
    rule.body = readBody(cursor);
    if (cursor.accept("finally")) rule.finally_ = readBody(cursor);
    rule.span = cursor.since(begin);
    if (!rule.symbol.empty()) ast.rules.push_back(std::move(rule));
}

/// Name {/ Name | [ index ]}: a path in the tree, as written but without blanks.
Expr readPath(Cursor& cursor) {
    const uint32_t begin = cursor.peek().begin;
    Expr path;
    path.kind = Expr::Kind::Text;
    path.text = readName(cursor, "a shape in the tree").text;
    while (!cursor.done() && (cursor.at("/") || cursor.at("["))) {
        if (cursor.accept("/", Token::Role::Tight)) {
            path.text += '/' + readName(cursor, "a shape in the tree").text;
            continue;
        }
        const Token open = cursor.take(Token::Role::Tight);
        if (!cursor.at(Token::Kind::Number)) cursor.fail("expected a number in '[ ]', found " + cursor.found());
        path.text += '[' + std::string(cursor.text(cursor.take())) + ']';
        cursor.close(open);
    }
    path.span = cursor.since(begin);
    return path;
}

void readDerive(Cursor& cursor, Ast& ast) {
    DeriveDecl derive;
    const uint32_t begin = cursor.take().begin;
    derive.name = readName(cursor, "a derivation");
    if (!cursor.accept(":", Token::Role::Suffix)) cursor.expect(":", "after the derivation's name");
    do {
        DeriveDecl::Step step;
        step.rule = readName(cursor, "a rule");
        if (cursor.at(Token::Kind::Color) && cursor.peek().glued) {  // Cell#2: the second rule for Cell without a name
            const Token number = cursor.take(Token::Role::Suffix);
            step.rule = {step.rule.text + std::string(cursor.text(number)), join(step.rule.span, cursor.span(number))};
        }
        step.hasPlace = cursor.accept("at");
        if (step.hasPlace) {
            step.at = readPath(cursor);
            step.place = step.at.text;
        }
        derive.steps.push_back(std::move(step));
    } while (cursor.accept("=>"));
    if (cursor.at("->")) cursor.fail("expected '=>' between steps, found '->'", "write '=>'");
    derive.span = cursor.since(begin);
    if (!derive.name.empty()) ast.derives.push_back(std::move(derive));
}

void readStyle(Cursor& cursor, Ast& ast) {
    StyleDecl style;
    const uint32_t begin = cursor.take().begin;
    style.name = readName(cursor, "a style");
    if (cursor.accept("for")) style.start = readName(cursor, "a start");
    style.settings = readSettings(cursor);
    style.span = cursor.since(begin);
    if (!style.name.empty()) ast.styles.push_back(std::move(style));
}

void readCheck(Cursor& cursor, Ast& ast) {
    CheckDecl check;
    const uint32_t begin = cursor.take().begin;
    check.start = readName(cursor, "a start");
    if (!cursor.at("expect")) check.settings = readSettings(cursor);
    if (cursor.expect("expect", "and a condition after the settings", "as in 'expect bonds == 3'"))
        check.expect = readExpr(cursor);
    check.span = cursor.since(begin);
    if (!check.start.empty()) ast.checks.push_back(std::move(check));
}

constexpr Declaration table[] = {
    {"use", readUse},           {"param", readParam},       {"let", readLet},     {"map", readMap},
    {"material", readMaterial}, {"terminal", readTerminal}, {"start", readStart}, {"rule", readRule},
    {"derive", readDerive},     {"lsystem", readLsystem},   {"roads", readRoads}, {"style", readStyle},
    {"check", readCheck},
};

}  // namespace

std::span<const Declaration> declarations() { return table; }

const Declaration* findDeclaration(std::string_view word) {
    const auto row =
        std::find_if(std::begin(table), std::end(table), [&](const Declaration& d) { return d.word == word; });
    return row == std::end(table) ? nullptr : row;
}

}  // namespace sgm::syntax
