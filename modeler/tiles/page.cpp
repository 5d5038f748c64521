#include "modeler/tiles/page.h"

#include "modeler/core/atomic_file.h"

namespace sgm::tiles {

Status writePage(const std::filesystem::path& folder) {
    for (const auto& [name, text] : {std::pair("index.html", pageText()), std::pair("viewer.js", pageScript())}) {
        if (const Status done = writeFile(folder / name, text); !done.ok()) return done;
    }
    return Done{};
}

}  // namespace sgm::tiles
