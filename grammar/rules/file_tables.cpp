#include "grammar/rules/file_tables.h"

#include <fmt/format.h>

#include <algorithm>

namespace sgm::rules {
namespace {

/// What `load`, one of the loader's functions, makes of the file that `name` (a text) stands for; null after an
/// error.
template <class Load>
auto readFile(syntax::Diagnostics& diagnostics, const Load& load, const syntax::Expr& name) {
    std::string why = "no files can be read here";
    auto file = load ? load(name.text, *name.span.source, why) : nullptr;
    if (!file) diagnostics.error(name.span, "can't use \"" + name.text + "\": " + why);
    return file;
}

/// The place in `all` of the file that `name` stands for, which `read` reads the first time.
template <class Places, class Pointer, class Read>
size_t placeOfFile(Places& known, std::vector<Pointer>& all, const syntax::Expr& name, const Read& read) {
    const auto [at, fresh] = known.try_emplace({name.span.source, name.text}, all.size());
    if (fresh) all.push_back(read());
    return at->second;
}

/// One warning for the outlines that were repaired into others, with the first.
void warnOfFaults(syntax::Diagnostics& diagnostics, const plan::Features& features, const syntax::Expr& name) {
    const auto isFaulty = [](const plan::Feature& feature) { return !feature.fault.empty(); };
    const auto first = std::ranges::find_if(features.list, isFaulty);
    if (first == features.list.end()) return;
    const auto more = std::ranges::count_if(features.list, isFaulty) - 1;
    diagnostics.warning(
        name.span,
        fmt::format("\"{}\", feature {}: {}{}", name.text, first->place, first->fault,
                    more ? fmt::format(" ({} more of its features have such faults)", more) : ""),
        "the outline is what the rings enclose, which may not be what they should say: correct the file");
}

}  // namespace

std::optional<uint32_t> FileTables::readOutlines(const syntax::Expr& name) {
    const size_t place = placeOfFile(outlines_, grammar_.outlines, name, [&] {
        auto read = readFile(diagnostics_, load_.outlines, name);
        if (read) warnOfFaults(diagnostics_, *read, name);
        return read;
    });
    return grammar_.outlines[place] ? std::optional(static_cast<uint32_t>(place)) : std::nullopt;
}

std::string FileTables::outlinesName(size_t place) const {
    const auto at = std::ranges::find_if(outlines_, [&](const auto& known) { return known.second == place; });
    return at == outlines_.end() ? std::string() : at->first.second;
}

std::optional<uint32_t> FileTables::readImage(const syntax::Expr& name) {
    const size_t place =
        placeOfFile(images_, grammar_.images, name, [&] { return readFile(diagnostics_, load_.image, name); });
    return grammar_.images[place] ? std::optional(static_cast<uint32_t>(place)) : std::nullopt;
}

size_t FileTables::readMesh(const syntax::Expr& name) {
    return placeOfFile(meshes_, grammar_.meshes, name, [&] { return readFile(diagnostics_, load_.mesh, name); });
}

town::RasterPtr FileTables::readPicture(const syntax::Expr& name) {
    return readFile(diagnostics_, load_.picture, name);
}

std::shared_ptr<const town::OwnStreets> FileTables::readStreets(const syntax::Expr& name) {
    return readFile(diagnostics_, load_.streets, name);
}

std::string FileTables::declaring(const std::string& word) const {
    return load_.declares ? load_.declares(word) : std::string();
}

}  // namespace sgm::rules
