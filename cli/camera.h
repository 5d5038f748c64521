// The camera of a picture, as the command line says it.
// Enters: a text and a model. Leaves: a camera. Assumes metres.
#pragma once

#include <optional>
#include <string>

#include "grammar/pipeline/model.h"
#include "viewer/render/draw.h"

namespace sgm::cli {

/// The camera that "ex,ey,ez,ax,ay,az" says, where the eye is and what it looks at, metres; none for "" and "inside",
/// which depend on the model. Error::Usage for anything else.
Result<std::optional<render::Camera>> parseCamera(const std::string& text);

/// As `parseCamera` reads it; "inside" looks for a place in the largest hollow; "" frames the bounds, of a model that
/// turns at every angle. Error::Usage where it can't be read, or for "inside" with objects that `place` puts.
Result<render::Camera> cameraFor(const std::string& text, bool turns, const pipeline::Model& model, const Box3f& bounds,
                                 double aspect);

/// Tells on stderr when the eye stands within the model's solid, from where walls are seen from their inner sides. Of
/// objects that are kept apart nothing is known. `isInside`: '--camera inside' chose the place;
/// `isFog`: the solid is drawn as fog, of which it tells then alone.
void warnOfEye(const pipeline::Model& model, const render::Camera& camera, bool isInside, bool isFog);

}  // namespace sgm::cli
