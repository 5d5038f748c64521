// Sampling a field and holding it to its promises.
// Enters: fields of a graph and a key for random draws. Leaves: values, and gtest failures where a promise is broken.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "modeler/core/random.h"
#include "modeler/eval/evaluate.h"
#include "modeler/field/primitives.h"
#include "tests/field/sampled.h"

namespace sgm::field::test {

/// A stream of draws.
class Draws {
public:
    explicit Draws(uint64_t key) : key_(key) {}
    double uniform(double lo, double hi) { return sgm::uniform(combine(key_, ++counter_), lo, hi); }
    /// Log-uniform.
    double size(double lo, double hi) { return std::exp(uniform(std::log(lo), std::log(hi))); }
    Vec3d in(const Box3d& box) {
        return {uniform(box.lo.x, box.hi.x), uniform(box.lo.y, box.hi.y), uniform(box.lo.z, box.hi.z)};
    }
    Vec3d direction() {
        for (;;) {
            const Vec3d v = in({{-1, -1, -1}, {1, 1, 1}});
            if (dot(v, v) > 0.01 && dot(v, v) <= 1) return normalized(v);
        }
    }
    Mat3 rotation() { return Mat3::rotation(direction(), uniform(0, 6.28)); }

private:
    uint64_t key_, counter_ = 0;
};

/// A compiled field.
class Probe {
public:
    Probe(const Graph& graph, const Field& field) : tape_(eval::compile(graph, field, graph.constants())) {}

    std::vector<float> operator()(const std::vector<Vec3f>& points) {
        std::vector<float> x, y, z, out(points.size());
        for (const Vec3f& p : points) x.push_back(p.x), y.push_back(p.y), z.push_back(p.z);
        eval::evaluate(tape_, {x.data(), y.data(), z.data(), points.size()}, out.data(), workspace_);
        return out;
    }
    float operator()(Vec3f p) { return (*this)(std::vector<Vec3f>{p})[0]; }
    const eval::Tape& tape() const { return tape_; }

private:
    eval::Tape tape_;
    eval::Workspace workspace_;
};

/// An argument whose numbers are fresh slots.
inline Argument argument(Graph& graph, std::initializer_list<double> numbers) {
    Argument a;
    int i = 0;
    for (const double n : numbers) {
        a.node[i] = graph.slot(static_cast<float>(n));
        a.value[i++] = n;
    }
    return a;
}
inline Argument argument(Graph& graph, const Mat3& m) {
    return argument(graph, {m.x.x, m.x.y, m.x.z, m.y.x, m.y.y, m.y.z, m.z.x, m.z.y, m.z.z});
}

/// An argument that was read from a file.
inline Argument fileArgument() {
    Argument a;
    a.grid = sampledTorus();
    return a;
}

/// The row's defaults.
inline std::vector<Argument> defaults(Graph& graph, const Primitive& row) {
    std::vector<Argument> list;
    for (const PrimitiveParameter& p : row.parameters)
        list.push_back(p.kind == ParameterKind::File       ? fileArgument()
                       : p.kind == ParameterKind::Rotation ? argument(graph, Mat3{})
                       : p.kind == ParameterKind::PerId
                           ? argument(graph, {p.fallback, p.fallback, p.fallback, p.fallback})
                       : p.kind == ParameterKind::Vector ? argument(graph, {p.fallback, p.fallback, p.fallback})
                                                         : argument(graph, {p.fallback}));
    return list;
}

/// A primitive of the half-size, its frame's origin at `p`'s.
inline Field build(Graph& graph, const Primitive& row, Vec3d half, const std::vector<Argument>& arguments, Point p) {
    const Vec3f h = half.as<float>();
    const Point nodes{graph.slot(h.x), graph.slot(h.y), graph.slot(h.z)};
    return row.build({p, nodes, h.as<double>(), arguments});
}
inline Field build(Graph& graph, std::string_view name, Vec3d half, Point p) {
    const Primitive& row = *findPrimitive(name);
    return build(graph, row, half, defaults(graph, row), p);
}
inline Field build(Graph& graph, std::string_view name, Vec3d half) {
    return build(graph, name, half, graph.position());
}

inline double distance(const Box3f& box, Vec3f p) {
    double d = 0;
    for (int i = 0; i < 3; ++i) {
        const double e = std::max({double(box.lo[i]) - p[i], double(p[i]) - box.hi[i], 0.0});
        d += e * e;
    }
    return std::sqrt(d);
}

/// Holds `field` to its bounds, growth and Lipschitz constant on random points around `region` (the bounds when
/// finite). An infinite Lipschitz constant promises nothing. `solid` asks for some inside point.
inline void expectPromises(const Graph& graph, const Field& field, Box3d region, uint64_t key, const std::string& what,
                           bool solid = true) {
    SCOPED_TRACE(what);
    Draws draw(key);
    const double size = std::max(length(region.size()), 0.1);
    std::vector<Vec3f> points;
    for (int i = 0; i < 3000; ++i)
        points.push_back(draw.in(region.inflated(size * (i % 3 == 0 ? 1.5 : 0.03))).as<float>());
    const size_t singles = points.size();
    for (size_t i = 0; i < singles; ++i)  // partners from far to near
        points.push_back(points[i] + (draw.direction() * draw.size(size * 1e-3, size)).as<float>());

    const std::vector<float> f = Probe(graph, field)(points);
    const double tolerance = size * 4e-6;
    size_t inside = 0;
    for (size_t i = 0; i < points.size(); ++i) {
        ASSERT_TRUE(std::isfinite(f[i])) << points[i].x << ' ' << points[i].y << ' ' << points[i].z;
        if (f[i] < 0) {
            ++inside;
            ASSERT_TRUE(field.bounds.contains(points[i]))
                << f[i] << " at " << points[i].x << ' ' << points[i].y << ' ' << points[i].z;
        } else if (field.growth > 0 && !field.bounds.empty()) {
            ASSERT_GE(f[i] + tolerance, field.growth * distance(field.bounds, points[i]))
                << points[i].x << ' ' << points[i].y << ' ' << points[i].z;
        }
        if (i < singles && std::isfinite(field.lipschitz)) {
            const double apart = length((points[i] - points[i + singles]).as<double>());
            ASSERT_LE(std::abs(double(f[i]) - f[i + singles]), field.lipschitz * apart * (1 + 1e-6) + tolerance)
                << points[i].x << ' ' << points[i].y << ' ' << points[i].z;
        }
    }
    EXPECT_TRUE(inside > 0 || !solid);
}

/// Share of the box where f < 0, times its volume: by stratified samples, n along each axis.
inline double volume(const Graph& graph, const Field& field, Box3d box, int n) {
    Draws draw(hashText("volume"));
    const Vec3d cell = box.size() / double(n);
    std::vector<Vec3f> points;
    points.reserve(size_t(n) * n * n);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            for (int k = 0; k < n; ++k) {
                const Vec3d at{i + draw.uniform(0, 1), j + draw.uniform(0, 1), k + draw.uniform(0, 1)};
                points.push_back((box.lo + cell * at).as<float>());
            }
    size_t inside = 0;
    for (const float f : Probe(graph, field)(points)) inside += f < 0;
    return double(inside) * cell.x * cell.y * cell.z;
}

}  // namespace sgm::field::test
