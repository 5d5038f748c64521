#include "modeler/core/provenance.h"

namespace sgm {
namespace {

/// One path that is known already.
struct KnownPath final : PartPaths {
    explicit KnownPath(std::string path) : text(std::move(path)) {}
    std::string of(uint32_t) const override { return text; }
    std::string text;
};

}  // namespace

PartPath::PartPath(std::string text) : paths_(std::make_shared<const KnownPath>(std::move(text))) {}

const PartSource& Part::source() const {
    static const PartSource unknown;
    return madeBy ? *madeBy : unknown;
}

}  // namespace sgm
