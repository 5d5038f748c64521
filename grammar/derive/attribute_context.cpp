#include "grammar/derive/attribute_context.h"

#include <fmt/format.h>

#include "grammar/derive/builder.h"
#include "grammar/derive/scope_footprint.h"
#include "modeler/plan/validate.h"

namespace sgm::derive {

Vec3d AttributeContext::metres(const Vector& v) const {
    Vec3d m;
    for (int i = 0; i < 3; ++i) m[i] = v.unit[i] == rules::Unit::Share ? v.n[i] * place.scope.size[i] : v.n[i];
    return m;
}

plan::Footprint AttributeContext::footprint() const { return footprintOf(out.scope, place.tree->footprints); }

void AttributeContext::setFootprint(plan::Footprint footprint, syntax::SourceSpan span) {
    footprint = plan::cleaned(footprint);
    out.ownsFootprint = true;
    leave(!footprint.empty(), span);
    if (out.vanishes) return;
    if (const auto fault = plan::firstFault(footprint)) return fail(plan::sentenceOf(*fault, footprint), span);
    const plan::Box2 box = bounds(footprint);
    const plan::Vec2 centre = box.centre();
    out.moved_m += out.scope.axes * Vec3d{centre.x, 0, centre.z};
    out.scope.size.x = box.size().x;
    out.scope.size.z = box.size().z;
    const auto index =
        place.builder->tree().footprints.put(plan::placed(footprint, {1, 1}, {-centre.x, -centre.z}), out.scope.half());
    if (!index.ok()) return fail(index.error().message, span);
    out.scope.footprint = *index;
}

void AttributeContext::leave(bool anything, syntax::SourceSpan span) {
    out.vanishes = !anything;
    select(*place.builder, span, anything, [&] {
        return Explanation{fmt::format("nothing is left of a plan of {:.3g} m by {:.3g} m, so no shape is made",
                                       out.scope.size.x, out.scope.size.z),
                           "take less away, or begin with a larger plan"};
    });
}

const rules::Grammar& AttributeContext::grammar() const { return *place.builder->derivation().grammar; }

void AttributeContext::fail(const std::string& what, syntax::SourceSpan span) const {
    place.builder->monitor().fail(Error::Kind::Input, what, span);
}

}  // namespace sgm::derive
