#include "grammar/derive/attribute_context.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grammar/derive/builder.h"
#include "grammar/derive/scope_footprint.h"
#include "modeler/plan/validate.h"

namespace sgm::derive {

namespace {

/// What is wrong with a footprint, in its own coordinates; "" where nothing is. The centred one is what shapes get and
/// is rounded otherwise: it is the one that has to be sound, and the only one looked at where it is.
std::string faultOf(const plan::Footprint& footprint, const plan::Footprint& centred, const plan::Box2& box) {
    const double farthest_m =
        std::max({std::abs(box.lo.x), std::abs(box.hi.x), std::abs(box.lo.z), std::abs(box.hi.z)});
    const auto fault = plan::firstFault(centred);
    if (!fault && farthest_m <= plan::Limits{}.farthest_m) return "";
    if (const auto drawn = plan::firstFault(footprint)) return plan::sentenceOf(*drawn, footprint);
    return fault ? plan::sentenceOf(*fault, centred) : "";
}

}  // namespace

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
    const plan::Box2 box = bounds(footprint);
    const plan::Vec2 centre = box.centre();
    const plan::Footprint centred = plan::placed(footprint, {1, 1}, {-centre.x, -centre.z});
    if (const std::string fault = faultOf(footprint, centred, box); !fault.empty()) return fail(fault, span);
    out.moved_m += out.scope.axes * Vec3d{centre.x, 0, centre.z};
    out.scope.size.x = box.size().x;
    out.scope.size.z = box.size().z;
    out.scope.footprint = place.builder->tree().footprints.putSound(centred, out.scope.half());
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
