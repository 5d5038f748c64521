#include "tests/bench/reference.h"

#include <algorithm>
#include <cmath>

namespace sgm::bench {
namespace {

std::optional<Primitive> morphOf(const derive::SolidValue& solid, Primitive p) {
    const auto nameOf = [&](size_t part) {
        const auto* primitive = solid.parts[part].primitive;
        return primitive ? primitive->name : std::string_view{};
    };
    if (solid.parts.size() != 2 || nameOf(0) != "sphere" || nameOf(1) != "cube") return std::nullopt;
    p.kind = Primitive::Kind::Morph;
    p.amount = static_cast<float>(solid.amount);
    return p;
}

std::optional<Primitive> primitiveOf(const derive::SolidValue& solid, const derive::Scope& scope) {
    Primitive p{Primitive::Kind::Box, scope.centre.as<float>(), scope.half().as<float>(), 0};
    if (solid.kind == rules::Solid::Kind::Morph) return morphOf(solid, p);
    if (solid.kind != rules::Solid::Kind::Primitive) return std::nullopt;
    if (solid.primitive->name == "cube") return p;
    if (solid.primitive->name == "sphere") {
        p.kind = Primitive::Kind::Ball;
        return p;
    }
    if (solid.primitive->name != "roof") return std::nullopt;
    p.kind = Primitive::Kind::Roof;
    p.amount = static_cast<float>(solid.args[0].num());
    return p;
}

std::optional<Fractal> fractalOf(const derive::SolidValue& solid, const derive::Scope& scope) {
    enum { Center, Scale, Fold, Turn, Passes, Terminal, Form, Bailout };  // arguments, in the row's order
    if (solid.kind != rules::Solid::Kind::Primitive || solid.primitive->name != "kifs") return std::nullopt;
    const auto isIdentity = [](const rules::Value& r) {
        for (size_t i = 0; i < 9; ++i)
            if (r.n[i] != (i % 4 == 0 ? 1 : 0)) return false;
        return true;
    };
    const auto& args = solid.args;
    if (!isIdentity(args[Turn]) || args[Form].num() != 0 || args[Bailout].num() > 0) return std::nullopt;
    Fractal f;
    f.box = {Primitive::Kind::Box, scope.centre.as<float>(), scope.half().as<float>(), 0};
    f.passes = static_cast<int>(args[Passes].num());
    f.cubes = args[Terminal].num() != 0;
    f.turned = !isIdentity(args[Fold]);
    f.scale = static_cast<float>(args[Scale].num());
    const auto component = [&](size_t i) { return static_cast<float>(args[Center].n[args[Center].count > 1 ? i : 0]); };
    f.scaleCentre = {component(0), component(1), component(2)};
    for (size_t i = 0; i < 9; ++i) f.fold[i] = static_cast<float>(args[Fold].n[i]);
    return f;
}

}  // namespace

// In tree order every cut comes after the solid it is cut from, and all below a cut is cut with it.
std::optional<Reference> referenceOf(const derive::ShapeTree& tree) {
    Reference r;
    std::vector<bool> cuts(tree.shapes.size(), false);
    for (derive::ShapeId id = 0; id != derive::none; id = tree.next(id)) {
        const derive::Shape& shape = tree.shapes[id];
        if (shape.op == rules::Operator::Intersection) return std::nullopt;
        if (shape.op == rules::Operator::Morph) {
            if (r.first.empty() || r.morphTo > 0) return std::nullopt;
            r.morphTo = r.first.size();
            r.amount = static_cast<float>(shape.amount);
        }
        cuts[id] = shape.op == rules::Operator::Difference || (shape.parent != derive::none && cuts[shape.parent]);
        const derive::SolidValue* solid = tree.solidOf(id);
        if (!solid || solid->kind == rules::Solid::Kind::Nil) continue;
        if (r.first.empty() && !r.fractal)
            r.fractal = fractalOf(*solid, shape.scope);
        else if (r.fractal)
            return std::nullopt;
        if (r.fractal) continue;
        const auto primitive = primitiveOf(*solid, shape.scope);
        if (!primitive || (cuts[id] && r.first.empty())) return std::nullopt;
        if (!cuts[id]) r.first.push_back(r.primitives.size());
        r.primitives.push_back(*primitive);
    }
    r.first.push_back(r.primitives.size());
    return r;
}

bool agrees(const Reference& reference, const eval::Tape& tape, const Box3f& box) {
    constexpr size_t n = 4096;
    std::vector<float> x(n), y(n), z(n), ours(n), theirs(n);
    for (size_t i = 0; i < n; ++i) {  // a low-discrepancy sequence (Roberts 2018)
        const auto share = [&](double step) {
            return static_cast<float>(std::fmod(step * static_cast<double>(i + 1), 1.0));
        };
        x[i] = box.lo.x + box.size().x * share(0.8191725134);
        y[i] = box.lo.y + box.size().y * share(0.6710436067);
        z[i] = box.lo.z + box.size().z * share(0.5497004779);
    }
    eval::Workspace workspace;
    evaluate(reference, {x.data(), y.data(), z.data(), n}, ours.data());
    eval::evaluate(tape, {x.data(), y.data(), z.data(), n}, theirs.data(), workspace);
    const float tolerance = 1e-5f * maxComponent(box.size());
    return std::equal(ours.begin(), ours.end(), theirs.begin(),
                      [&](float a, float b) { return std::abs(a - b) <= tolerance; });
}

}  // namespace sgm::bench
