#include "modeler/export/levels.h"

namespace sgm::exporter {

std::string levelName(const std::string& name, size_t level) { return name + "_LOD" + std::to_string(level); }

ExportInput inputOfLevel(const ExportInput& input, size_t level) {
    ExportInput one = input;
    if (input.levels.empty()) return one;
    one.name = levelName(input.name, level);
    one.levels = {};
    one.colliders = {};
    if (level == 0) return one;
    one.mesh = &input.levels[level - 1].mesh;
    one.objects = nullptr;
    return one;
}

}  // namespace sgm::exporter
