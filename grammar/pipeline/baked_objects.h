// The library of a baked city: every object once, in two details, each a file under a key that follows from what
// decides the object; and its box, for cells that are seen from afar.
// Enters: placed models. Leaves: files. Assumes that several processes may make the same file at once: they write the
// same bytes.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <set>

#include "grammar/pipeline/floating.h"
#include "grammar/pipeline/placed_models.h"
#include "modeler/tiles/cell_content.h"
#include "modeler/tiles/textures.h"

namespace sgm::pipeline {

/// Details of an object in the library.
enum class Detail {
    Finest,  ///< crisp, a primitive a material
    Coarse,  ///< simplified, in one primitive with colours
    Mass     ///< its box, which is in no file
};

class BakedObjects {
public:
    BakedObjects(PlacedModels& objects, std::filesystem::path folder, double cell_m, tiles::Packing packing)
        : objects_(objects), folder_(std::move(folder)), cell_m_(cell_m), packing_(packing) {}

    /// Of a library that belongs to this model and these settings.
    void setModel(const std::string& digest) { model_ = digest; }
    /// From now on `make` also finds out what the cells of the first object of each start lack.
    void inspectFirstOfEachStart() { inspected_ = objects_.firstOfEachStart(); }
    /// What it found, in the order of the objects.
    std::vector<MeshWarning> warnings() const;
    /// The object's file, relative to the library: "ab/KEY-0.glb".
    std::string nameOf(uint32_t object, Detail detail) const;
    /// Makes the object's file where it isn't there; Finest and Coarse come together, from one mesh. Error::Input for
    /// an object that can't be meshed.
    Status make(uint32_t object, Detail detail, Context& context);
    /// The object's box for a place. Error::Internal for an object without a solid.
    Result<tiles::CellBox> boxOf(uint32_t object, const Part& place);
    /// How far the coarse detail may be off, metres.
    double coarseError_m() const { return 1.5 * cell_m_; }

private:
    Status makeMeshes(uint32_t object, Context& context);
    /// A material as it looks from afar: in a single colour.
    Material fromAfar(Material material);
    std::filesystem::path pathOf(uint32_t object, Detail detail) const { return folder_ / nameOf(object, detail); }

    PlacedModels& objects_;
    const std::filesystem::path folder_;
    const double cell_m_;
    const tiles::Packing packing_;
    std::string model_;
    tiles::FarColors farColors_;
    std::set<uint32_t> inspected_;
    std::unique_ptr<std::mutex> mutex_ = std::make_unique<std::mutex>();  ///< of the next
    std::map<uint32_t, std::vector<MeshWarning>> warnings_;               ///< by object
};

}  // namespace sgm::pipeline
