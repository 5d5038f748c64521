// Facade ids and storeys as colours (McGraw, figure 6).
// Enters: a model with clad shapes. Leaves: a picture. Assumes options as for any picture.
#pragma once

#include "cli/requests.h"
#include "viewer/render/draw.h"

namespace sgm::cli {

/// A hue for each facade id (of the wall's own axis), every other storey darker; what isn't clad is grey.
/// Error::Input where nothing is clad.
Result<render::Image> drawIds(const Model& model, const Box3f& bounds, const render::PictureOptions& options,
                              Progress* progress);

}  // namespace sgm::cli
