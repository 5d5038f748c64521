#include "grammar/pipeline/load.h"

#include "grammar/operations/operations.h"
#include "grammar/pipeline/files.h"

namespace sgm::pipeline {

std::shared_ptr<const rules::Grammar> load(const std::filesystem::path& name, std::string text,
                                           syntax::Diagnostics& diagnostics, const Progress* progress) {
    const auto source = std::make_shared<const syntax::Source>(name.string(), std::move(text));
    return rules::load(source, operations::table(), fileLoader(progress), diagnostics);
}

Result<std::shared_ptr<const rules::Grammar>> loadFile(const std::filesystem::path& path,
                                                       syntax::Diagnostics& diagnostics, const Progress* progress) {
    const Result<syntax::SourcePtr> source = readSource(path);
    if (!source.ok()) return source.error();
    return rules::load(*source, operations::table(), fileLoader(progress), diagnostics);
}

}  // namespace sgm::pipeline
