// Sphere tracing (Hart 1996) of anything that gives distances, many rays at once; and how often it goes wrong.
// Enters: values(x, y, z, n, out) and rays. Leaves: the length of each ray to the first surface. Assumes unit
// directions.
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "modeler/core/vec.h"

namespace sgm::test {

/// Rays of a square picture of the whole box, three-quarter from above.
struct Picture {
    Vec3f eye;
    float pixel = 0;  ///< its width at a distance of 1
    std::vector<Vec3f> ways;
    std::vector<float> from, to;  ///< where each ray is in the box

    /// `side` pixels to a side, of which every `stride`-th is kept, in both directions.
    Picture(Box3f box, int side, int stride) {
        const Vec3f toEye = normalized(Vec3f{0.58f, 0.38f, 0.85f}), right = normalized(cross(Vec3f{0, 1, 0}, toEye)),
                    up = cross(toEye, right);
        const float reach = length(box.size());
        eye = box.centre() + toEye * (1.25f * reach);
        pixel = 0.8f / static_cast<float>(side);
        for (int j = stride / 2; j < side; j += stride)
            for (int i = stride / 2; i < side; i += stride) {
                const float x = (static_cast<float>(i) + 0.5f) * pixel - 0.4f,
                            y = (static_cast<float>(j) + 0.5f) * pixel - 0.4f;
                add(box, normalized(right * x + up * y - toEye));
            }
    }

private:
    void add(Box3f box, Vec3f way) {
        float in = 0, out = std::numeric_limits<float>::infinity();
        for (int axis = 0; axis < 3; ++axis) {
            const float a = (box.lo[axis] - eye[axis]) / way[axis], b = (box.hi[axis] - eye[axis]) / way[axis];
            in = std::max(in, std::min(a, b)), out = std::min(out, std::max(a, b));
        }
        if (in >= out) return;
        ways.push_back(way), from.push_back(in), to.push_back(out);
    }
};

/// How far each ray goes until the value is below a hundredth of a pixel, infinite for those that leave the box. A step
/// is the value times `share`.
template <class Values>
std::vector<float> traced(const Picture& picture, float share, const Values& values) {
    std::vector<float> at = picture.from, x, y, z, f;
    std::vector<size_t> going(at.size());
    for (size_t i = 0; i < going.size(); ++i) going[i] = i;
    while (!going.empty()) {
        x.clear(), y.clear(), z.clear();
        for (const size_t ray : going) {
            const Vec3f p = picture.eye + picture.ways[ray] * at[ray];
            x.push_back(p.x), y.push_back(p.y), z.push_back(p.z);
        }
        f.resize(going.size());
        values(x.data(), y.data(), z.data(), going.size(), f.data());
        size_t left = 0;
        for (size_t k = 0; k < going.size(); ++k) {
            const size_t ray = going[k];
            if (f[k] < 0.01f * picture.pixel * at[ray]) continue;  // there
            at[ray] += f[k] * share;
            if (at[ray] > picture.to[ray])
                at[ray] = std::numeric_limits<float>::infinity();
            else
                going[left++] = ray;
        }
        going.resize(left);
    }
    return at;
}

/// Rays whose surface lies more than two pixels from where steps of a twentieth find it.
template <class Values>
size_t wrongRays(const Picture& picture, float lipschitz, const Values& values) {
    const std::vector<float> coarse = traced(picture, 1 / lipschitz, values),
                             fine = traced(picture, 0.05f / lipschitz, values);
    size_t wrong = 0;
    for (size_t i = 0; i < coarse.size(); ++i) {
        if (std::isinf(coarse[i]) && std::isinf(fine[i])) continue;
        wrong += !(std::abs(coarse[i] - fine[i]) <= 2 * picture.pixel * fine[i]);
    }
    return wrong;
}

}  // namespace sgm::test
