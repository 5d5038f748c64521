#include "modeler/tiles/page.h"

#include <cerrno>
#include <fstream>

#include "modeler/core/atomic_file.h"

namespace sgm::tiles {

Status writePage(const std::filesystem::path& folder) {
    for (const auto& [name, text] : {std::pair("index.html", pageText()), std::pair("viewer.js", pageScript())}) {
        const std::filesystem::path path = folder / name;
        const Status done = replaceFile(path, [&text = text, &path](const std::filesystem::path& temporary) -> Status {
            std::ofstream out(temporary, std::ios::binary);
            out.write(text.data(), static_cast<std::streamsize>(text.size()));
            return out.flush() ? Status(Done{}) : Status(writeError(path, errno));
        });
        if (!done.ok()) return done;
    }
    return Done{};
}

}  // namespace sgm::tiles
