#include "tests/bench/reference.h"

#include <algorithm>
#include <cmath>
#include <limits>

#define SGM_INLINE [[gnu::always_inline]] inline  // into the function of each instruction set

namespace sgm::bench {
namespace {

constexpr size_t batch = 64;  ///< points whose values stay in registers or next to them

/// Coordinates and values of a batch.
struct Batch {
    float x[batch], y[batch], z[batch], part[batch], value[batch], before[batch];
};

SGM_INLINE float ball(float x, float y, float z, const Primitive& p) {
    return std::sqrt(x * x + y * y + z * z) - p.half.x;
}
SGM_INLINE float box(float x, float y, float z, const Primitive& p) {
    const float qx = std::abs(x) - p.half.x, qy = std::abs(y) - p.half.y, qz = std::abs(z) - p.half.z;
    const float ox = std::max(qx, 0.0f), oy = std::max(qy, 0.0f), oz = std::max(qz, 0.0f);
    return std::sqrt(ox * ox + oy * oy + oz * oz) + std::min(std::max(qx, std::max(qy, qz)), 0.0f);
}
SGM_INLINE float morph(float x, float y, float z, const Primitive& p) {
    const float a = ball(x, y, z, p), b = box(x, y, z, p);
    return a + p.amount * (b - a);
}
SGM_INLINE float roof(float x, float y, float z, const Primitive& p) {
    const float rise = 2 * p.half.y, foot = y + p.half.y;
    const float sx = ((std::abs(x) - p.half.x) * rise + foot * p.half.x) / std::sqrt(rise * rise + p.half.x * p.half.x);
    const float sz = ((std::abs(z) - p.half.z) * rise + foot * p.half.z) / std::sqrt(rise * rise + p.half.z * p.half.z);
    const float ux = x / p.half.x, uy = foot / rise, uz = z / p.half.z;
    const float dome = (std::sqrt(ux * ux + uy * uy + uz * uz) - 1) * std::min(std::min(p.half.x, p.half.z), rise);
    const float sides = std::max(sx, sz);
    return std::max(sides + p.amount * (dome - sides), box(x, y, z, p));
}

/// Puts a solid into the part, or cuts it from what is there.
template <float (*distance)(float, float, float, const Primitive&)>
SGM_INLINE void join(Batch& b, const Primitive& p, bool cut) {
    if (cut)
        for (size_t i = 0; i < batch; ++i)
            b.part[i] =
                std::max(b.part[i], -distance(b.x[i] - p.centre.x, b.y[i] - p.centre.y, b.z[i] - p.centre.z, p));
    else
        for (size_t i = 0; i < batch; ++i)
            b.part[i] = distance(b.x[i] - p.centre.x, b.y[i] - p.centre.y, b.z[i] - p.centre.z, p);
}

SGM_INLINE void evaluateBatch(const Reference& r, Batch& b) {
    std::fill(std::begin(b.value), std::end(b.value), std::numeric_limits<float>::infinity());
    for (size_t k = 0; k + 1 < r.first.size(); ++k) {
        if (k > 0 && k == r.morphTo) {
            std::copy_n(b.value, batch, b.before);
            std::fill_n(b.value, batch, std::numeric_limits<float>::infinity());
        }
        for (size_t i = r.first[k]; i < r.first[k + 1]; ++i) {
            const Primitive& p = r.primitives[i];
            const bool cut = i != r.first[k];
            switch (p.kind) {
                case Primitive::Kind::Box:
                    join<box>(b, p, cut);
                    break;
                case Primitive::Kind::Ball:
                    join<ball>(b, p, cut);
                    break;
                case Primitive::Kind::Morph:
                    join<morph>(b, p, cut);
                    break;
                case Primitive::Kind::Roof:
                    join<roof>(b, p, cut);
                    break;
            }
        }
        for (size_t i = 0; i < batch; ++i) b.value[i] = std::min(b.value[i], b.part[i]);
    }
    if (r.morphTo > 0)
        for (size_t i = 0; i < batch; ++i) b.value[i] = b.before[i] + r.amount * (b.value[i] - b.before[i]);
}

using BatchLoop = void (*)(const Reference&, Batch&);
void batchPortable(const Reference& r, Batch& b) { evaluateBatch(r, b); }
#if defined(__x86_64__)
__attribute__((target("avx2,fma"))) void batchAvx2(const Reference& r, Batch& b) { evaluateBatch(r, b); }
__attribute__((target("avx512f,avx512cd,avx512dq,avx512bw,avx512vl,fma"))) void batchAvx512(const Reference& r,
                                                                                            Batch& b) {
    evaluateBatch(r, b);
}
#endif

BatchLoop batchLoop() {
#if defined(__x86_64__)
    if (eval::bestIsa() == eval::Isa::Avx512) return batchAvx512;
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return batchAvx2;
#endif
    return batchPortable;
}

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

}  // namespace

// In tree order every cut comes after the solid it is cut from, and all below a cut is cut with it.
std::optional<Reference> referenceOf(const derive::ShapeTree& tree) {
    Reference r;
    std::vector<bool> cuts(tree.shapes.size(), false);
    for (derive::ShapeId id = 0; id != derive::none; id = tree.next(id)) {
        const derive::Shape& shape = tree.shapes[id];
        if (shape.op == rules::Operator::Intersection) return std::nullopt;
        if (shape.op == rules::Operator::Morph) {
            if (shape.parent != 0 || r.first.empty() || r.morphTo > 0) return std::nullopt;
            r.morphTo = r.first.size();
            r.amount = static_cast<float>(shape.amount);
        }
        cuts[id] = shape.op == rules::Operator::Difference || (shape.parent != derive::none && cuts[shape.parent]);
        const derive::SolidValue* solid = tree.solidOf(id);
        if (!solid || solid->kind == rules::Solid::Kind::Nil) continue;
        const auto primitive = primitiveOf(*solid, shape.scope);
        if (!primitive || (cuts[id] && r.first.empty())) return std::nullopt;
        if (!cuts[id]) r.first.push_back(r.primitives.size());
        r.primitives.push_back(*primitive);
    }
    r.first.push_back(r.primitives.size());
    return r;
}

void evaluate(const Reference& reference, eval::Points points, float* out) {
    const BatchLoop loop = batchLoop();
    Batch b;
    for (size_t first = 0; first < points.n; first += batch) {
        const size_t n = std::min(batch, points.n - first);
        for (size_t i = 0; i < batch; ++i) {
            const size_t from = first + std::min(i, n - 1);
            b.x[i] = points.x[from], b.y[i] = points.y[from], b.z[i] = points.z[from];
        }
        loop(reference, b);
        std::copy_n(b.value, n, out + first);
    }
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
