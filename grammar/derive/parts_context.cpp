#include "grammar/derive/parts_context.h"

#include "modeler/core/random.h"

namespace sgm::derive {

rules::Value PartsContext::evaluate(const rules::Expr& expr, uint64_t key) const {
    Place place = frame_.place;
    place.key = combine(frame_.key, key);
    return derive::evaluate(expr, place);
}

bool PartsContext::run(const rules::Body& body, const Scope& part, uint64_t key) {
    Interpreter::Frame inner = frame_;
    inner.key = inner.place.key = combine(frame_.key, key);
    inner.place.scope = part;
    return interpreter_.builder_.work() && interpreter_.runBody(body, inner, 0);
}

bool PartsContext::fail(const std::string& what, syntax::SourceSpan span) {
    interpreter_.builder_.fail(Error::Kind::Input, what, span);
    return false;
}

}  // namespace sgm::derive
