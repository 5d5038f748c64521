// A syntax tree as text, without places: what two texts must share to mean the same. Checks every span on its way.
#pragma once

#include "grammar/syntax/ast.h"

namespace sgm::syntax {

class Dump {
public:
    explicit Dump(const Ast& ast);
    const std::string& text() const { return out_; }
    /// The first span that doesn't lie in the file, in words; empty when all do.
    const std::string& badSpan() const { return badSpan_; }

private:
    void open(const char* kind, SourceSpan span);
    void close() { out_ += ')'; }
    void word(std::string_view text);
    void check(const char* kind, SourceSpan span);
    void name(const Name& name);
    void expr(const Expr& expr);
    void expr(const std::optional<Expr>& expr);
    void attribute(const Attribute& attribute);
    void part(const Case& part);
    void body(const Body& body);
    void body(const std::shared_ptr<Body>& body);
    void element(const Element& element);
    void settings(const std::vector<Setting>& settings);
    void simpleDeclarations(const Ast& ast);
    void shapeDeclarations(const Ast& ast);
    void otherDeclarations(const Ast& ast);

    const Source& source_;
    std::string out_, badSpan_;
};

}  // namespace sgm::syntax
