#include "grammar/derive/attribute_context.h"

#include "grammar/derive/builder.h"

namespace sgm::derive {

Vec3d AttributeContext::metres(const rules::Expr& expr, bool eachDraws) const {
    const Vector v = vector(expr, eachDraws);
    Vec3d m;
    for (int i = 0; i < 3; ++i) m[i] = v.unit[i] == rules::Unit::Share ? v.n[i] * place.scope.size[i] : v.n[i];
    return m;
}

const rules::Grammar& AttributeContext::grammar() const { return *place.builder->derivation().grammar; }

void AttributeContext::fail(const std::string& what, syntax::SourceSpan span) const {
    place.builder->fail(Error::Kind::Input, what, span);
}

}  // namespace sgm::derive
