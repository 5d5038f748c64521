#include "cli/ids.h"

#include <algorithm>
#include <cmath>

#include "grammar/lower/solids.h"

namespace sgm::cli {
namespace {

/// Told apart with any colour vision (Okabe and Ito, "Color universal design", 2008), linear.
constexpr Vec3f hues[] = {{0.80f, 0.15f, 0.0f}, {0.09f, 0.45f, 0.81f}, {0.0f, 0.34f, 0.17f}, {0.87f, 0.77f, 0.05f}};

uint8_t encoded(float light) {
    return static_cast<uint8_t>(std::lround(255 * std::pow(std::clamp(light, 0.0f, 1.0f), 1 / 2.2f)));
}

}  // namespace

Result<render::Image> drawIds(const Model& model, const Box3f& bounds, const render::PictureOptions& options,
                              Progress* progress) {
    const auto& tree = model.derivation.tree;
    if (std::none_of(tree.extras.begin(), tree.extras.end(), [](const derive::Extras& x) { return !x.clad.empty(); }))
        return Error{Error::Kind::Input, "--view ids: nothing is clad here; write 'clad ornament(…)' after a shape"};
    auto painter =
        render::FieldPainter::create(model.tape, bounds, model.lowered->provenance, options.threads, progress);
    if (!painter.ok()) return painter.error();
    render::Layers layers;
    auto image = painter->draw(options, progress, &layers);
    if (!image.ok()) return image;
    for (size_t i = 0; i < layers.origin.size(); ++i) {
        const auto origin = static_cast<size_t>(layers.origin[i]);
        if (origin == 0) continue;
        const Vec3f n = layers.normal[i];
        const auto cell = lower::facadeCellAt(tree, model.lowered->shapeOf[origin], layers.position[i].as<double>());
        Vec3f hue{0.4f, 0.4f, 0.4f};
        if (cell)
            hue = hues[(std::abs(n.x) > std::abs(n.z) ? cell->idZ : cell->idX) % 4] * (cell->storey % 2 ? 0.55f : 1.0f);
        const float light = (0.35f + 0.65f * std::max(0.0f, dot(n, Vec3f{0.45f, 0.6f, 0.66f}))) * layers.ao[i];
        for (int c = 0; c < 3; ++c) image->rgb[3 * i + static_cast<size_t>(c)] = encoded(hue[c] * light);
    }
    return image;
}

}  // namespace sgm::cli
