// Text to syntax tree, by recursive descent. The grammar of the language stands below, whole.
// Enters: a Source. Leaves: an Ast of everything that could be read, and diagnostics for the rest. Never throws;
// recovery restarts at the next part of a block or body (Cursor::Next), else at a keyword in column one, so one run
// shows all problems and a slip is reported once.
//
// clang-format off
//   file        = "grammar" ( "1" | "2" ) { declaration } .              a declaration's word stands in column one
//   declaration = use | param | let | map | material | terminal | start | rule | derive | lsystem | roads | style | check .
//
//   use         = "use" TEXT [ settings ] .
//   param       = "param" NAME "=" expr { "in" expr | "of" NAME {"," NAME} | TEXT | "group" NAME | "key" NAME } .
//   map         = "map" NAME "=" ( TEXT | expr ) { "as" expr | "of" class {"," class} | "over" expr } .
//   class       = ( COLOR | "else" ) ":" NAME .
//   roads       = "roads" NAME [ "from" TEXT ] settings .
//   let         = "let" NAME "=" expr .
//   material    = "material" NAME {"," NAME} { attribute } .
//   terminal    = "terminal" NAME {"," NAME} [ "=" solid ]
//                 { attribute | "joint" NAME "at" argument "facing" argument } .
//   start       = "start" NAME "->" body .
//   rule        = "rule" [ NAME ":" ] NAME
//                 { "beside" NAME | "after" NAME | "when" expr | "weight" expr | "repeat" expr } "->" body [ "finally" body ] .
//   derive      = "derive" NAME ":" step { "=>" step } .
//   step        = NAME [ "#" DIGITS ] [ "at" path ] .                    glued; Cell#2 is the second unnamed rule for Cell
//   path        = NAME { "/" NAME | "[" NUMBER "]" } .
//   lsystem     = "lsystem" NAME { NAME argument } "axiom" TEXT { production } .
//   production  = [ NAME "<" ] NAME [ "(" NAME { "," NAME } ")" ] [ ">" NAME ] "->" TEXT [ "when" expr ]
//                 [ ":" argument ] .
//   style       = "style" NAME [ "for" NAME ] settings .
//   check       = "check" NAME [ settings ] "expect" expr .
//   settings    = "{" { NAME "=" expr } "}" .
//
//   body        = chain { "," chain } .                                  siblings
//   chain       = element { element } .                                  every one but the first has an operator, is control
//                                                                        or stands behind "let"
//   element     = [ operator ] shape | control .
//   operator    = "+" | "-" | "&" | "morph" .                            "morph" glued to "(" is a solid
//   shape       = { attribute } [ solid | "(" body ")" ] { attribute } [ ":" NAME ] .       not empty
//   control     = "for" NAME "in" expr [ "when" expr ] "{" body "}" | ( "while" | "when" ) expr "{" body "}"
//               | "choose" [ "distinct" | "shuffled" ] block | "let" NAME "=" argument .
//   solid       = NAME | call .
//   attribute   = OPERATION { [ WORD ] argument } [ block | "{" body "}" ] .
//                                                                        as its row of the operation table says;
//                                                                        "with" NAME "=" argument
//   block       = "{" case { "|" case } "}" .
//   case        = ( expr | "tag" NAME ) ":" body | block "*" .
//
//   argument    = limit [ "~>" limit ] .                                 binds tighter than any operator of a body
//   limit       = simple [ ".." simple ] .
//   simple      = "-" simple | postfix .
//   expr        = range [ "~>" range ] .
//   range       = or [ ".." or ] .
//   or          = and { "or" and } .
//   and         = not { "and" not } .
//   not         = "not" not | sum [ ( "==" | "!=" | "<" | "<=" | ">" | ">=" ) sum ] .
//   sum         = product { ( "+" | "-" ) product } .
//   product     = unary { ( "*" | "/" | "%" ) unary } .
//   unary       = "-" unary | postfix .
//   postfix     = primary { "[" expr "]" | "." NAME } .
//   primary     = NUMBER | TEXT | COLOR | AXIS | NAME | call | "~" simple | "(" expr { "," expr } ")"
//               | "choose" [ "distinct" | "shuffled" ] "{" expr ":" expr { "|" expr ":" expr } "}" .
//   call        = NAME "(" [ [ NAME ":" ] expr { "," [ NAME ":" ] expr } ] ")" .            "(" glued to NAME
//
//   NUMBER      = ( DIGITS [ "." DIGITS ] | "." DIGITS ) [ "e" [ "+" | "-" ] DIGITS ]
//                 [ "m" | "km" | "cm" | "mm" | "m2" | "m²" | "m3" | "m³" | "deg" | "%" | "/m" ] .  glued
//   AXIS        = ( "+" | "-" ) ( "x" | "y" | "z" ) .                    glued, where a value is expected
//   COLOR       = "#" and six hex digits.     TEXT = '"' … '"' on one line; \" and \\ are its escapes.
//   NAME        = letters, digits and "_", beginning with no digit; no word of the language.    // begins a comment.
// clang-format on
#pragma once

#include <span>

#include "grammar/syntax/ast.h"
#include "grammar/syntax/lexer.h"

namespace sgm::syntax {

/// A whole file. Declarations with problems are kept as far as their name was read, so that their names are known.
/// `operations` must outlive the Ast.
Ast parse(SourcePtr source, const OperationTable& operations, Diagnostics& diagnostics);

/// The same from `lexSignificant(*source)`: sets the roles of the tokens on its way.
Ast parse(SourcePtr source, std::span<Token> tokens, const OperationTable& operations, Diagnostics& diagnostics);

/// A text that is one expression, as in `--set NAME=VALUE`. The source must outlive it.
Expr parseExpression(SourcePtr source, Diagnostics& diagnostics);

}  // namespace sgm::syntax
