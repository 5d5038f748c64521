// A part as lowering makes them, from texts.
// Enters: its texts and material. Leaves: a Part at the object's origin. Assumes nothing.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "modeler/core/provenance.h"

namespace sgm::exporter {

inline Part madePart(std::string path, PartSource madeBy, uint32_t material) {
    Part part;
    part.path = std::move(path);
    part.madeBy = std::make_shared<const PartSource>(std::move(madeBy));
    part.material = material;
    return part;
}

}  // namespace sgm::exporter
