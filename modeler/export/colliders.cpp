#include "modeler/export/colliders.h"

#include <fmt/format.h>

namespace sgm::exporter {

std::string colliderName(std::string_view engine, const std::string& meshName, size_t index, bool convex) {
    if (engine == "unreal") return fmt::format("UCX_{}_{:02}", meshName, index);
    if (engine == "unity") return fmt::format("{}_collider_{:02}", meshName, index);
    return fmt::format("{}_{:02}-{}", meshName, index, convex ? "convcolonly" : "colonly");
}

}  // namespace sgm::exporter
