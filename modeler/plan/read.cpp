#include "modeler/plan/read.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "modeler/core/lower_case.h"
#include "modeler/core/printable.h"
#include "modeler/core/regular_file.h"
#include "modeler/plan/clipper_paths.h"
#include "modeler/plan/edit.h"
#include "modeler/plan/read_parts.h"

namespace sgm::plan {

std::optional<Error> ReadBudget::addFeature() {
    if (++features_ <= limits_.mostFeatures) return {};
    return Error{Error::Kind::Budget, fmt::format("it has more than {} features", limits_.mostFeatures)};
}

std::optional<Error> ReadBudget::addPoints(size_t count) {
    points_ += count;
    if (points_ <= limits_.mostPoints) return {};
    return Error{Error::Kind::Budget, fmt::format("it has more than {} points", limits_.mostPoints)};
}

namespace {

/// Whether two areas differ by more than lattice and slits at touching points make of one.
bool isOtherArea(const Footprint& drawn, const Footprint& repaired) {
    const double before_m2 = area(drawn), after_m2 = area(repaired);
    return std::abs(before_m2 - after_m2) > 1e-3 * std::max(std::abs(before_m2), after_m2);
}

}  // namespace

std::string repairText(const Fault& fault, Vec2 at) {
    const std::string near = fmt::format(" near ({:.9g}, {:.9g})", at.x, at.z);
    const auto side = [](size_t ring) { return ring == 0 ? "its outline" : "a hole"; };
    if (fault.kind == FaultKind::Overlap)
        return fmt::format("polygon {} lies in polygon {}", fault.polygon + 1, fault.otherPolygon + 1) + near;
    if (fault.kind == FaultKind::CourtOutside)
        return (fault.otherRing ? "a hole lies in another" : "a hole lies outside its outline") + near;
    if (fault.polygon != fault.otherPolygon)
        return fmt::format("polygons {} and {} cross", fault.polygon + 1, fault.otherPolygon + 1) + near;
    if (fault.ring == fault.otherRing) return fmt::format("{} crosses itself", side(fault.ring)) + near;
    return (fault.ring && fault.otherRing ? "two holes cross" : "a hole crosses the outline") + near;
}

Result<Footprint> soundFootprint(const Footprint& drawn, const Limits& limits, std::optional<Fault>* repair) {
    Footprint clean = cleaned(drawn, limits.leastEdge_m, 1e-6);
    if (!firstFault(clean, limits)) return clean;
    const Footprint& left = clean.empty() ? drawn : clean;  // a bow of no area is cleaned away
    const auto fault = firstFault(left, limits);
    if (!fault) return Error{Error::Kind::Input, "the outline encloses no area"};
    const bool canBeResolved = fault->kind == FaultKind::Crossing || fault->kind == FaultKind::CourtOutside ||
                               fault->kind == FaultKind::Overlap;
    if (canBeResolved) {
        Result<Footprint> repaired = resolved(left);
        if (repair && repaired.ok() && isOtherArea(left, *repaired)) *repair = fault;
        if (repaired.ok() ? !repaired->empty() && !firstFault(*repaired, limits)
                          : repaired.error().kind == Error::Kind::Budget)
            return repaired;
    }
    return Error{Error::Kind::Input, sentenceOf(*fault, left)};
}

Error damaged(std::string_view unit, uint64_t number, std::string_view why) {
    return {Error::Kind::Input, fmt::format("{} {}: {}", unit, number, why)};
}

Error damaged(std::string_view unit, uint64_t number, const Error& why) {
    return {why.kind, damaged(unit, number, why.message).message};
}

std::optional<double> takeNumber(std::string_view& text) {
    double value = 0;
    const bool plus = !text.empty() && text[0] == '+';
    const auto [end, error] = std::from_chars(text.data() + plus, text.data() + text.size(), value);
    if (error != std::errc{} || !std::isfinite(value)) return {};
    text.remove_prefix(static_cast<size_t>(end - text.data()));
    return value;
}

const std::variant<std::string, double>* Feature::find(std::string_view word) const {
    const auto at =
        std::find_if(properties.begin(), properties.end(), [&](const Property& p) { return p.name == word; });
    return at == properties.end() ? nullptr : &at->value;
}

Result<Features> readOutlines(const std::filesystem::path& path, const ReadLimits& limits, const Progress* progress) {
    const std::string ending = lowerCase(path.extension().string());
    const auto named = [&](const Error& e) {
        return e.kind == Error::Kind::Cancelled
                   ? e
                   : Error{e.kind, fmt::format("{}: {}", printable(path.string()), e.message)};
    };
    const auto read = ending == ".geojson" || ending == ".json" ? readGeoJson
                      : ending == ".svg"                        ? readSvg
                      : ending == ".obj"                        ? readObjOutlines
                                                                : nullptr;
    if (!read) return named({Error::Kind::Input, "outlines are read from .geojson, .json, .svg and .obj files"});
    const auto bytes = readRegularFile(path, limits.mostBytes, progress);
    if (!bytes) return named(bytes.error());
    Result<Features> features = read(*bytes, limits, progress);
    return features.ok() ? std::move(features) : Result<Features>(named(features.error()));
}

}  // namespace sgm::plan
