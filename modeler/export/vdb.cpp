// OpenVDB (.vdb): the level set, by the room that owns it.
#include "modeler/export/formats.h"

namespace sgm::exporter {

Status writeVdb(const ExportInput& input, const Path& temporary, const Path& target) {
    const volume::VdbOptions options{option(input, "half", "no") == "yes", input.extras};
    return volume::fillVdb(*input.volume, temporary, target, std::string(option(input, "grid", "level_set")), options,
                           input.progress);
}

}  // namespace sgm::exporter
