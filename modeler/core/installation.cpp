#include "modeler/core/installation.h"

#include <dlfcn.h>

#include <algorithm>

namespace sgm {
namespace fs = std::filesystem;

std::vector<fs::path> binaryFolders() {
    std::error_code ignored;
    std::vector<fs::path> folders;
    const auto add = [&](const fs::path& binary) {
        const fs::path folder = fs::weakly_canonical(binary, ignored).parent_path();
        if (!folder.empty() && std::find(folders.begin(), folders.end(), folder) == folders.end())
            folders.push_back(folder);
    };
    add(fs::read_symlink("/proc/self/exe", ignored));
    Dl_info info{};
    // A program's own name is as it was called; a library's is its path.
    if (dladdr(reinterpret_cast<const void*>(&binaryFolders), &info) != 0 && info.dli_fname && info.dli_fname[0] == '/')
        add(info.dli_fname);
    return folders;
}

}  // namespace sgm
