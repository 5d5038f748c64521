#include "cli/targets.h"

#include <fmt/format.h>

#include <map>
#include <set>

#include "modeler/core/atomic_file.h"
#include "modeler/export/exporter.h"

namespace sgm::cli {
namespace {

namespace fs = std::filesystem;

}  // namespace

Status checkTargets(const std::vector<Target>& targets) {
    std::map<std::string, const Target*> writers;
    for (const Target& target : targets) {
        for (const fs::path& file : exporter::filesOf(target.file)) {
            if (const Status s = checkTarget(file); !s.ok()) return s;
            const auto [writer, fresh] = writers.emplace(identityOf(file), &target);
            if (fresh) continue;
            return Error{Error::Kind::Usage, fmt::format("{} {} and {} {} both write '{}': give one another name",
                                                         writer->second->option, writer->second->file.string(),
                                                         target.option, target.file.string(), file.string())};
        }
    }
    return Done{};
}

Status checkAgainstInputs(const std::vector<Target>& targets, const std::vector<fs::path>& inputs) {
    std::set<std::string> read;
    for (const fs::path& input : inputs) read.insert(identityOf(input));
    for (const Target& target : targets)
        for (const fs::path& file : exporter::filesOf(target.file))
            if (read.contains(identityOf(file)))
                return Error{Error::Kind::Usage,
                             fmt::format("{} {} would replace '{}', which the model is made from: give it another name",
                                         target.option, target.file.string(), file.string())};
    return Done{};
}

}  // namespace sgm::cli
